/** The dialog that saves the picture, at any size, or a sequence of pictures. Fetched when it is asked for. */
import { download, make, makeDialog } from './dialog.js';

const kFormats = {
  picture: { png: 'PNG, as displayed', exr: 'EXR, linear values' },
  sequence: { zip: 'PNG, numbered, in a zip', webm: 'WebM video' },
};
const kWhat = [
  ['picture', 'Picture'],
  ['camera', 'Turntable'],
  ['lamp', 'Lamp sweep'],
];
const kTypes = { png: 'image/png', exr: 'image/x-exr', zip: 'application/zip', webm: 'video/webm' };

const option = ([value, textContent]) => make('option', { value, textContent });

/** A label and what it names, for a grid of two columns. */
function field(id, text, control) {
  return [make('label', { htmlFor: id, textContent: text }), Object.assign(control, { id })];
}

const inWords = (seconds) => (seconds < 90 ? `${Math.ceil(seconds)} s` : `${Math.ceil(seconds / 60)} min`);

class PictureDialog {
  #viewer;
  #name;
  #running = null; // AbortController
  #what = make('select', {}, ...kWhat.map(option));
  #width = make('input', { type: 'number', min: 1, required: true });
  #height = make('input', { type: 'number', min: 1, required: true, ariaLabel: 'Height in pixels' });
  #shape = make('input', { type: 'checkbox', checked: true });
  #limit = make('small');
  #format = make('select');
  #frames = make('input', { type: 'number', min: 1, max: 9999, value: 90, required: true });
  #rate = make('input', { type: 'number', min: 1, max: 60, value: 30, required: true });
  #length = make('small');
  #ofSequence;
  #progress = make('progress', { max: 1, hidden: true, ariaLabel: 'Progress' });
  #status = make('p');
  #save = make('button', { textContent: 'Save' });
  #cancel = make('button', { type: 'button', textContent: 'Cancel' });
  #dialog;
  #ratio = 1;

  constructor(viewer) {
    this.#viewer = viewer;
    this.#status.setAttribute('role', 'status');
    const size = make('div', { className: 'size' }, this.#width, '×', this.#height, 'pixels');
    this.#ofSequence = [
      ...field('picture-frames', 'Frames', this.#frames),
      ...field('picture-rate', 'Frames a second', this.#rate),
      this.#length,
    ];
    const fields = make(
      'div',
      { className: 'fields' },
      ...field('picture-what', 'Save', this.#what),
      make('label', { htmlFor: 'picture-width', textContent: 'Width × height' }),
      size,
      this.#limit,
      make('label', { htmlFor: 'picture-shape', textContent: 'Keep the shape' }),
      make('div', {}, Object.assign(this.#shape, { id: 'picture-shape' })),
      ...field('picture-format', 'Format', this.#format),
      ...this.#ofSequence,
    );
    this.#width.id = 'picture-width';
    const actions = make('div', { className: 'actions' }, this.#save, this.#cancel);
    const form = make('form', {}, fields, this.#progress, this.#status, actions);
    this.#dialog = makeDialog('Save picture', form);
    this.#dialog.classList.add('picture');
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.#run();
    });
    this.#what.addEventListener('change', () => this.#show());
    for (const input of [this.#format, this.#frames, this.#rate])
      input.addEventListener('input', () => this.#showLength());
    this.#width.addEventListener('input', () => this.#follow(this.#height, this.#width.value / this.#ratio));
    this.#height.addEventListener('input', () => this.#follow(this.#width, this.#height.value * this.#ratio));
    this.#cancel.addEventListener('click', () => (this.#running ? this.#running.abort() : this.#dialog.close()));
    this.#dialog.addEventListener('cancel', (event) => {
      if (!this.#running) return;
      event.preventDefault();
      this.#running.abort();
    });
  }

  /** @param name  of the files, without ending */
  open(name) {
    this.#name = name;
    const { width, height } = this.#viewer.pictureSize;
    const most = this.#viewer.largestSide;
    Object.assign(this.#width, { value: width, max: most });
    Object.assign(this.#height, { value: height, max: most });
    this.#ratio = width / height;
    this.#limit.textContent = `Up to ${most} a side on this device; by all samples of the pixels, without light dots`;
    this.#status.textContent = '';
    this.#cancel.textContent = 'Cancel';
    this.#show();
    this.#dialog.showModal();
  }

  #follow(other, value) {
    if (this.#shape.checked) other.value = Math.max(1, Math.round(value));
    else this.#ratio = this.#width.value / this.#height.value;
  }

  get #isSequence() {
    return this.#what.value !== 'picture';
  }

  #show() {
    const formats = { ...kFormats[this.#isSequence ? 'sequence' : 'picture'] };
    if (!this.#viewer.constructor.canRecord) delete formats.webm;
    this.#format.replaceChildren(...Object.entries(formats).map(option));
    for (const element of this.#ofSequence) element.hidden = !this.#isSequence;
    for (const input of [this.#frames, this.#rate]) input.disabled = !this.#isSequence;
    this.#showLength();
  }

  #showLength() {
    const seconds = Number((this.#frames.value / this.#rate.value).toFixed(1));
    const isVideo = this.#format.value === 'webm';
    this.#length.textContent = isVideo ? `${seconds} s, which recording takes as well` : `${seconds} s`;
  }

  async #run() {
    if (this.#running) return;
    const { signal } = (this.#running = new AbortController());
    this.#busy(true);
    try {
      const blob = await this.#make(signal);
      download(blob, `${this.#name}.${this.#format.value}`);
      this.#status.textContent = 'Saved';
    } catch ({ message }) {
      this.#status.textContent = signal.aborted ? 'Cancelled' : message;
    }
    this.#running = null;
    this.#busy(false);
  }

  #make(signal) {
    const [width, height] = [Number(this.#width.value), Number(this.#height.value)];
    const common = { width, height, type: kTypes[this.#format.value], signal };
    if (!this.#isSequence) return this.#viewer.toBlob(common);
    const start = performance.now();
    const progress = (share) => {
      this.#progress.value = share;
      const left = ((performance.now() - start) / 1000) * (1 / share - 1);
      this.#status.textContent =
        share < 1 ? `Frame ${Math.round(share * frames)} of ${frames}, ${inWords(left)} left` : 'Packing…';
    };
    const frames = Number(this.#frames.value);
    const sequence = { path: this.#what.value, frames, fps: Number(this.#rate.value), name: this.#name, progress };
    return this.#viewer.toSequence({ ...common, ...sequence });
  }

  #busy(isBusy) {
    this.#save.disabled = isBusy;
    this.#progress.hidden = !isBusy;
    this.#progress.removeAttribute('value');
    this.#cancel.textContent = isBusy ? 'Cancel' : 'Close';
    if (!isBusy) return this.#save.focus();
    this.#status.textContent = 'Drawing…';
    this.#cancel.focus();
  }
}

let dialog;

/**
 * @param viewer  a <lucent-viewer>
 * @param name    of the files that are saved, without ending
 */
export function openPictureDialog(viewer, name) {
  dialog ??= new PictureDialog(viewer);
  dialog.open(name);
}
