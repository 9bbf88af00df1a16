/**
 * <lucent-viewer src="coin.json" controls poster="coin.jpg" loading="lazy" alt="A coin"></lucent-viewer>
 *
 * A scene names files beneath its own folder; allow="https://models.example/ ../maps/" adds folders.
 *
 * Shows a scene that a person can light. Besides the attributes above every parameter of the scene is an attribute
 * and, in camel case, a property: light-intensity="2" is viewer.lightIntensity = 2.
 *
 * In a scene in which something moves, time runs from play() to pause(), or from the start with `autoplay`, unless the
 * person prefers reduced motion.
 *
 * compare="truth" or "error" shows the picture beside its exact truth: that of the file which `truth` names (with its
 * own error in `truth-noise`), which belongs to the scene as src has it, or one that is computed when a person asks;
 * "methods" shows it beside the same scene drawn by other methods: beside-relief-method="march"; "materials" beside the
 * same scene of other materials.
 */
import { reflect } from './attributes.js';
import { BakeBar } from './bake.js';
import { acceptDrops } from './bring.js';
import { Controls } from './controls.js';
import { encodeExr, filesOfScene, loadZip, namesIn } from './files.js';
import { Gestures } from './gestures.js';
import { Loader } from './loader.js';
import { isOfHtml, nearestName } from './names.js';
import { question } from './question.js';
import { LucentError, Runtime } from './runtime.js';
import { Stage } from './stage.js';
import { TruthBar } from './truth.js';
import { camelCase, textOf, valueOf } from './values.js';
import { WorkBar } from './workbar.js';

const kMaxScale = 2; // device pixels a CSS pixel: more is not seen, but costs
const kNear = '300px'; // around the window: within it viewers load and draw
const kReleaseAfter = 4000; // ms off screen until the GPU memory goes back
const kProfilesMs = 100; // between two calls for figures that take longer
const kUp = 2; // of events of the pointer: see viewer_pointer in Api.h
const kDark = matchMedia('(prefers-color-scheme: dark)');
const kCalm = matchMedia('(prefers-reduced-motion: reduce)');

export class LucentViewer extends HTMLElement {
  static observedAttributes = ['src', 'controls', 'poster', 'alt', 'truth'];

  #stage = new Stage(this);
  #truth; // TruthBar
  #drawing = new WorkBar('drawing', 'Drawing', {
    label: 'Stop',
    title: 'Keep the picture as it is now',
    act: () => this.stop(),
  });
  #bake; // BakeBar
  #rmse; // that was said last
  #asked = false; // what becomes of what nobody paints
  #truthFetched = false; // the file was asked for since the scene was loaded
  #twin;
  #loader = new Loader(this, this.#stage, {
    attached: () => this.#attach(),
    take: (name, how) => this.#takeScene(name, how),
    restore: (changes) => Object.entries(changes).forEach(([path, text]) => this.#set(path, String(text))),
    fail: (error) => this.#fail(error),
    tell: (message) => this.#tell(message),
    request: () => this.#request(),
  });
  #display = null; // the canvas's context
  #paintAsLoaded = ''; // see #paint()
  #near = false; // the element or its surroundings are on the screen
  #seen = false; // the element itself is
  #size = { width: 0, height: 0, scale: 1 };
  #controls = []; // descriptors with values
  #profilesLater;
  #controlsLater = 0;
  #revision = -1;
  #properties = []; // names that the scene's parameters have here
  #settled = []; // resolve functions that wait for the finished picture
  #complete = false; // the picture shown is
  #capturing = false; // the picture is drawn without the panel and for nobody to see
  #timers = {};
  #observers = [];
  #themeChanged = () => this.#apply('viewer_dark', kDark.matches ? 1 : 0);
  #calmChanged = () => kCalm.matches && this.pause();

  constructor() {
    super();
    this.#stage.play.addEventListener('click', () => (this.paused ? this.play() : this.pause()));
    this.#twin = new Controls({
      set: (path, text) => this.#set(path, text),
      get: (path) => this.#runtime.text('viewer_get', this.#handle, path),
      reset: (path) => this.reset(path),
      act: (path) => this.act(path),
      focus: (path) => this.#apply('viewer_focus', path),
    });
    const { canvas, divider, zones } = this.#stage;
    divider.addEventListener('input', () => this.#set('divider', divider.value));
    divider.addEventListener('focus', () => this.#apply('viewer_focus', 'divider'));
    divider.addEventListener('blur', () => this.#apply('viewer_focus', ''));
    this.#truth = new TruthBar({
      ask: () => this.#runtime.files('viewer_ask_truth', this.#handle),
      take: ({ pixels, width, height, noise }) =>
        this.#takeTruth('viewer_take_truth', new Uint8Array(pixels.buffer), width, height, noise),
      open: ({ name, bytes }, noise) => this.#takeTruth('viewer_open_truth', name, bytes, noise ?? -1),
      fail: (error) => this.#fail(error),
      changed: () => this.#truth.update(this.comparison()),
    });
    this.#bake = new BakeBar({
      ask: () => this.#runtime.files('viewer_ask_bake', this.#handle),
      take: (work, bytes) => {
        const message = this.#runtime.text('viewer_take_bake', this.#handle, work, bytes);
        if (message) throw new LucentError('scene', message);
        this.#request();
      },
      fail: (error) => this.#fail(error),
      say: (text) => this.#stage.say(text),
    });
    this.#stage.addBars(this.#truth.element, this.#bake.element, this.#drawing.element, this.#loader.bar);
    new Gestures(canvas, {
      pointer: (...event) => this.#pointer(...event),
      wheel: (...event) => this.#apply('viewer_wheel', ...event),
      pinch: (factor) => this.#apply('viewer_pinch', factor),
      key: (...event) => this.#apply('viewer_key', ...event),
      hint: (touch) => this.#stage.showHint(touch),
    });
    acceptDrops(this, zones);
  }

  connectedCallback() {
    const attributes = new MutationObserver((records) => this.#attributesChanged(records));
    attributes.observe(this, { attributes: true });
    const size = new ResizeObserver(([entry]) => this.#resized(entry));
    try {
      size.observe(this.#stage.canvas, { box: 'device-pixel-content-box' });
    } catch {
      size.observe(this.#stage.canvas); // Safari
    }
    const place = new IntersectionObserver(([entry]) => this.#moved(entry.isIntersecting), { rootMargin: kNear });
    place.observe(this);
    const sight = new IntersectionObserver(([entry]) => this.#sighted(entry.isIntersecting));
    sight.observe(this);
    this.#observers = [attributes, size, place, sight];
    kDark.addEventListener('change', this.#themeChanged);
    kCalm.addEventListener('change', this.#calmChanged);
    if (this.loading === 'lazy') return;
    if (!this.src) Runtime.shared().catch(() => {}); // whoever loads hears of errors
    this.#loader.loadSource();
  }

  // Also called when the element is only moved within the page, hence the second look.
  disconnectedCallback() {
    this.#observers.forEach((observer) => observer.disconnect());
    kDark.removeEventListener('change', this.#themeChanged);
    kCalm.removeEventListener('change', this.#calmChanged);
    this.#near = this.#seen = false;
    queueMicrotask(() => this.isConnected || this.#destroy());
  }

  attributeChangedCallback(name, _, value) {
    if (name === 'alt') this.#stage.canvas.ariaLabel = value ?? '';
    if (name === 'poster') value === null ? this.#stage.poster.removeAttribute('src') : (this.#stage.poster.src = value);
    if (name === 'controls') {
      this.#layout();
      if (this.loaded) this.#showUndrawn();
    }
    if (name === 'truth') {
      this.#truthFetched = false;
      this.#compareChanged();
    }
    if (name !== 'src') return;
    this.#loader.sourceChanged();
    if (this.isConnected && (this.#near || this.loading !== 'lazy')) this.#loader.loadSource();
  }

  /** True once a scene is there: only then have parameters values. */
  get loaded() {
    return this.#controls.length > 0;
  }
  get sceneTitle() {
    return this.#ask('viewer_title');
  }
  get caption() {
    return this.#ask('viewer_caption');
  }
  /** The scene as a scene file, with its parameters as they are now. */
  get sceneJson() {
    return this.#ask('viewer_scene_json');
  }
  /**
   * The scene with every file it names, by their names: "scene.json" as sceneJson says it, paint included, and the files
   * as they were read. openFile() takes them, and saveScene() packs them. @return {Map<string, Blob>}
   */
  get sceneFiles() {
    if (!this.loaded) throw new LucentError('scene', 'sceneFiles: no scene is shown; one must be loaded');
    return filesOfScene(this.#runtime, this.sceneJson, this.#loader.sources);
  }
  /** What is shown and no link can carry, as its changes do: 'scene' or 'files' that the person opened, 'paint'. */
  get beyondLink() {
    if (!this.loaded) return [];
    const files = this.#loader.openedFiles;
    const used = files.size ? namesIn(this.#runtime, 'scene.json', new TextEncoder().encode(this.sceneJson)) : [];
    const found = this.#loader.brought ? ['scene'] : [];
    if (used.some((name) => files.has(name))) found.push('files');
    if (this.#paint() !== this.#paintAsLoaded) found.push('paint');
    return found;
  }
  /** {path: text} of every parameter that differs from the loaded scene: what a link carries. */
  get changes() {
    return JSON.parse(this.#ask('viewer_changes') || '{}');
  }

  /** A parameter by path ("objects.0.material.depth"): number, boolean, text or array of numbers. */
  get(path) {
    const control = this.#controls.find((one) => one.path === path);
    const text = this.#ask('viewer_get', path);
    return control ? valueOf(control, text) : text;
  }
  /** Sets a parameter. A wrong value changes nothing, fires an error event and returns false. */
  set(path, value) {
    return this.#set(path, textOf(this.#controls.find((one) => one.path === path) ?? {}, value));
  }
  /** One parameter, or without a path all, as the scene has them. */
  reset(path) {
    for (const one of path === undefined ? Object.keys(this.changes) : [path]) this.#apply('viewer_reset', one);
    this.#sync();
  }
  /** Does what a button of the panel does: "paint.fill", "paint.clearGlow". False, and an error event, when it cannot. */
  act(path) {
    const message = this.loaded ? this.#runtime.text('viewer_act', this.#handle, path) : 'no scene is loaded';
    if (message) this.#fail(new LucentError('value', message));
    this.#request();
    this.#sync();
    return !message;
  }
  undo() {
    return this.#step('viewer_undo');
  }
  redo() {
    return this.#step('viewer_redo');
  }

  /** True where something in the scene moves: there is something to play. */
  get moves() {
    return this.#controls.some(({ path, group }) => path === 'playing' && group);
  }
  get paused() {
    return this.#ask('viewer_get', 'playing') !== 'true';
  }
  /** Lets time run while the element is on the screen. False where nothing moves. */
  play() {
    return this.moves && this.#set('playing', 'true');
  }
  pause() {
    if (!this.paused) this.#set('playing', 'false');
  }

  /** Ends the work on the picture, which stays as it is until something changes. False where none is shown yet. */
  stop() {
    return this.#apply('viewer_stop') === 1;
  }

  /**
   * A drop falls into the water that is seen at a place of the element, and time runs.
   * @param x, y  CSS pixels from its top left corner. @return {boolean}  false where there is no water
   */
  drop(x, y) {
    const fell = this.#apply('viewer_drop', x, y) === 1;
    this.#sync();
    return fell;
  }

  /**
   * Of each translucent object: owner and profile; reach (mm) and whole (the share that leaves again) of
   * red, green and blue; distances (mm) and values (1/mm²) of its R_d; text, the same in words.
   */
  profiles() {
    return this.#profilesSoFar(true).filter(({ pending }) => !pending);
  }

  /**
   * Paints the strokes of a script on what is translucent, as one step that undo takes back. A wrong script changes
   * nothing, fires an error event and returns false.
   * @param script  as text or as what JSON.parse makes of it
   * @param object  its name; without one the first that can be painted
   */
  paint(script, object = '') {
    const text = typeof script === 'string' ? script : JSON.stringify(script);
    const message = this.loaded ? this.#runtime.text('viewer_paint', this.#handle, text, object) : 'no scene is loaded';
    if (message) this.#fail(new LucentError('value', message));
    this.#request();
    this.#sync();
    return !message;
  }

  /**
   * The maps of what is painted on an object, without a name the first that is: side, texels; entering and leaving,
   * Float32Array of side x side x 4, row by row. Null where nothing is painted.
   *
   * entering: factor of the light that enters, and how many times as dense the material is (1 / blur); leaving: factor
   * of what leaves, and the translucency.
   */
  paintedMaps(object = '') {
    return this.loaded ? this.#runtime.painting(this.#handle, object) : null;
  }

  /** All strokes on the painted object, as a script that paint() takes. */
  get strokes() {
    return JSON.parse(this.#ask('viewer_strokes', '') || '{"lucentStrokes": 1, "strokes": []}');
  }

  /**
   * Milliseconds, passes, draws, lights, bytes, complete, finished (complete, by all samples of its pixels), shown (there
   * is a picture), downscale (pixels that one which was drawn stands for, along a side), progress (of work
   * that takes long: task, share of it and, where known, secondsLeft), bake (technique, object and work: what is precomputed before the picture has it), pictures
   * (shown so far, drawn or reprojected), reprojected (what is shown is the last picture, seen by a camera that has moved
   * since), frames, modes that the scene has something for, where the panel's controls lie, and notDrawn: lines that say what the scene
   * asks for, the picture lacks, and why; while the caustic map is shown, energy: W of each colour that met glass and
   * mirrors, and what became of them.
   */
  stats() {
    return JSON.parse(this.#ask('viewer_stats') || '{}');
  }

  /**
   * How the picture stands to its truth: mode, divider, truth ('none', 'stale', 'fresh'), size, noise; of a finished
   * picture of the same scene rmse, relRmse, max, bias, p99, full; milliseconds, passes; place of the other picture,
   * pixelsPerCssPixel. With "methods" also flip; with it and "materials" left, what
   * stands there, and right with name and, of methods, the same numbers.
   */
  comparison() {
    return JSON.parse(this.#ask('viewer_comparison') || '{"mode": "off", "truth": "none"}');
  }
  /**
   * Computes the truth of the scene as it is now, in a worker; it is shown while compare is on.
   * @param longer  its longer side in pixels; without one as large as takes half a minute or so
   */
  computeTruth(longer) {
    return this.#truth.compute(longer);
  }

  /**
   * Closed forms and capabilities on this device. @param options  signal to cancel, progress(share)
   * @return {Promise<object>}  device, passed, checks, capabilities
   */
  async selfCheck(options) {
    const { runSelfCheck } = await import('./selfcheck.js');
    return runSelfCheck(options);
  }

  /**
   * The finished picture, by all samples of its pixels, with nothing over it.
   * @param options  type, 'image/png' unless given; 'image/x-exr' holds linear values; quality of a lossy type. width and
   *                 height: pixels, those of the canvas unless given, up to largestSide; other ones are drawn beside
   *                 what the page shows. signal: AbortSignal. Or the type alone, and the quality behind it
   */
  async toBlob(options = {}, quality) {
    const asked = typeof options === 'string' ? { type: options, quality } : options;
    this.#refuseWithoutPicture('toBlob()');
    await this.#bake.whenIdle();
    const { width, height } = this.#size;
    const { type = 'image/png' } = asked;
    if (type === 'image/x-exr' || (asked.width ?? width) !== width || (asked.height ?? height) !== height)
      return (await this.#loadExport()).picture(this.#studio(asked), asked);
    const canvas = await this.#canvasWhenFinished();
    return new Promise((resolve) => canvas.toBlob(resolve, type, asked.quality));
  }
  async #canvasWhenFinished() {
    const playing = !this.paused;
    this.pause();
    this.#capturing = true;
    this.#apply('viewer_panel', 0);
    this.#apply('viewer_bare', 1);
    await this.#whenFinished();
    const copy = document.createElement('canvas');
    copy.width = this.#stage.canvas.width;
    copy.height = this.#stage.canvas.height;
    copy.getContext('2d').drawImage(this.#stage.canvas, 0, 0);
    this.#capturing = false;
    this.#apply('viewer_bare', 0);
    this.#layout();
    if (!this.#near) this.#moved(false);
    if (playing) this.play();
    return copy;
  }

  /**
   * Pictures one after the other, drawn beside what the page shows.
   * @param options  path: 'camera' leads the camera around its target, over a relief to and fro; 'lamp' leads the first
   *                 lamp around, or without one turns the environment. frames; width and height as in toBlob(); type:
   *                 'application/zip' of numbered PNG files called `name`-0001.png and so on, or 'video/webm' where
   *                 canRecord, with fps; signal; progress(share)
   * @return {Promise<Blob>}
   */
  async toSequence(options) {
    this.#refuseWithoutPicture('toSequence()');
    await this.#bake.whenIdle();
    return (await this.#loadExport()).sequence(this.#studio(options), options);
  }
  /** Of the picture on the page: width and height, pixels. */
  get pictureSize() {
    const { width, height } = this.#size;
    return { width, height };
  }
  /** Longest side that a picture can have on this device, pixels; 0 before a scene is loaded. */
  get largestSide() {
    return this.#runtime?.largestSide ?? 0;
  }
  /** Whether toSequence() can make videos in this browser. */
  static get canRecord() {
    return 'captureStream' in HTMLCanvasElement.prototype && Boolean(self.MediaRecorder?.isTypeSupported('video/webm'));
  }
  #refuseWithoutPicture(where) {
    if (!this.loaded || !this.#size.width)
      throw new LucentError('scene', `${where}: no scene is shown; one must be loaded and have a size on the page`);
  }
  #loadExport() {
    return import('./export.js').catch(({ message }) => {
      throw new LucentError('fetch', `export.js: ${message}; it must lie beside the script`);
    });
  }
  // What export.js draws with.
  #studio({ width = this.#size.width, height = this.#size.height }) {
    const [runtime, handle] = [this.#runtime, this.#handle];
    return { runtime, handle, width, height, scene: JSON.parse(this.sceneJson), encodeExr, loadZip };
  }

  /** The scene with every file it names, as a zip archive (.lucent.zip): this page and the program open it. */
  async saveScene() {
    const files = this.sceneFiles;
    const { packZip } = await loadZip();
    return packZip(files);
  }

  /**
   * The scene that is shown where it is made of a person's own files, else null: `path` of the scene file as it is now,
   * and `files`, the bytes of it and of all that it names by name (Map).
   */
  get ownScene() {
    if (!this.#loader.brought) return null;
    const { path, files } = this.#loader.brought;
    return { path, files: new Map(files).set(path, new TextEncoder().encode(this.sceneJson)) };
  }

  /**
   * Shows a scene file with all that it names or a saved scene, makes a scene of files that a person chose, or takes a
   * picture as the environment of the one that is shown.
   * @param files  File, or Blob with a name, or several: pictures that belong together, a model with its parts
   * @param kind   'scene' or 'environment'
   * @return {Promise<boolean>}  whether it is shown
   */
  openFile(files, kind = 'scene') {
    return this.#loader.openFiles(files instanceof Blob ? [files] : [...files], kind);
  }

  // ---- called by the runtime ----

  /** @return {boolean}  true while another frame is wanted */
  render(seconds) {
    if (!this.#draws) return false;
    const { width, height } = this.#size;
    const { more, drawn } = this.#runtime.draw(this.#handle, width, height, seconds);
    this.#sync();
    const shown = this.#takePicture(drawn);
    if (shown && this.#loader.isLeaving && !this.#settled.length) return false; // what comes is worth more
    return more && (this.#seen || !this.#complete || this.#capturing); // nothing plays where nobody sees it
  }
  work() {
    return this.#draws ? this.#runtime.work(this.#handle) : {};
  }
  get #draws() {
    return this.#handle && this.#size.width > 0 && !this.#loader.isAdopting && (this.#near || this.#settled.length > 0);
  }
  contextLost() {
    this.#stage.poster.hidden = false;
    this.#stage.status = 'Waiting for the graphics card…';
    this.#emit('contextlost');
  }
  contextRestored(message) {
    if (message) this.#fail(new LucentError('gpu', message));
    else this.#emit('contextrestored');
  }

  /** @param handle  of the viewer in whose call the module ended */
  moduleEnded(error, handle) {
    const loadAgain = this.#loader.moduleEnded(handle);
    this.#forget();
    this.#settled.splice(0).forEach((resolve) => resolve());
    this.#fail(error);
    loadAgain();
  }

  // ---- loading

  get #runtime() {
    return this.#loader.runtime;
  }
  get #handle() {
    return this.#loader.handle;
  }

  // To another viewer of the module, or of another module.
  #attach() {
    this.#display ??= this.#stage.canvas.getContext(this.#runtime.displayContext);
    this.#themeChanged();
    this.#layout();
    this.#resizeViewer();
  }

  // What is painted on all objects, as text.
  #paint() {
    return JSON.stringify(JSON.parse(this.sceneJson).objects.map(({ paint }) => paint));
  }

  // A new scene is there: its parameters become attributes, properties and controls.
  #takeScene(name, how) {
    this.#stage.status = 'Drawing…';
    this.#complete = false;
    if (!how.into) this.#paintAsLoaded = this.#paint();
    this.#controls = this.#runtime.json('viewer_controls', this.#handle);
    this.#defineProperties();
    this.#stage.closeQuestion();
    const given = this.#controls.filter(({ attribute }) => attribute && this.hasAttribute(attribute));
    for (const control of given) this.#setFromAttribute(control);
    if (given.length > 0) this.#controls = this.#runtime.json('viewer_controls', this.#handle);
    this.#warnOfNames();
    this.#revision = this.#runtime.call('viewer_revision', this.#handle);
    this.#showControlsLater();
    this.#showPlay();
    if (this.autoplay && !kCalm.matches) this.play();
    this.#layout();
    this.#request();
    this.#truth.cancel();
    this.#truthFetched = false;
    this.#compareChanged();
    this.#askBeforePaint();
    this.#emit('load', { src: name, ...how });
  }

  #fail(error) {
    const code = error instanceof LucentError ? error.code : 'internal';
    this.#tell(error.message);
    this.#emit('error', { code, message: error.message });
  }

  // In the picture, and for those who do not see it.
  #tell(message) {
    if (this.#handle) this.#apply('viewer_message', message);
    const covered = !this.#handle || (this.poster && !this.#stage.poster.hidden);
    this.#stage.status = covered ? message : '';
    this.#stage.say(message);
  }

  #destroy() {
    const { runtime, handle } = this.#loader;
    this.#forget();
    if (handle) runtime.drop(handle, this);
  }

  // As before the first load.
  #forget() {
    this.#loader.forget();
    this.#truth.cancel();
    this.#bake.update(undefined);
    this.#controls = [];
    clearTimeout(this.#timers.release);
  }

  // ---- parameters ----

  #defineProperties() {
    for (const name of this.#properties) delete this[name];
    this.#properties = [];
    for (const control of this.#controls) {
      const name = camelCase(control.attribute);
      if (!name || name in HTMLElement.prototype) continue;
      const early = Object.getOwnPropertyDescriptor(this, name)?.value; // set before the scene was there
      Object.defineProperty(this, name, {
        configurable: true,
        enumerable: true,
        get: () => this.get(control.path),
        set: (value) => this.setAttribute(control.attribute, textOf(control, value)) ?? this.#setFromAttribute(control),
      });
      this.#properties.push(name);
      if (early !== undefined) this.setAttribute(control.attribute, textOf(control, early));
    }
  }

  #attributesChanged(records) {
    for (const { attributeName } of records) {
      const control = this.#controls.find((one) => one.attribute === attributeName);
      if (control) this.#setFromAttribute(control);
    }
  }

  #setFromAttribute(control) {
    const value = this.getAttribute(control.attribute);
    if (value === null) this.reset(control.path);
    else this.#set(control.path, textOf(control, value));
  }

  // What is written and means nothing.
  #warnOfNames() {
    const names = this.#controls.map(({ attribute }) => attribute).filter(Boolean);
    const isKnown = (name) => names.includes(name) || camelCase(name) in this || isOfHtml(name);
    for (const name of this.getAttributeNames().filter((one) => !isKnown(one))) {
      const nearest = nearestName(name, [...names, ...LucentViewer.observedAttributes]);
      const meant = nearest ? `did you mean ${nearest}?` : 'must be a parameter of the scene';
      console.warn(`<lucent-viewer>: attribute ${name} does nothing here; ${meant}`);
    }
  }

  #set(path, text) {
    if (!this.loaded) {
      this.#fail(new LucentError('value', `${path}: no scene is loaded; parameters come with a scene`));
      return false;
    }
    if (text === this.#ask('viewer_get', path)) return true;
    const message = this.#runtime.text('viewer_set', this.#handle, path, text);
    if (message) this.#fail(new LucentError('value', message));
    this.#request();
    this.#sync();
    return !message;
  }

  #step(name) {
    const done = this.#apply(name) === 1;
    this.#sync();
    return done;
  }

  // @param numbers  false: owner and text alone, which take no time
  #profilesSoFar(numbers) {
    return JSON.parse(this.#ask('viewer_profiles', numbers) || '[]');
  }

  // Their words, as they are worked out: each call takes its time.
  #showProfiles() {
    if (!this.stats().shown) return this.#showProfilesLater(); // the first look comes first
    const profiles = this.#profilesSoFar(false);
    this.#twin.describe(profiles.filter(({ pending }) => !pending));
    if (profiles.some(({ pending }) => pending)) this.#showProfilesLater();
  }

  // Of another scene: there may be a hundred.
  #showControlsLater() {
    clearTimeout(this.#controlsLater);
    this.#controlsLater = setTimeout(async () => {
      if (!this.loaded) return;
      this.#showUndrawn();
      await this.#twin.buildLater(this.#controls);
      this.#showProfilesLater();
    });
  }

  #showProfilesLater() {
    clearTimeout(this.#profilesLater);
    this.#profilesLater = setTimeout(() => this.loaded && this.#showProfiles(), kProfilesMs);
  }

  // Takes over what changed in the module, by whatever road.
  #sync() {
    if (!this.loaded || this.#loader.isAdopting) return;
    const revision = this.#runtime.call('viewer_revision', this.#handle);
    if (revision === this.#revision) return;
    this.#revision = revision;
    const before = new Map(this.#controls.map((control) => [control.path, control.value]));
    this.#controls = this.#runtime.json('viewer_controls', this.#handle);
    this.#twin.update(this.#controls);
    this.#showProfiles();
    const changed = this.#controls.filter((control) => control.value !== before.get(control.path));
    if (!this.#runtime.isWhole && !this.#runtime.call('viewer_draws_all', this.#handle)) this.#loader.moveToWhole();
    this.#compareChanged();
    this.#showPlay();
    this.#showUndrawn();
    if (changed.some(({ path }) => path === 'mode')) this.#askBeforePaint();
    this.#emit('edit');
    for (const control of changed) this.#emit('change', { path: control.path, value: valueOf(control, control.value) });
    if (!changed.length || !this.#stage.hasFocus) return;
    const [{ label, value, unit }] = changed;
    this.#stage.sayLater(`${label} ${value} ${unit}`);
  }

  // The first stroke decides what becomes of the rest of an object.
  #askBeforePaint() {
    const isDecided = this.hasAttribute('paint-unpainted') || this.strokes.strokes.length > 0;
    if (this.#asked || isDecided || this.get('mode') !== 'paint') return;
    this.#asked = true;
    const opaque = () => {
      this.#set('paint.unpainted', 'opaque');
      this.#set('paint.brush', 'translucency');
    };
    const dialog = question(
      'Before you paint',
      'What shall become of the parts that you do not paint? You find this later as Unpainted among the controls.',
      [
        ['They stay as they are', () => {}],
        ['They become opaque: light goes inside only where I paint', opaque],
      ],
    );
    this.#stage.ask(dialog);
  }

  #showPlay() {
    this.#stage.showPlay(this.moves, this.paused);
  }

  // Beside the other controls; stats() says it to whoever shows a picture without them.
  #showUndrawn() {
    this.#stage.showUndrawn(this.stats().notDrawn, this.controls !== null);
  }

  // ---- the truth ----

  // Whatever decides about the comparison may have changed.
  #compareChanged() {
    if (!this.loaded) return;
    const comparison = this.comparison();
    const { mode, divider, truth } = comparison;
    this.#stage.divider.hidden = mode === 'off' || (truth === 'none' && mode !== 'methods' && mode !== 'materials');
    this.#stage.divider.value = divider;
    if (mode !== 'off' && truth === 'none' && this.truth && !this.#truthFetched && !this.#truth.busy) {
      this.#truthFetched = true;
      this.#truth.fetch(new URL(this.truth, document.baseURI), this.truthNoise);
    }
    this.#truth.update(comparison);
  }

  #sayNumbers() {
    const { rmse, right } = this.comparison();
    const said = [rmse, right?.rmse].filter((one) => one !== undefined).map((one) => one.toPrecision(2));
    if (said.length && said.join() !== this.#rmse)
      this.#stage.say(`Root mean square error ${said.join(' on the left, on the right ')}`);
    this.#rmse = said.join();
  }

  #takeTruth(name, ...values) {
    const message = this.#runtime.text(name, this.#handle, ...values);
    if (message) throw new LucentError('scene', message);
    this.#request();
    this.#compareChanged();
  }

  // ---- drawing ----

  #takePicture(drawn) {
    const { complete, finished, shown, progress, bake, open } = this.stats();
    this.#bake.update(bake);
    if (drawn) this.#stage.placeBars(open);
    if (drawn && (complete || !this.#capturing)) this.#runtime.show(this.#display);
    this.#complete = complete;
    this.#drawing.show(progress);
    if (drawn && shown) {
      this.#stage.poster.hidden = true;
      this.#stage.status = '';
    }
    if (complete) {
      this.#sayNumbers();
      if (drawn) this.#truth.update(this.comparison()); // in a place of another size
    }
    if (finished) this.#settled.splice(0).forEach((resolve) => resolve());
    if (drawn) this.#emit('frame', { complete });
    return shown;
  }

  #whenFinished() {
    return new Promise((resolve) => {
      this.#settled.push(resolve);
      this.#request();
    });
  }

  #request() {
    if (this.#handle) this.#runtime.request(this);
  }

  // What a hand has done is known when it lets go, not with the next picture.
  #pointer(event, ...rest) {
    const used = this.#apply('viewer_pointer', event, ...rest);
    if (event === kUp) this.#sync();
    return used;
  }

  // Calls the module about this viewer when there is one; the picture may change by it.
  #apply(name, ...values) {
    if (!this.#handle) return 0;
    const result = this.#runtime.call(name, this.#handle, ...values);
    this.#request();
    return result;
  }

  #ask(name, ...values) {
    return this.#handle ? this.#runtime.text(name, this.#handle, ...values) : '';
  }

  // ---- size and place ----

  #resized(entry) {
    const css = entry.contentRect;
    const scale = Math.min(devicePixelRatio, kMaxScale);
    const box = entry.devicePixelContentBoxSize?.[0];
    const exact = box && Math.abs(box.inlineSize - css.width * scale) <= 1; // not when capped or emulated
    const width = exact ? box.inlineSize : Math.round(css.width * scale);
    const height = exact ? box.blockSize : Math.round(css.height * scale);
    this.#size = { width, height, scale };
    this.#resizeViewer();
  }

  #resizeViewer() {
    const { width, height, scale } = this.#size;
    if (width && height) this.#apply('viewer_resize', width, height, scale);
  }

  // Where the controls are: on the canvas, below it, or nowhere.
  #layout() {
    const wanted = this.controls !== null;
    const below = this.controls === 'html';
    const twin = this.#twin.element;
    twin.classList.toggle('shown', below);
    if (!wanted) twin.remove();
    else if (!twin.parentNode) this.#stage.root.append(twin); // moved within the page it would lose the focus
    this.#apply('viewer_panel', wanted && !below ? 1 : 0);
  }

  #moved(near) {
    this.#near = near;
    clearTimeout(this.#timers.release);
    if (near) {
      this.#loader.loadSource();
      this.#request();
    } else {
      this.#timers.release = setTimeout(
        () => this.#handle && this.#runtime.call('viewer_release', this.#handle),
        kReleaseAfter,
      );
    }
  }

  #sighted(seen) {
    this.#seen = seen;
    if (seen) this.#request();
  }

  #emit(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}

reflect(LucentViewer, {
  src: 'text',
  controls: 'option',
  poster: 'text',
  allow: 'text', // addresses of folders, with blanks between them, beneath which the scene's files may lie
  truth: 'address',
  truthNoise: 'number', // RMSE that the truth in the file has itself; null: not known
  loading: 'loading',
  alt: 'text',
  autoplay: 'flag', // scenes in which something moves play at once, unless the person prefers reduced motion
});
customElements.define('lucent-viewer', LucentViewer);
