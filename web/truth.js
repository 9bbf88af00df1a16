/**
 * The truth beside a viewer's picture: from a file where there is one, else computed when a person asks for it. The
 * bar says how far that is and ends it.
 */
import { fetchPicture } from './files.js';
import { progressText, runJob } from './job.js';

// Longer side of a computed truth in pixels, so that it is there within half a minute or so: a lamp is one question
// a pixel, soft lamps and light from all around on matt things are hundreds.
const kSide = { hard: 256, soft: 128 };
const kSamples = 128;

const kAddress = new URL('lucent-truth.js', import.meta.url).href;

const isSoft = (light) => light.radius > 0 || light.angle > 0 || light.type === 'area';

// What is refractive or a mirror shows one ray a pixel, whatever lights it.
const isMatt = ({ shape, material = {} }) =>
  shape.type === 'heightfield' || ![material.transmission, material.reflectance].flat().some((share) => share > 0);

/**
 * What to compute for the files of a scene.
 * @param longer  side of the picture in pixels; undefined: as it is there soon
 */
function requestFor(files, longer) {
  const scene = JSON.parse(new TextDecoder().decode(files.get('scene.json')));
  const shines = scene.environment && scene.environment.enabled !== false;
  const isSampled = (shines || scene.lights.some(isSoft)) && scene.objects.some(isMatt);
  const side = longer ?? (isSampled ? kSide.soft : kSide.hard);
  const [width, height] = scene.size.map((length) => Math.max(1, Math.round((length * side) / Math.max(...scene.size))));
  return { files, width, height, samples: kSamples };
}

/** The longer side of the next finer truth, twice the one there is; undefined where that shows the picture's pixels. */
function finerSide({ truth, size, place, pixelsPerCssPixel }) {
  const [has, seen] = [Math.max(...size), place ? Math.max(place[2], place[3]) * pixelsPerCssPixel : 0];
  return truth === 'fresh' && has < 0.9 * seen ? Math.round(Math.min(2 * has, seen)) : undefined;
}

export class TruthBar {
  #actions;
  #finer; // side
  #work = null; // AbortController of what is running
  #text = document.createElement('span');
  #progress = document.createElement('progress');
  #compute = document.createElement('button');
  #cancel = document.createElement('button');
  element = document.createElement('div');

  /**
   * @param actions  ask(): the scene's files; take({pixels, width, height, noise}); open({name, bytes}, noise);
   *                 fail(error); changed(): the bar wants an update
   */
  constructor(actions) {
    this.#actions = actions;
    this.#cancel.textContent = 'Cancel';
    this.#compute.addEventListener('click', () => this.compute(this.#finer));
    this.#cancel.addEventListener('click', () => this.cancel());
    this.element.className = 'bar truth';
    this.element.append(this.#text, this.#progress, this.#compute, this.#cancel);
    this.update({ mode: 'off', truth: 'none' });
  }

  get busy() {
    return this.#work !== null;
  }

  /** Shows what there is to do. @param comparison  of the viewer */
  update(comparison) {
    const { mode, truth } = comparison;
    this.#finer = mode === 'off' ? undefined : finerSide(comparison);
    const wanted = mode !== 'off' && (truth !== 'fresh' || this.#finer);
    this.element.hidden = !wanted && !this.busy;
    this.#compute.hidden = this.busy;
    this.#compute.textContent = this.#finer
      ? `Compute a finer truth, ${this.#finer} pixels`
      : truth === 'stale' ? 'Compute the truth again' : 'Compute the truth';
    this.#text.hidden = this.#progress.hidden = this.#cancel.hidden = !this.busy;
  }

  cancel() {
    this.#work?.abort();
    this.#work = null;
  }

  /** Takes the truth from a file. @param noise  number or null */
  fetch(url, noise) {
    return this.#run(async (signal) => {
      this.#report('Fetching the truth…');
      const picture = await fetchPicture(url);
      if (!signal.aborted) this.#actions.open(picture, noise);
    });
  }

  /** Computes the truth of the scene that is showing. @param longer  its longer side, pixels */
  compute(longer) {
    return this.#run(async (signal) => {
      const request = requestFor(this.#actions.ask(), longer);
      const { width, height } = request;
      const start = performance.now();
      const report = (share, isOnPage) => {
        const place = isOnPage ? 'This page may start no worker; computing the truth here' : 'Computing the truth';
        this.#report(`${place}, ${width} × ${height} pixels: ${progressText(share, start)}`, share);
      };
      report(0);
      const truth = await runJob(kAddress, request, report, signal);
      if (!signal.aborted) this.#actions.take({ ...truth, width, height });
    });
  }

  async #run(work) {
    this.cancel();
    const mine = (this.#work = new AbortController());
    try {
      await work(mine.signal);
    } catch (error) {
      if (!mine.signal.aborted) this.#actions.fail(error);
    }
    if (this.#work === mine) this.#work = null;
    this.#actions.changed();
  }

  #report(text, share) {
    this.#text.textContent = text;
    if (share === undefined) this.#progress.removeAttribute('value');
    else this.#progress.value = share;
    this.#actions.changed();
  }
}
