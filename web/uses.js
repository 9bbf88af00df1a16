/** Asks what each picture of a set is for, where their names do not say. */
import { isSet } from './bring.js';

const kSide = 96; // CSS pixels of a thumbnail
const kGrey = 8; // of 255: what JPEG may part the channels of a grey picture by
const kUses = {
  height: 'Heights: bright is high',
  normal: 'Normals',
  albedo: 'Colour (albedo)',
  alpha: 'Alpha',
  specular: 'Specular colour',
  none: 'Nothing: leave out',
};
const kMarkup = `
<h2 id="uses-title"></h2>
<ul></ul>
<p role="alert"></p>
<div class="choices"><button type="submit">Open</button><button type="button">Cancel</button></div>`;

/** A small picture of a file; empty where the browser does not read such files. */
async function thumbnailOf({ bytes }) {
  const canvas = Object.assign(document.createElement('canvas'), { width: kSide, height: kSide });
  try {
    const bitmap = await createImageBitmap(new Blob([bytes]));
    const scale = kSide / Math.max(bitmap.width, bitmap.height);
    Object.assign(canvas, { width: Math.ceil(scale * bitmap.width), height: Math.ceil(scale * bitmap.height) });
    canvas.getContext('2d').drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  } catch {
    canvas.className = 'unknown'; // PFM and HDR
  }
  return canvas;
}

/** What a picture that nobody knows may be for: alone the heights, else by its pixels: grey ones heights, others colours. */
function guess(canvas, taken) {
  if (taken.length === 1) return 'height';
  if (canvas.className === 'unknown') return 'none';
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let spread = 0;
  for (let at = 0; at < data.length; at += 4) {
    const [red, green, blue] = data.subarray(at, at + 3);
    spread = Math.max(spread, Math.max(red, green, blue) - Math.min(red, green, blue));
  }
  const use = spread <= kGrey ? 'height' : 'albedo';
  return taken.includes(use) ? 'none' : use;
}

async function rowOf(picture, taken) {
  const row = document.createElement('li');
  const label = document.createElement('label');
  const select = document.createElement('select');
  select.append(...Object.entries(kUses).map(([value, text]) => new Option(text, value)));
  const thumbnail = await thumbnailOf(picture);
  select.value = picture.use || guess(thumbnail, taken);
  taken.push(select.value);
  label.append(Object.assign(document.createElement('span'), { textContent: picture.name }), select);
  row.append(thumbnail, label);
  return row;
}

async function rowsOf(pictures) {
  const taken = pictures.map(({ use }) => use);
  const rows = [];
  for (const picture of pictures) rows.push(await rowOf(picture, taken));
  return rows;
}

/**
 * @param root      the dialog is appended to
 * @param pictures  {name, use, bytes}[], use '' where nothing is known
 * @return {Promise<string[] | null>}  the uses in order, 'none': left out; null where the person goes back
 */
export async function askUses(root, pictures) {
  const dialog = document.createElement('dialog');
  const form = document.createElement('form');
  dialog.className = 'uses';
  dialog.setAttribute('aria-labelledby', 'uses-title');
  form.method = 'dialog';
  form.innerHTML = kMarkup;
  const which = pictures.length > 1 ? 'each' : 'this';
  form.querySelector('h2').textContent = `What is ${which} picture for?`;
  form.querySelector('ul').append(...(await rowsOf(pictures)));
  dialog.append(form);
  root.append(dialog);
  const uses = () => [...form.querySelectorAll('select')].map(({ value }) => value);
  form.addEventListener('submit', (event) => {
    if (isSet(uses())) return;
    event.preventDefault();
    form.querySelector('[role=alert]').textContent =
      'One picture must be the heights or the normals, and no two may be for the same.';
  });
  form.querySelector('button[type=button]').addEventListener('click', () => dialog.close('cancel'));
  dialog.returnValue = 'cancel';
  form.querySelector('button[type=submit]').value = 'open';
  dialog.showModal();
  return new Promise((done) =>
    dialog.addEventListener('close', () => {
      dialog.remove();
      done(dialog.returnValue === 'open' ? uses() : null);
    }),
  );
}
