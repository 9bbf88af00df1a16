/**
 * The self-check: closed forms and capabilities on the visitor's own device, in slices, and a dialog that shows them.
 * Fetched with a module of its own when somebody asks for it; it draws on a context of its own.
 */
import createCheck from 'lucent-check-wasm'; // the build names the file
import css from './selfcheck.css';

const kSlice = 8; // ms of work until the page has its turn

function makeContext() {
  const makers = [() => document.createElement('canvas')];
  if (self.OffscreenCanvas) makers.unshift(() => new OffscreenCanvas(1, 1));
  for (const make of makers) {
    const gl = make().getContext('webgl2', { antialias: false, depth: false, stencil: false });
    if (gl) return gl;
  }
  throw new Error('self-check: WebGL2 is not available; a browser with WebGL2 is needed');
}

/**
 * @param signal    AbortSignal that cancels
 * @param progress  called with the finished share, [0, 1], after each slice
 * @return {Promise<object>}  device, passed, checks, capabilities; rejects with the signal's reason, or when there is
 *                            no context or it is lost
 */
export async function runSelfCheck({ signal, progress } = {}) {
  const wasm = await createCheck({ locateFile: (name) => new URL(name, import.meta.url).href });
  signal?.throwIfAborted();
  const gl = makeContext();
  try {
    wasm.GL.makeContextCurrent(wasm.GL.registerContext(gl, { majorVersion: 2, minorVersion: 0 }));
    const message = wasm.UTF8ToString(wasm._check_start());
    if (message) throw new Error(message);
    for (let more = true; more; ) {
      const end = performance.now() + kSlice;
      do more = wasm._check_step() === 1;
      while (more && performance.now() < end);
      if (gl.isContextLost()) throw new Error('self-check: the WebGL context was lost; must be kept to the end');
      progress?.(wasm._check_progress());
      await new Promise((done) => setTimeout(done));
      signal?.throwIfAborted();
    }
    return JSON.parse(wasm.UTF8ToString(wasm._check_report()));
  } finally {
    gl.getExtension('WEBGL_lose_context')?.loseContext(); // gives its memory back now
  }
}

// ---- the dialog

const kMarkup = `
<h2 id="check-title">Self-check</h2>
<p>Pictures of a few hundred pixels whose every value is known, drawn on this device, and what its driver can do.
What is on this page is not changed.</p>
<div class="actions">
  <button type="button" data-do="run">Run again</button>
  <button type="button" data-do="cancel">Cancel</button>
  <button type="button" data-do="copy">Copy as JSON</button>
  <button type="button" data-do="close">Close</button>
</div>
<progress max="1" aria-label="Progress of the self-check"></progress>
<p role="status"></p>
<div class="tables" tabindex="0" role="region" aria-label="Results"></div>`;

const kStyle = new CSSStyleSheet();

/** @return element with properties and children */
function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children.filter((child) => child !== ''));
  return element;
}

const small = (text) => (text ? make('small', { textContent: text }) : '');
function number(value, digits) {
  if (value === null) return 'no number';
  const rounded = Number(value.toPrecision(digits));
  return rounded !== 0 && Math.abs(rounded) < 1e-3 ? rounded.toExponential() : String(rounded);
}

function table(caption, heads, rows) {
  const head = make('tr', {}, ...heads.map((text) => make('th', { scope: 'col', textContent: text })));
  return make('table', {}, make('caption', { textContent: caption }), make('thead', {}, head), make('tbody', {}, ...rows));
}

const rowName = (name, text) => make('th', { scope: 'row' }, name, small(text));

function checkRow({ name, meaning, expected, found, tolerance, reason, passed, message }) {
  return make(
    'tr',
    { className: passed ? 'passed' : 'failed' },
    rowName(name, message ?? meaning),
    make('td', { className: 'verdict' }, passed ? 'passed' : 'FAILED'),
    make('td', { className: 'number' }, number(expected, 7)),
    make('td', { className: 'number' }, number(found, 7)),
    make('td', { className: 'number' }, number(tolerance, 2), small(reason)),
  );
}

function capabilityRow({ name, extension, present, amount, use, fallback, measured, measure }) {
  const text = measured === null ? 'not measured' : number(measured, 3);
  return make(
    'tr',
    { className: present ? '' : 'missing' },
    rowName(name, extension),
    make('td', {}, amount || (present ? 'yes' : 'no')),
    make('td', {}, use),
    make('td', {}, fallback),
    make('td', { className: 'number' }, measure ? text : '', small(measured === null ? '' : measure)),
  );
}

class Panel {
  #viewer;
  #dialog = make('dialog', { className: 'lucent-check', innerHTML: kMarkup });
  #report = null;
  #running = null; // AbortController

  constructor(viewer) {
    this.#viewer = viewer;
    this.#dialog.setAttribute('aria-labelledby', 'check-title');
    const actions = { run: () => this.run(), cancel: () => this.#running?.abort(), copy: () => this.#copy() };
    actions.close = () => this.#dialog.close();
    this.#dialog.addEventListener('click', ({ target }) => actions[target.dataset.do]?.());
    this.#dialog.addEventListener('close', () => this.#running?.abort());
    document.body.append(this.#dialog);
  }

  open() {
    this.#dialog.showModal();
    this.run();
  }

  async run() {
    if (this.#running) return;
    const { signal } = (this.#running = new AbortController());
    this.#say('Running…');
    this.#report = null;
    this.#show();
    try {
      const progress = (share) => (this.#find('progress').value = share);
      this.#report = await this.#viewer.selfCheck({ signal, progress });
      const { checks, device } = this.#report;
      const failed = checks.filter(({ passed }) => !passed).length;
      this.#say(`${failed ? `${failed} of ${checks.length} fail` : `All ${checks.length} pass`} on ${device.renderer}`);
    } catch (error) {
      this.#say(signal.aborted ? 'Cancelled' : error.message);
    }
    this.#running = null;
    this.#show();
  }

  #find(selector) {
    return this.#dialog.querySelector(selector);
  }

  #say(text) {
    this.#find('[role=status]').textContent = text;
  }

  #show() {
    const focused = this.#dialog.contains(document.activeElement) ? document.activeElement : null;
    this.#find('[data-do=run]').disabled = this.#running !== null;
    this.#find('[data-do=cancel]').disabled = this.#running === null;
    this.#find('[data-do=copy]').disabled = this.#report === null;
    if (focused?.disabled) this.#find('[data-do=close]').focus();
    this.#find('progress').hidden = this.#running === null;
    this.#find('progress').value = 0;
    const { checks = [], capabilities = [] } = this.#report ?? {};
    const tables = this.#report && [
      table('Closed forms', ['Closed form', 'Result', 'Expected', 'Found', 'Tolerance'], checks.map(checkRow)),
      table('Capabilities', ['Capability', 'Here', 'Used for', 'Without it', 'Measured here'], capabilities.map(capabilityRow)),
    ];
    this.#find('.tables').replaceChildren(...(tables ?? []));
  }

  async #copy() {
    try {
      await navigator.clipboard.writeText(JSON.stringify(this.#report, null, 2));
      this.#say('Copied');
    } catch {
      this.#say('This browser keeps pages from copying; selfCheck() of the viewer gives the same to a script');
    }
  }
}

let panel;

/**
 * Opens the dialog and runs the check.
 * @param viewer  a <lucent-viewer>; Escape or Close ends the check and gives the focus back
 */
export function openSelfCheck(viewer) {
  if (!panel) {
    kStyle.replaceSync(css);
    document.adoptedStyleSheets.push(kStyle);
    panel = new Panel(viewer);
  }
  panel.open();
}
