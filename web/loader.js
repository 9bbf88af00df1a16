/**
 * What a viewer shows comes from here: a scene by its address, or one of a person's files, and the viewer of the module that
 * draws it. One load at a time: a newer one takes the place of those before.
 */
import { bringScene, openPicture } from './bring.js';
import { Fetching, fetchScene, freeName, loadFiles, needsWhole, openScene, sceneAmong, sourcesOf } from './files.js';
import { PhotoBar } from './photos.js';
import { LucentError, Runtime } from './runtime.js';
import { nextTask } from './task.js';
import { askUses } from './uses.js';
import { Watch, WorkBar } from './workbar.js';

export class Loader {
  /** Runtime; null: none yet */
  runtime = null;
  /** The module's viewer, 0: none yet */
  handle = 0;
  /** The module has a scene whose parameters are still to come */
  isAdopting = false;
  /** {path, files} of the scene that is shown, where it is made of a person's files, else null */
  brought = null;
  /** By name what was read for each file of the scene: see collect() in files.js */
  sources = new Map();
  /** Names of files that the person opened into the scene */
  openedFiles = new Set();

  #viewer;
  #stage;
  #host;
  #bar = new WorkBar('loading', 'Loading', {
    label: 'Cancel',
    title: 'Keep what was shown before',
    act: () => this.#fetching.abort(),
  });
  #photos = new PhotoBar();
  #fetching = new AbortController(); // of what is being fetched
  #task = 0; // number of the newest load: older ones give up
  #leaving = null; // that of a load of another address, for which the scene that is shown is not refined any more
  #src = null; // what is loaded or on its way
  #shown = null; // what is loaded

  /**
   * @param viewer  <lucent-viewer>
   * @param stage   its Stage
   * @param host    what it does about loads: attached(), a viewer of a module is there, the first or in place of another;
   *                take(name, how), that has a scene of this name, with how it came: opened, moved and into, see #load();
   *                restore(changes), a scene that moved to another module has lost these; fail(error); tell(message);
   *                request() of a frame
   */
  constructor(viewer, stage, host) {
    this.#viewer = viewer;
    this.#stage = stage;
    this.#host = host;
  }

  /** How far a load is that takes long. */
  get bar() {
    return this.#bar.element;
  }

  /** Another address is on its way: the scene that is shown is not refined any more. */
  get isLeaving() {
    return this.#leaving === this.#task;
  }

  // ---- by address

  /** The viewer's src was written, maybe once more: the next loadSource() loads it. */
  sourceChanged() {
    this.#src = null;
  }

  /**
   * Loads the viewer's src where it is not loaded yet.
   * @param again  whether to try once more where another viewer ended the module
   */
  async loadSource(again = true) {
    const { src, allow } = this.#viewer;
    if (!src || src === this.#src) return;
    const task = (this.#leaving = ++this.#task);
    this.#src = src;
    this.#stage.status = 'Loading…';
    this.#fetching.abort();
    this.#bar.show(undefined);
    const mine = (this.#fetching = new AbortController());
    const watch = new Watch(this.#bar);
    try {
      const allowed = allow.split(/\s+/).filter(Boolean);
      const scene = await fetchScene(
        (whole) => Runtime.shared(whole),
        new URL(src, document.baseURI),
        allowed.map((address) => new URL(address, document.baseURI)),
        new Fetching((share) => watch.tell(share), mine.signal),
      );
      if (task === this.#task) this.#bar.show(undefined);
      const seat = await this.#seat(task, scene.whole);
      if (seat) await this.#load(seat, task, { name: src }, () => loadFiles(seat, scene));
    } catch (error) {
      if (task !== this.#task) return;
      this.#bar.show(undefined);
      if (mine.signal.aborted) return this.#cancelled();
      this.#host.fail(error);
      if (error.code !== 'abort' || !again || this.handle) return;
      this.#src = null;
      this.loadSource(false);
    } finally {
      if (this.#leaving === task) {
        this.#leaving = null;
        this.#host.request();
      }
    }
  }

  // The person ended a load: what was shown stays.
  #cancelled() {
    this.#stage.status = this.#viewer.loaded ? '' : 'Loading was cancelled';
    this.#stage.say('Loading was cancelled');
  }

  // ---- a person's own files

  /** @param files  File[]. @param kind  'scene' or 'environment'. @return {Promise<boolean>}  whether it is shown */
  async openFiles(files, kind) {
    const task = ++this.#task;
    this.#stage.status = 'Loading…';
    try {
      if (kind === 'environment') return await this.#openEnvironment(task, files[0]);
      const start = (whole) => Runtime.shared(whole);
      return await this.#openScene(task, await (sceneAmong(files) ? openScene(start, files) : this.#bring(files)));
    } catch (error) {
      if (task === this.#task) this.#host.fail(error);
      return false;
    }
  }

  #bring(files) {
    return bringScene(files, {
      ask: (pictures) => askUses(this.#stage.root, pictures),
      solve: (light, photos) => {
        this.#stage.status = '';
        this.#stage.addBars(this.#photos.element);
        return this.#photos.solve(light, photos);
      },
    });
  }

  // @param scene  {path, files, sources} of a person's own; null: they went back
  async #openScene(task, scene) {
    if (task !== this.#task) return false;
    if (!scene) this.#stage.status = '';
    if (!scene) return false;
    const seat = await this.#seat(task, needsWhole(scene.files.get(scene.path)));
    const load = () => loadFiles(seat, scene);
    const isShown = seat !== null && (await this.#load(seat, task, { name: scene.path, own: scene }, load));
    if (scene.residual && this.brought === scene) await this.#photos.showResidual(scene);
    if (isShown && scene.environment) await this.#openEnvironment(task, scene.environment);
    if (isShown && scene.left?.length) this.#host.tell(`left out: ${scene.left.join('; ')}`);
    return isShown;
  }

  async #openEnvironment(task, file) {
    const { name: given, bytes } = await openPicture(file);
    const name = freeName(given, this.sources);
    const seat = await this.#seat(task, false);
    if (!seat) return false;
    const { path, files } = this.brought ?? {};
    const own = this.brought && { path, files: new Map(files).set(name, bytes) };
    return this.#load(seat, task, { name, own, opened: true }, () => {
      const message = seat.runtime.text('viewer_open_environment', seat.handle, name, bytes);
      if (message) throw new LucentError('file', message);
      return sourcesOf([[name, bytes]]);
    });
  }

  // ---- the module

  // A viewer of a module that draws what is loaded: the one that is there where it does, else a fresh one. Null where the
  // load is no longer wanted: the element was removed, or loads something else.
  async #seat(task, whole) {
    if (this.handle && (this.runtime.isWhole || !whole)) return { runtime: this.runtime, handle: this.handle };
    const runtime = await Runtime.shared(whole);
    if (task !== this.#task) return null;
    const seat = { runtime, handle: runtime.call('viewer_create') };
    await nextTask(); // the first viewer of a page draws the glyphs of the panel's font
    if (task !== this.#task) {
      runtime.drop(seat.handle);
      return null;
    }
    if (!this.handle) this.#moveTo(seat);
    return seat;
  }

  #moveTo({ runtime, handle }) {
    if (this.handle) this.runtime.drop(this.handle, this.#viewer);
    this.runtime = runtime;
    this.handle = handle;
    runtime.add(this.#viewer);
    this.#host.attached();
  }

  // The scene that was showing stays, with its viewer, until the new one is there.
  // @param load  gives the sources of what it loads: all of a scene, or those of a file that comes into it
  // @param how  name; own: {path, files} of a person's files, null: none; opened: by the person; moved: it was shown
  //             before, by the other module. The host hears, too, whether it came into the scene that was shown
  async #load(seat, task, { name, own = null, opened = own !== null, moved = false }, load) {
    const moves = seat.runtime !== this.runtime;
    const before = moves ? 0 : this.#sceneNumber();
    const src = this.#src;
    let sources;
    let isThere = false;
    try {
      sources = await load();
      isThere = task === this.#task;
    } finally {
      if (moves && !isThere) seat.runtime.drop(seat.handle);
    }
    if (!isThere) return false;
    this.isAdopting = true;
    await nextTask(); // the module has taken the scene; what the page makes of it takes as long again
    this.isAdopting = false;
    if (moves && task !== this.#task) seat.runtime.drop(seat.handle);
    if (moves ? task !== this.#task : !this.handle) return false;
    if (moves) this.#moveTo(seat);
    if (own && own.path !== this.brought?.path) {
      this.#viewer.truth = '';
      this.#viewer.alt = seat.runtime.text('viewer_title', seat.handle);
    }
    this.brought = own;
    this.#photos.clear();
    this.#shown = src;
    const into = this.#sceneNumber() === before;
    this.#takeSources(sources, into);
    this.#host.take(name, { opened, moved, into });
    return true;
  }

  #sceneNumber() {
    return this.runtime.call('viewer_scene_number', this.handle);
  }

  // @param into  they came into the scene that was shown
  #takeSources(sources, into) {
    if (!into) {
      this.sources = sources;
      this.openedFiles.clear();
      return;
    }
    for (const [name, source] of sources) {
      this.sources.set(name, source);
      this.openedFiles.add(name);
    }
  }

  /** A material was chosen that the module of reliefs does not draw: the viewer goes on in the whole one. */
  async moveToWhole() {
    const task = ++this.#task;
    this.#stage.status = 'Loading…';
    try {
      const seat = await this.#seat(task, true);
      if (!seat) return;
      const { src, changes } = this.#viewer;
      const hadFiles = this.openedFiles.size > 0;
      const path = this.brought?.path ?? 'scene.json';
      const packed = [...this.runtime.files('viewer_pack', this.handle)];
      const scene = { path, files: new Map(packed.map(([name, bytes]) => [name === 'scene.json' ? path : name, bytes])) };
      const how = { name: src, own: this.brought && scene, moved: true };
      if (!(await this.#load(seat, task, how, () => loadFiles(seat, scene)))) return;
      if (hadFiles) this.openedFiles = new Set(this.sources.keys()); // which have other names now
      this.#host.restore(changes);
    } catch (error) {
      if (task === this.#task) this.#host.fail(error);
    }
  }

  /**
   * The module has ended, and with it the viewer.
   * @param handle  of the viewer in whose call it ended, 0: of none
   * @return {() => void}  loads once more what is not to blame for that; call it when nothing is left of the old one
   */
  moduleEnded(handle) {
    const isLoaded = this.#viewer.loaded && this.#src === this.#shown;
    const isInnocent = handle !== this.handle && (handle !== 0 || isLoaded);
    const own = this.brought;
    return () => {
      if (!isInnocent) return;
      if (own) this.#openScene(++this.#task, own).catch((reason) => this.#host.fail(reason));
      else this.loadSource();
    };
  }

  /** As before the first load. The viewer of the module is the caller's to drop. */
  forget() {
    this.#task++;
    this.#fetching.abort();
    this.#bar.show(undefined);
    this.#photos.cancel();
    this.#src = this.#shown = this.brought = null;
    this.handle = 0;
  }
}
