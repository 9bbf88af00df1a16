/** What the peers' pages share: Lucent on a canvas of its own, pictures of numbers, times. */
import { callWasm, putFile } from '../../web/wasm.js';

export function makeCanvas(width, height = width) {
  return Object.assign(document.createElement('canvas'), { width, height });
}

/** Waits for all that was drawn into the framebuffer that is bound. */
export function waitFor(gl) {
  const isCanvas = !gl.getParameter(gl.READ_FRAMEBUFFER_BINDING);
  const [type, pixel] = isCanvas ? [gl.UNSIGNED_BYTE, new Uint8Array(4)] : [gl.FLOAT, new Float32Array(4)];
  gl.readPixels(0, 0, 1, 1, gl.RGBA, type, pixel);
  const error = gl.getError();
  if (error) throw new Error(`waiting for a picture: GL error ${error}`); // else nobody has waited
}

/** The bench module (src/web/Bench.cpp) with one scene. */
export class Lucent {
  static async start(width, height = width) {
    const { default: create } = await import(new URL('lucent-bench.js', location).href); // of the page's site
    const one = new Lucent();
    one.pixels = width * height;
    one.wasm = await create({ locateFile: (name) => new URL(name, location).href });
    const options = { antialias: false, depth: false, stencil: false };
    one.gl = makeCanvas(width, height).getContext('webgl2', options);
    const { GL } = one.wasm;
    GL.makeContextCurrent(GL.registerContext(one.gl, { majorVersion: 2, minorVersion: 0 }));
    one.#demand('start');
    return one;
  }

  #text(name, ...values) {
    return this.wasm.UTF8ToString(callWasm(this.wasm, `bench_${name}`, ...values));
  }
  #demand(name, ...values) {
    const message = this.#text(name, ...values);
    if (message) throw new Error(message);
  }
  get driver() {
    return this.#text('driver');
  }
  get glVersion() {
    return this.gl.getParameter(this.gl.VERSION);
  }

  /** A file that the scene names. */
  put(name, bytes) {
    putFile(this.wasm, 'bench_file_space', name, bytes);
  }
  /** @param scene  as a file has it */
  load(scene) {
    this.put('scene.json', new TextEncoder().encode(JSON.stringify(scene)));
    this.#demand('load', 'scene.json');
  }
  set(path, value) {
    this.#demand('set', path, [value].flat().join(' '));
  }

  /** A frame on the canvas, waited for. */
  frame() {
    this.#demand('draw');
    waitFor(this.gl);
  }

  /** Gives the context back: browsers keep few of them. */
  release() {
    this.gl.getExtension('WEBGL_lose_context').loseContext();
  }

  // What was read or solved last.
  #values() {
    const from = this.wasm._bench_pixels() / 4;
    return this.wasm.HEAPF32.slice(from, from + 4 * this.pixels);
  }
  /** What the scene shows: 4 floats a pixel, linear, row 0 at the top. */
  picture() {
    this.#demand('draw');
    this.#demand('read');
    return this.#values();
  }
  /** The same of its exact solution, of height fields only. */
  truth() {
    this.#demand('solve', 1); // there is no environment
    return this.#values();
  }
}

/** Rows of a target the other way round: WebGL's begin at the bottom. @param values  `width` of them a row */
export function turned(values, width) {
  const rows = values.length / width;
  const result = new values.constructor(values.length);
  for (let row = 0; row < rows; ++row)
    result.set(values.subarray(row * width, (row + 1) * width), (rows - 1 - row) * width);
  return result;
}

export async function fetchBytes(name) {
  const answer = await fetch(`peers/${name}`);
  if (!answer.ok) throw new Error(`peers/${name}: the server answers ${answer.status}; must be there`);
  return new Uint8Array(await answer.arrayBuffer());
}

/** A picture of the program: 3 floats a pixel, row 0 at the top. */
export async function fetchPfm(name) {
  const bytes = await fetchBytes(name);
  const head = /^PF\n(\d+) (\d+)\n-1(\.0+)?\n/.exec(new TextDecoder('latin1').decode(bytes.subarray(0, 64)));
  if (!head) throw new Error(`${name}: is no PFM of colours in little-endian order`);
  const [width, height] = [Number(head[1]), Number(head[2])];
  return { width, height, values: turned(new Float32Array(bytes.slice(head[0].length).buffer), 3 * width) };
}

export function spreadOf(times) {
  const sorted = [...times].sort((a, b) => a - b);
  return { median: sorted[sorted.length >> 1], low: sorted[0], high: sorted.at(-1), repeats: sorted.length };
}

export function timeOf(work) {
  const start = performance.now();
  work();
  return performance.now() - start;
}

/**
 * Frames of all in turn, so that whatever else the machine does hits all. The first round compiles and uploads.
 * @param frames   {name: (i) => draws frame i and waits for it}
 * @return         {name: spread of milliseconds}
 */
export function timeInTurn(frames, repeats) {
  const times = Object.keys(frames).map(() => []);
  for (let i = 0; i <= repeats; ++i) {
    const round = Object.values(frames).map((frame) => timeOf(() => frame(i)));
    if (i > 0) round.forEach((time, k) => times[k].push(time));
  }
  return Object.fromEntries(Object.keys(frames).map((name, k) => [name, spreadOf(times[k])]));
}

/** Every combination of the lists' elements: {a: [1, 2], b: [3]} gives [{a: 1, b: 3}, {a: 2, b: 3}]. */
export function combinations(lists) {
  return Object.entries(lists).reduce(
    (done, [name, list]) => done.flatMap((one) => list.map((value) => ({ ...one, [name]: value }))),
    [{}],
  );
}

/** The smallest by some value. */
export const least = (list, value) => list.reduce((a, b) => (value(b) < value(a) ? b : a));

export const sumOf = (values) => values.reduce((sum, value) => sum + value, 0);

const kSweepRepeats = 1;

/**
 * Each setting of one who draws, its error and about its time.
 * @param one    {set(knobs), aim(way), frame(), picture()}; set() may take its time
 * @param knobs  lists of settings, or several such
 * @param judge  (picture) => {error, gain}
 * @param light  {still, moving(i)}: ways of the light, of the picture and of frame i
 */
export async function sweep(one, knobs, judge, light) {
  const swept = [];
  for (const setting of [knobs].flat().flatMap(combinations)) {
    await one.set(setting);
    one.aim(light.still);
    const { error, gain } = judge(one.picture());
    const { ms } = timeInTurn({ ms: (i) => (one.aim(light.moving(i)), one.frame()) }, kSweepRepeats);
    swept.push({ knobs: setting, gain, error, ms });
  }
  return swept;
}

/**
 * Marks who races: the quickest that misplaces no more than the target, else who misplaces the least.
 * @param isGood  what else the quickest must keep
 */
export function markBest(swept, target, isGood = () => true) {
  const misplaced = ({ error }) => error.flux.misplaced;
  const good = swept.filter((one) => misplaced(one) <= target && isGood(one));
  const best = good.length ? least(good, ({ ms }) => ms.median) : least(swept, misplaced);
  best.isBest = true;
  return best;
}

/**
 * Pictures beside each other with a line below each.
 * @param panels  {text, values: 3 floats a pixel}
 * @param white   what is shown white
 * @return        base64 of a PNG
 */
export function paint(panels, size, white) {
  const [gap, line] = [8, 24];
  const canvas = makeCanvas(panels.length * (size + gap) - gap, size + line);
  const context = canvas.getContext('2d');
  context.fillStyle = 'white';
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = 'black';
  context.font = '13px sans-serif';
  const shown = (light) => 255 * Math.min(1, Math.max(0, light / white)) ** (1 / 2.2);
  panels.forEach(({ text, values }, i) => {
    const picture = context.createImageData(size, size);
    picture.data.fill(255);
    values.forEach((value, k) => (picture.data[4 * Math.floor(k / 3) + (k % 3)] = shown(value)));
    context.putImageData(picture, i * (size + gap), 0);
    context.fillText(text, i * (size + gap), size + 17);
  });
  return canvas.toDataURL('image/png').split(',')[1];
}

/** Pictures below each other. @param pngs  base64, all of one width. @return base64 of a PNG */
export async function stacked(pngs) {
  const bytesOf = (png) => Uint8Array.from(atob(png), (letter) => letter.charCodeAt(0));
  const images = await Promise.all(pngs.map((png) => createImageBitmap(new Blob([bytesOf(png)]))));
  const canvas = makeCanvas(
    images[0].width,
    images.reduce((sum, { height }) => sum + height, 0),
  );
  let top = 0;
  for (const image of images) {
    canvas.getContext('2d').drawImage(image, 0, top);
    top += image.height;
  }
  return canvas.toDataURL('image/png').split(',')[1];
}

export const misplacedText = (share) => `${(100 * share).toPrecision(2)} % misplaced`;
