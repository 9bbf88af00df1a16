/** The benchmark page: runs the sweep step by step, with progress and cancel, and offers what it found as JSON. */
import createBench from './lucent-bench.js';
import { nextTask } from './task.js';
import { callWasm, putFile } from './wasm.js';

const kSliceMs = 50;
const kParts = ['relief', 'environment', 'scaling', 'hard', 'refraction', 'caustics']; // as lucent bench has them

/** The module on a context of its own. */
class Bench {
  static async start() {
    const one = new Bench();
    one.wasm = await createBench({ locateFile: (name) => new URL(name, import.meta.url).href });
    const options = { antialias: false, depth: false, stencil: false };
    const gl = document.createElement('canvas').getContext('webgl2', options);
    if (!gl) throw new Error('this browser: WebGL2 is not available; a browser with WebGL2 is needed');
    const { GL } = one.wasm;
    GL.makeContextCurrent(GL.registerContext(gl, { majorVersion: 2, minorVersion: 0 }));
    one.demand('start');
    return one;
  }
  call(name, ...values) {
    return callWasm(this.wasm, `bench_${name}`, ...values);
  }
  text(name, ...values) {
    return this.wasm.UTF8ToString(this.call(name, ...values));
  }
  /** Calls what answers with "" or with the message that is thrown. */
  demand(name, ...values) {
    const message = this.text(name, ...values);
    if (message) throw new Error(message);
  }

  // The gallery's files that this module can read; a page without a gallery measures without them.
  async addGallery() {
    if (!(await this.#put('elevation.json')) || !(await this.#put('elevation.png'))) return;
    if (!(await this.#put('elevation-color.png')) || !(await this.#put('sunset.hdr'))) return;
    this.demand('load', 'elevation.json');
    this.demand('add_field', 'elevation');
    this.demand('add_environment', 'sunset.hdr');
  }
  async #put(name) {
    const answer = await fetch(`gallery/${name}`);
    if (answer.ok) putFile(this.wasm, 'bench_file_space', name, new Uint8Array(await answer.arrayBuffer()));
    return answer.ok;
  }

  report() {
    const report = JSON.parse(this.text('report'));
    report.date = new Date().toISOString().slice(0, 10);
    report.commit = LUCENT_COMMIT; // the build puts it in
    const { userAgent, hardwareConcurrency } = navigator;
    Object.assign(report.machine, { where: 'browser', browser: userAgent, cores: hardwareConcurrency });
    return report;
  }
}

const find = (id) => document.getElementById(id);
const seconds = (ms) => `${Math.round(ms / 1000)} s`;
let cancelled = false;

/** @param parts  some of kParts. @return the report, of what was done when it was cancelled */
async function measure(parts, quick) {
  const bench = await Bench.start();
  if (!quick) await bench.addGallery();
  bench.demand('sweep', parts.join(' '), Number(quick));
  const start = performance.now();
  for (let more = 1; more && !cancelled; ) {
    const until = performance.now() + kSliceMs;
    while (more && performance.now() < until) more = bench.call('step');
    const [share, spent] = [bench.call('share'), performance.now() - start];
    find('share').value = share;
    const left = share > 0.02 ? `, about ${seconds((spent / share) * (1 - share))} left` : '';
    find('part').value = `${bench.text('part')}: ${Math.round(100 * share)} %${left}`;
    await nextTask();
  }
  return { report: bench.report(), text: bench.text('report_text'), spent: performance.now() - start };
}

function show({ report, text, spent }) {
  find('found').textContent = text;
  find('found').hidden = false;
  const json = JSON.stringify(report, null, 1) + '\n';
  const link = find('download');
  URL.revokeObjectURL(link.href);
  link.href = URL.createObjectURL(new Blob([json], { type: 'application/json' }));
  link.hidden = false;
  find('part').value = `${cancelled ? 'cancelled' : 'done'} after ${seconds(spent)}`;
}

find('wish').addEventListener('submit', async (event) => {
  event.preventDefault();
  const wanted = new FormData(event.target);
  cancelled = false;
  [find('start').disabled, find('cancel').disabled] = [true, false];
  try {
    const found = await measure(kParts.filter((part) => wanted.has(part)), wanted.has('quick'));
    show(found);
    window.found = found.report;
  } catch (error) {
    find('part').value = error.message;
  }
  [find('start').disabled, find('cancel').disabled] = [false, true];
});
find('cancel').addEventListener('click', () => (cancelled = true));
