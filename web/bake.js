/**
 * What a technique works out once for an object of a viewer: a worker does it, and the object is drawn without until it
 * is there. The bar says how far that is and ends it.
 */
import { progressText, runJob } from './job.js';

const kAddress = new URL('lucent-bake.js', import.meta.url).href;
const kStill = 400; // ms for which a slider rests before the work begins

export class BakeBar {
  #actions;
  #wanted; // {technique, object, work} as stats() has it
  #work = null; // AbortController of what waits or is running
  #idle = []; // resolve functions that wait for the end of it
  #text = document.createElement('span');
  #progress = document.createElement('progress');
  #button = document.createElement('button');
  element = document.createElement('div');

  /** @param actions  ask(): the files of what is wanted; take(work, bytes); fail(error); say(text) */
  constructor(actions) {
    this.#actions = actions;
    this.#progress.ariaLabel = 'Precomputing';
    this.#button.type = 'button';
    this.#button.addEventListener('click', () => (this.#work ? this.#end(true) : this.#run(0)));
    this.element.className = 'bar bake';
    this.element.hidden = true;
    this.element.append(this.#text, this.#progress, this.#button);
  }

  /** @param wanted  of stats(); undefined: nothing is */
  update(wanted) {
    if (wanted?.work === this.#wanted?.work) return;
    this.#end(false);
    this.#wanted = wanted;
    this.element.hidden = !wanted;
    if (wanted) this.#run(kStill);
  }

  /** Resolves when nothing is worked out, be it that somebody ended it. */
  whenIdle() {
    return this.#work ? new Promise((done) => this.#idle.push(done)) : undefined;
  }

  async #run(wait) {
    const { technique, object, work } = this.#wanted;
    const mine = (this.#work = new AbortController());
    this.#button.textContent = 'Cancel';
    this.#show(`Precomputing ${object}`);
    await new Promise((done) => setTimeout(done, wait));
    if (this.#work !== mine) return;
    const start = performance.now();
    const report = (share, isOnPage) => {
      const place = isOnPage ? 'This page may start no worker; precomputing' : 'Precomputing';
      if (this.#work === mine) this.#show(`${place} ${object}${isOnPage ? ' here' : ''}: ${progressText(share, start)}`, share);
    };
    try {
      const { bytes } = await runJob(kAddress, { files: this.#actions.ask(), technique }, report, mine.signal);
      if (this.#work !== mine) return;
      this.#actions.take(work, bytes);
      this.#rest();
    } catch (error) {
      if (this.#work !== mine) return;
      this.#actions.fail(error);
      this.#end(true);
    }
  }

  // @param offers  whether to say what is missing now, with a button that begins again
  #end(offers) {
    this.#work?.abort();
    this.#rest();
    if (!offers) return;
    const text = `${this.#wanted.object} is drawn without precomputed light`;
    this.#show(text);
    this.#actions.say(text);
    this.#button.textContent = 'Precompute';
  }

  #show(text, share) {
    this.#text.textContent = text;
    this.#progress.hidden = share === undefined;
    this.#progress.value = share ?? 0;
  }
  #rest() {
    this.#work = null;
    this.#idle.splice(0).forEach((done) => done());
  }
}
