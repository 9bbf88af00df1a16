/**
 * What viewers of a page share: the WebAssembly module, one WebGL2 context and one render loop.
 *
 * Browsers keep 8 to 16 contexts alive, so every viewer draws on the same off-screen canvas and takes its picture
 * away as a bitmap.
 *
 * A page of reliefs fetches a module that draws nothing else. The first scene that asks for more brings the whole one,
 * which draws all that is loaded from then on.
 */
import createRelief from 'lucent-relief-wasm'; // the build names the files
import { nextTask } from './task.js';
import { callWasm, isAbort } from './wasm.js';

/** An error with a code that pages can test and a message that people can read. */
export class LucentError extends Error {
  /** @param {'fetch'|'policy'|'scene'|'file'|'value'|'gpu'|'abort'} code */
  constructor(code, message) {
    super(message);
    this.code = code;
  }
}

/** A canvas that is never seen, with its context: off the page where the browser can, else one not attached. */
function makeContext() {
  const options = { antialias: false, depth: false, stencil: false };
  const makers = [() => document.createElement('canvas')];
  if (self.OffscreenCanvas?.prototype.transferToImageBitmap) makers.unshift(() => new OffscreenCanvas(1, 1));
  for (const make of makers) {
    const canvas = make();
    const gl = canvas.getContext('webgl2', options);
    if (gl) return { canvas, gl };
  }
  throw new LucentError('gpu', 'this browser: WebGL2 is not available; a browser with WebGL2 is needed');
}

// Setting a size empties a canvas, even when it stays the same.
function resize(canvas, width, height) {
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
}

// As Chromium, Firefox and Safari say that the page's policy forbids to compile a module.
const kForbidden = /unsafe-eval|content.security.policy|\bCSP\b/i;

const kNames = { relief: 'lucent-relief', whole: 'lucent' }; // of files

export class Runtime {
  static #shared = { relief: undefined, whole: undefined };
  /**
   * The page's runtime, started by the first viewer that asks, and anew after it has ended or could not start. Rejects
   * with a LucentError.
   * @param whole  whether it must draw more than reliefs
   */
  static shared(whole) {
    const all = this.#shared;
    const kind = whole || all.whole ? 'whole' : 'relief';
    all[kind] ??= this.#start(kind).catch((error) => {
      all[kind] = undefined;
      throw error;
    });
    return all[kind];
  }

  static async #start(kind) {
    await nextTask(); // a context takes as long to make as a page's scripts to begin
    const { canvas, gl } = makeContext();
    const locateFile = (name) => new URL(name, import.meta.url).href;
    const name = kNames[kind];
    let wasm;
    try {
      const create = kind === 'relief' ? createRelief : (await import(locateFile(`./${name}.js`))).default;
      wasm = await create({ locateFile });
    } catch (reason) {
      if (kForbidden.test(reason.message ?? reason))
        throw new LucentError(
          'policy',
          `${name}.wasm: the page's Content-Security-Policy forbids WebAssembly; its script-src must contain ` +
            "'wasm-unsafe-eval'",
        );
      throw new LucentError('fetch', `${name}.wasm: ${reason.message ?? reason}; it must lie beside the script`);
    }
    const runtime = new Runtime(wasm, canvas, gl, kind);
    const message = runtime.#takeContext();
    if (message) throw new LucentError('gpu', message);
    return runtime;
  }

  static #kBetween = 2; // ms from one look at work that waits for the GPU to the next,
  static #kLate = 24; // after a picture, when the next one has taken longer than a frame,
  static #kMostBetween = 100; // and after a frame until a page is hidden

  #kind;
  #wasm;
  #canvas;
  #gl;
  #frame = 0;
  #now = 0; // ms: of the last picture,
  #framed = 0; // when the browser's last frame ended
  #drawn = 0; // and when there was a new picture last
  #timer = 0; // of the next look at work, before the next frame
  #lost = false;
  #ended = null; // why the module does nothing any more
  #wanting = new Set(); // viewers that want the next frame
  #viewers = new Set();

  constructor(wasm, canvas, gl, kind) {
    this.#kind = kind;
    this.#wasm = wasm;
    this.#canvas = canvas;
    this.#gl = gl;
    canvas.addEventListener('webglcontextlost', (event) => this.#lose(event));
    canvas.addEventListener('webglcontextrestored', () => this.#restore());
  }

  /** Throws a LucentError when the module ends in the call, or has ended before: then every viewer was told. */
  call(name, ...values) {
    if (this.#ended) throw this.#ended;
    try {
      return callWasm(this.#wasm, name, ...values);
    } catch (error) {
      if (!isAbort(error)) throw error;
      this.#end(error, name.startsWith('viewer_') ? values[0] : 0);
      throw this.#ended;
    }
  }
  /** Gives a file for later loads. */
  put(name, bytes) {
    const at = this.call('file_space', name, bytes.length); // after which HEAPU8 may be another
    this.#wasm.HEAPU8.set(bytes, at);
  }
  text(name, ...values) {
    return this.#wasm.UTF8ToString(this.call(name, ...values));
  }
  json(name, ...values) {
    return JSON.parse(this.text(name, ...values));
  }

  /** Files that a call answers with: viewer_ask_truth, viewer_pack. @return {Map<string, Uint8Array>} */
  files(name, handle) {
    const files = this.json(name, handle);
    return new Map(files.map(({ name, at, size }) => [name, this.#wasm.HEAPU8.slice(at, at + size)]));
  }

  /** See paintedMaps() of the element. */
  painting(handle, object) {
    const maps = this.json('viewer_painting', handle, object);
    if (!maps) return null;
    const { side, entering, leaving } = maps;
    const texels = (at) => new Float32Array(this.#wasm.HEAPU8.slice(at, at + 16 * side * side).buffer);
    return { side, entering: texels(entering), leaving: texels(leaving) };
  }

  /** The finished picture of a viewer as linear values: width, height and 4 floats a pixel as bytes. */
  linear(handle) {
    const { width, height, at, error } = this.json('viewer_linear', handle);
    if (error) throw new LucentError('gpu', error);
    return { width, height, bytes: this.#wasm.HEAPU8.slice(at, at + 16 * width * height) };
  }

  /** A viewer of the module that shows what another one shows now, without an element. drop() ends it. */
  copyOf(handle) {
    const copy = this.call('viewer_create');
    this.call('viewer_copy', copy, handle);
    this.call('viewer_panel', copy, 0);
    this.call('viewer_bare', copy, 1);
    return copy;
  }

  /** Longest side that a picture may have on this device, pixels. */
  get largestSide() {
    const gl = this.#gl;
    const limit = (name) => gl.getParameter(name);
    return Math.min(limit(gl.MAX_TEXTURE_SIZE), limit(gl.MAX_RENDERBUFFER_SIZE), ...limit(gl.MAX_VIEWPORT_DIMS));
  }
  /** Whether the graphics context is lost, or was given back. */
  get lost() {
    return this.#lost;
  }

  /** Whether it draws all that scenes may ask for. */
  get isWhole() {
    return this.#kind === 'whole';
  }

  /** The kind of context a viewer's own canvas must have for show(). */
  get displayContext() {
    return this.#canvas instanceof HTMLCanvasElement ? '2d' : 'bitmaprenderer';
  }

  /**
   * @param viewer  has render(seconds), true while it wants another frame, work() as ours, contextLost(), contextRestored(message),
   *                and moduleEnded(error, handle): a LucentError, and of which viewer the call was, 0: of none
   */
  add(viewer) {
    this.#viewers.add(viewer);
  }
  /** A viewer of the module goes, and with it `viewer`, whose it was; it may have ended before. */
  drop(handle, viewer) {
    this.#viewers.delete(viewer);
    this.#wanting.delete(viewer);
    if (this.#ended) return;
    this.call('viewer_destroy', handle);
    if (!this.#viewers.size && Runtime.#shared.whole && !this.isWhole) this.#leave(); // nobody will ask for it again
  }

  /** Asks for a frame. Without such a wish nothing runs: an idle page draws nothing. */
  request(viewer) {
    this.#wanting.add(viewer);
    this.#schedule();
  }

  /**
   * Draws one viewer on the shared canvas.
   * @return {{more: boolean, drawn: boolean}}  wants another frame; left a new picture for show(), until the task ends
   */
  draw(handle, width, height, seconds) {
    if (this.#lost) return { more: false, drawn: false };
    resize(this.#canvas, width, height);
    const before = this.call('viewer_draw_count', handle);
    const more = this.call('viewer_draw', handle, seconds) === 1;
    const drawn = this.call('viewer_draw_count', handle) !== before;
    if (drawn) this.#drawn = performance.now();
    return { more, drawn };
  }

  /**
   * Works on a viewer's picture between its frames.
   * @return {{more: boolean, waits: boolean}}  whether more is of use before the next one; whether a picture waits for it
   */
  work(handle) {
    const answer = this.#lost ? 0 : this.call('viewer_work', handle);
    return { more: answer === 1, waits: answer === 2 };
  }

  /** The picture that was just drawn, on a canvas of its own. */
  copyPicture() {
    const { width, height } = this.#canvas;
    const copy = Object.assign(document.createElement('canvas'), { width, height });
    copy.getContext('2d').drawImage(this.#canvas, 0, 0);
    return copy;
  }

  /** Moves the picture that was just drawn to a context of the displayContext kind. */
  show(context) {
    const { width, height } = this.#canvas;
    resize(context.canvas, width, height);
    if (context.transferFromImageBitmap) {
      context.transferFromImageBitmap(this.#canvas.transferToImageBitmap());
      return;
    }
    context.clearRect(0, 0, width, height);
    context.drawImage(this.#canvas, 0, 0);
  }

  #schedule() {
    if (this.#wanting.size && !this.#frame && !this.#lost)
      this.#frame = requestAnimationFrame((now) => {
        this.#tick(now);
        this.#framed = performance.now();
        this.#lookLater();
      });
  }

  // Calls `turn` for each viewer that wants a frame. @return {boolean}  false when the module has ended: all know
  #forEachWanting(turn) {
    try {
      for (const viewer of [...this.#wanting]) turn(viewer);
    } catch (error) {
      if (error !== this.#ended) throw error;
      return false;
    }
    return true;
  }

  #tick(now) {
    this.#frame = 0;
    this.#now = Math.max(now, this.#now); // frames are told when they began, which may be before an early one
    const draw = (viewer) => viewer.render(this.#now / 1000) || this.#wanting.delete(viewer);
    if (!this.#forEachWanting(draw)) return;
    this.#schedule();
  }

  // A picture takes many waits for the GPU, which seldom end with a frame. One that is there late does not wait for the
  // next frame either: the GPU would have nothing to do. Hidden pages have no frames, and soon draw nothing.
  #lookLater() {
    clearTimeout(this.#timer);
    if (!this.#frame || performance.now() - this.#framed > Runtime.#kMostBetween) return;
    this.#timer = setTimeout(() => {
      let [works, shows] = [false, false];
      const work = (viewer) => {
        const { more, waits } = viewer.work();
        [works, shows] = [works || more, shows || waits];
      };
      if (!this.#forEachWanting(work)) return;
      if (shows && performance.now() - this.#drawn > Runtime.#kLate) {
        cancelAnimationFrame(this.#frame);
        this.#tick(performance.now());
        works = true;
      }
      if (works || shows) this.#lookLater();
    }, Runtime.#kBetween);
  }

  // Memory that ran out, or a mistake of ours: what the module holds is not to be trusted any more. The next one who asks
  // for the page's runtime gets a fresh one.
  #end({ message }, handle) {
    this.#ended = new LucentError(
      'abort',
      `${kNames[this.#kind]}.wasm: ended (${message}); the scenes of the page may need more memory than it has`,
    );
    this.#leave();
    this.#wanting.clear();
    for (const viewer of [...this.#viewers]) viewer.moduleEnded(this.#ended, handle);
    this.#viewers.clear();
  }

  #leave() {
    this.#lost = true;
    Runtime.#shared[this.#kind] = undefined;
    cancelAnimationFrame(this.#frame);
    clearTimeout(this.#timer);
    this.#gl.getExtension('WEBGL_lose_context')?.loseContext(); // browsers keep few contexts
  }

  // Emscripten knows contexts by number; after a loss the restored one is registered anew with its extensions.
  #takeContext() {
    const { GL } = this.#wasm;
    GL.makeContextCurrent(GL.registerContext(this.#gl, { majorVersion: 2, minorVersion: 0 }));
    return this.text('lucent_start');
  }

  #lose(event) {
    if (this.#lost) return; // given back
    event.preventDefault(); // else the browser never gives it back
    this.#lost = true;
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    this.call('lucent_context_lost');
    for (const viewer of this.#viewers) viewer.contextLost();
  }

  #restore() {
    this.#lost = false;
    const message = this.#takeContext();
    for (const viewer of this.#viewers) {
      viewer.contextRestored(message);
      this.#wanting.add(viewer);
    }
    this.#schedule();
  }
}
