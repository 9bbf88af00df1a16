/**
 * What a person makes and no link can carry: files that were opened, paint. It is kept in the browser as it goes, and
 * the page asks before something else takes its place.
 */
import { Works } from './works.js';

const kRest = 250; // ms between two writes at least; the first comes at once
const kShare = 20; // a write may take a 20th of the time: large scenes are written less often
const kView = /^(mode|matt|paint\.)/; // parameters that are in no scene file

/** A scene without the moment that is shown: time that runs is no work. */
const stable = (json) => JSON.stringify(JSON.parse(json), (key, value) => (key === 'time' ? undefined : value));

export class Keeper {
  #viewer;
  #failed;
  #works = new Works();
  #id; // of the work that is shown, once it is kept
  #base = {}; // scene or src and changes: what a link to this work begins with
  #inherited = []; // of beyondLink: what the work held when it came back
  #saved = ''; // the scene as the person saved, or found it
  #kept = ''; // as it was written last
  #isActive = false; // what is shown is not about to go
  #isHere = true; // the address is that of what is shown
  #timer;
  #last = { end: 0, took: 0 }; // ms: of the last write
  #writing = Promise.resolve();
  #isTold = false;
  failure = ''; // why nothing is kept

  /** @param failed  (message) => tells that nothing can be kept */
  constructor(viewer, failed) {
    this.#viewer = viewer;
    this.#failed = failed;
    viewer.addEventListener('edit', () => this.#soon());
    addEventListener('pagehide', () => this.keep());
    addEventListener('visibilitychange', () => document.hidden && this.keep());
    addEventListener('beforeunload', (event) => {
      if (!this.unsaved) return;
      this.keep();
      if (this.failure) event.preventDefault();
    });
  }

  /** @param base  what a link to the scene that was loaded begins with: {scene} or {src}; nothing for own files */
  begin(base = {}) {
    this.#isActive = this.#isHere = true;
    this.#id = undefined;
    this.#base = base;
    this.#inherited = [];
    this.#kept = '';
    this.#saved = stable(this.#viewer.sceneJson);
    this.#soon();
  }

  /** What of the scene no link can carry: 'scene', 'files', 'paint'. */
  get beyondLink() {
    if (!this.#viewer.loaded) return [];
    // What came back was opened as a scene of its own, whatever it was before.
    const isOwn = !this.#inherited.length || this.#inherited.includes('scene');
    const found = this.#viewer.beyondLink.filter((one) => isOwn || one !== 'scene');
    return [...new Set([...found, ...this.#inherited])];
  }
  /** What a link can carry: {scene} or {src}, and values of parameters. */
  get link() {
    return { ...this.#base, ...this.#viewer.changes };
  }
  get id() {
    return this.#id;
  }
  /** Whether work would be gone with the scene: what no link carries has changed since it was saved or opened. */
  get unsaved() {
    return this.#isActive && this.beyondLink.length > 0 && stable(this.#viewer.sceneJson) !== this.#saved;
  }
  saved() {
    this.#saved = stable(this.#viewer.sceneJson);
    this.#kept = '';
    this.keep();
  }

  // At once, or when the last write lies far enough behind.
  #soon() {
    clearTimeout(this.#timer);
    const rest = Math.max(kRest, kShare * this.#last.took);
    const wait = this.#last.end + rest - performance.now();
    if (wait <= 0) this.keep();
    else this.#timer = setTimeout(() => this.keep(), wait);
  }

  /** Writes what has changed since the last time. */
  keep() {
    const start = performance.now();
    clearTimeout(this.#timer);
    const work = this.#work();
    if (work) this.#writing = this.#write(work);
    const end = performance.now();
    this.#last = { end, took: end - start };
    return this.#writing;
  }

  // What there is to write.
  #work() {
    const viewer = this.#viewer;
    if (!this.#isActive || !viewer.loaded) return undefined;
    const beyond = this.beyondLink;
    if (!beyond.length) return this.#forget();
    if (this.failure) return this.#tell();
    const now = stable(viewer.sceneJson);
    if (now === this.#kept) return undefined;
    this.#kept = now;
    if (!this.#id) this.#works.take((this.#id = crypto.randomUUID()));
    if (this.#isHere && history.state?.work !== this.#id) history.replaceState({ work: this.#id }, '');
    const view = Object.entries(viewer.changes).filter(([path]) => kView.test(path));
    const isSaved = now === this.#saved;
    return { id: this.#id, title: viewer.sceneTitle, base: this.link, beyond, view, isSaved, aside: false };
  }

  // Once: there is work now, and nothing is kept.
  #tell() {
    if (!this.#isTold) this.#failed(this.failure);
    this.#isTold = true;
  }

  // What was painted has been taken back.
  #forget() {
    const id = this.#id;
    if (!id) return;
    this.#id = undefined;
    this.#kept = '';
    if (this.#isHere) history.replaceState(null, '');
    this.#writing = this.#works.remove(id).catch(({ message }) => (this.failure = message));
  }

  async #write(work) {
    try {
      await this.#works.put(work, this.#viewer.sceneFiles);
    } catch ({ message }) {
      this.failure = message;
      this.#tell();
    }
  }

  /** The address leads elsewhere; whether the work makes way is not known yet. */
  leave() {
    this.#isHere = false;
  }
  /** It does not. */
  stay() {
    this.#isHere = true;
  }

  /** Stops keeping the work as the one to come back to; it can still be opened. */
  async putAside() {
    this.#isActive = false;
    await this.#writing;
    if (this.#id && !this.failure) await this.#works.note(this.#id, { aside: true });
  }
  /** What should have taken the place of the work did not come. */
  resume() {
    if (this.#isActive) return;
    this.#isActive = this.#isHere = true;
    this.#kept = '';
    this.#soon();
  }

  /** The newest work, {id, title}; undefined where there is none. */
  async newest() {
    try {
      return await this.#works.newest();
    } catch ({ message }) {
      this.failure = message;
      return undefined;
    }
  }

  /**
   * Shows a work again, or a copy (isCopy) of one that another tab shows.
   * @return {Promise<object>}  the work; undefined where it is not there any more
   */
  async restore(id) {
    this.#isActive = false;
    const work = this.failure ? undefined : await this.#works.get(id).catch(() => undefined);
    if (!work || !(await this.#viewer.openFile([...work.files.values()]))) return undefined;
    for (const [path, text] of work.view) this.#viewer.set(path, text);
    const isCopy = !(await this.#works.take(id));
    const shown = stable(this.#viewer.sceneJson);
    this.#kept = isCopy ? '' : shown;
    this.#saved = work.isSaved ? shown : '';
    this.#id = isCopy ? undefined : id;
    this.#base = work.base;
    this.#inherited = work.beyond;
    this.#isActive = this.#isHere = true;
    if (isCopy) this.keep();
    else history.replaceState({ work: id }, '');
    return { ...work, isCopy };
  }
}
