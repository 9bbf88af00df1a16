/** Solves photographs with a light file for the surface that they show, in a worker, and shows how well that went. */
import { progressText, runJob } from './job.js';

const kAddress = new URL('lucent-stereo.js', import.meta.url).href;

const kMarkup = `
<span></span><progress></progress><button type="button">Cancel</button>
<figure><canvas role="img"></canvas><figcaption></figcaption><button type="button">Close</button></figure>`;

export class PhotoBar {
  #work = null; // AbortController of what is running
  #text;
  #progress;
  #cancel;
  #figure;
  element = document.createElement('div');

  constructor() {
    this.element.className = 'bar photos';
    this.element.innerHTML = kMarkup;
    [this.#text, this.#progress, this.#cancel, this.#figure] = this.element.children;
    this.#cancel.addEventListener('click', () => this.cancel());
    this.#figure.querySelector('button').addEventListener('click', () => this.clear());
    this.clear();
  }

  cancel() {
    this.#work?.abort();
  }

  /** Nothing is shown any more. */
  clear() {
    this.element.hidden = this.#figure.hidden = true;
  }

  /**
   * @param light  File of the lights. @param files  File[] with the photographs
   * @return {Promise<object | null>}  as work() in stereo_job.js; null where the person cancelled
   */
  async solve(light, files) {
    this.cancel();
    const mine = (this.#work = new AbortController());
    const start = performance.now();
    const report = (share) => {
      this.#text.textContent = `Solving photographs: ${progressText(share, start)}`;
      this.#progress.value = share;
    };
    report(0);
    this.#show(true);
    try {
      return await runJob(kAddress, { light, files }, report, mine.signal);
    } catch (error) {
      if (mine.signal.aborted) return null;
      throw error;
    } finally {
      if (this.#work === mine) this.clear();
    }
  }

  /** Shows what the model leaves over of the photographs. @param result  of solve() */
  async showResidual({ files, residual, text }) {
    const [canvas, caption] = this.#figure.children;
    const bitmap = await createImageBitmap(new Blob([files.get(residual)]));
    Object.assign(canvas, { width: bitmap.width, height: bitmap.height, ariaLabel: `Residual: ${text}` });
    canvas.getContext('2d').drawImage(bitmap, 0, 0);
    caption.textContent = `${text}. White in the picture: 10 % and more.`;
    this.#show(false);
  }

  #show(isWorking) {
    this.element.hidden = false;
    this.#text.hidden = this.#progress.hidden = this.#cancel.hidden = !isWorking;
    this.#figure.hidden = isWorking;
  }
}
