/** The product page: one large viewer, the gallery below it, and links that carry what was changed. */
import './lucent-viewer.js';

const kLinkDelay = 300; // ms of rest before the address follows
const kNoteTime = 2500; // ms
const kMakingTime = 5000; // ms between looks at a gallery that is still being made

const find = (id) => document.getElementById(id);
const viewer = find('viewer');
let gallery = [];
let current = ''; // id of the gallery's scene that is shown; null: a person's own
let pending = {}; // parameters that a link sets once its scene is there

function note(text) {
  find('note').textContent = text;
  clearTimeout(note.timer);
  note.timer = setTimeout(() => (find('note').textContent = ''), kNoteTime);
}

// ---- links: #scene=coin&light.intensity=2

function readLink() {
  const { scene, ...changes } = Object.fromEntries(new URLSearchParams(location.hash.slice(1)));
  return { scene, changes };
}

function writeLink() {
  if (current === null) return; // a link names scenes of the gallery, and holds no files
  // A person has just gone to another scene: that link is to be followed, not written over.
  const { scene = current } = readLink();
  if (scene !== current) return;
  const link = new URLSearchParams({ scene: current, ...viewer.changes });
  history.replaceState(null, '', '#' + link);
}

function writeLinkSoon() {
  clearTimeout(writeLink.timer);
  writeLink.timer = setTimeout(writeLink, kLinkDelay);
}

function followLink() {
  const { scene, changes } = readLink();
  const named = gallery.find(({ id }) => id === scene);
  const wanted = [named, ...gallery].find((entry) => entry && !isMaking(entry, 'scene'));
  if (!wanted) return;
  if (scene && wanted.id !== scene) {
    note(named ? `${named.title} is still being made` : `There is no scene "${scene}" here`);
    history.replaceState(null, '', '#' + new URLSearchParams({ scene: wanted.id, ...changes }));
  }
  if (wanted.id === current && viewer.loaded) {
    viewer.reset();
    applyChanges(changes);
  } else showScene(wanted, changes);
}

function applyChanges(changes) {
  for (const [path, text] of Object.entries(changes)) viewer.set(path, text);
}

// ---- scenes

/** Whether the "scene", its "picture" or its "truth" is still being made. */
const isMaking = ({ making = [] }, what) => making.includes(what);

function showScene({ id, title, scene, poster, truth }, changes = {}) {
  current = id;
  pending = changes;
  if (poster && !viewer.loaded) viewer.poster = 'gallery/' + poster;
  viewer.alt = title;
  viewer.truth = truth && 'gallery/' + truth.file;
  viewer.truthNoise = truth?.noise;
  viewer.src = 'gallery/' + scene;
  for (const link of find('gallery').children) link.toggleAttribute('aria-current', link.dataset.id === id);
}

function galleryCard(entry) {
  const { id, title, caption, thumbnail } = entry;
  const card = document.createElement('a');
  card.href = '#scene=' + encodeURIComponent(id);
  card.dataset.id = id;
  const waits = isMaking(entry, 'scene');
  const image = thumbnail
    ? Object.assign(new Image(), { src: 'gallery/' + thumbnail, alt: '', loading: 'lazy' })
    : Object.assign(document.createElement('span'), { textContent: `${waits ? 'Scene' : 'Picture'} being made` });
  if (waits) card.setAttribute('aria-disabled', 'true');
  card.toggleAttribute('aria-current', id === current);
  const name = Object.assign(document.createElement('b'), { textContent: title });
  const text = Object.assign(document.createElement('small'), { textContent: caption });
  card.append(image, name, text);
  card.addEventListener('click', () => {
    if (id === current) showScene(entry); // as it was before the person opened files of their own
    viewer.scrollIntoView({ block: 'nearest' });
  });
  return card;
}

// What is made while the page stands comes into it: pictures of cards, scenes, exact solutions.
async function takeWhatIsMade() {
  const before = new Map(gallery.map((entry) => [entry.id, JSON.stringify(entry)]));
  gallery = await fetchGallery();
  for (const entry of gallery) {
    if (before.get(entry.id) === JSON.stringify(entry)) continue;
    const card = [...find('gallery').children].find(({ dataset }) => dataset.id === entry.id);
    const isFocused = card === document.activeElement;
    const newer = galleryCard(entry);
    card?.replaceWith(newer);
    if (isFocused) newer.focus();
    if (entry.id === current && entry.truth && !viewer.truth) {
      viewer.truthNoise = entry.truth.noise;
      viewer.truth = 'gallery/' + entry.truth.file;
    }
  }
  if (current === '') followLink();
  showMaking();
}

/** Says what is being made, and asks again as long as something is. */
function showMaking() {
  const count = (what) => gallery.filter((entry) => isMaking(entry, what)).length;
  const names = { scene: 'scene', picture: 'picture', truth: 'exact solution' };
  const parts = Object.keys(names)
    .filter(count)
    .map((what) => `${count(what)} ${names[what]}${count(what) > 1 ? 's' : ''}`);
  const entry = gallery.find(({ id }) => id === current);
  const asked = entry && isMaking(entry, 'truth') && viewer.loaded && viewer.get('compare') !== 'off';
  find('making').textContent =
    (asked ? 'The exact solution of this scene is being made. ' : '') +
    (parts.length ? `Being made: ${parts.join(', ')}; each comes into the page when it is ready.` : '');
  clearTimeout(showMaking.timer);
  if (parts.length) showMaking.timer = setTimeout(() => takeWhatIsMade().catch(showMaking), kMakingTime);
}

/** All cards, under the headings of what light does in their scenes. */
function galleryCards() {
  const kinds = [...new Set(gallery.map(({ kind }) => kind))];
  return kinds.flatMap((kind) => {
    const heading = Object.assign(document.createElement('h3'), { textContent: kind });
    const cards = gallery.filter((entry) => entry.kind === kind).map(galleryCard);
    return kinds.length > 1 ? [heading, ...cards] : cards;
  });
}

// ---- modes: what light does in a scene, as the gallery sorts them

/** Shows a mode of the scene at hand, or else of the first scene that has it. */
function showMode(kind) {
  const mode = kind.toLowerCase();
  if (viewer.stats().modes?.includes(mode)) return viewer.set('mode', mode);
  const entry = gallery.find((one) => one.kind === kind);
  history.pushState(null, '', '#' + new URLSearchParams({ scene: entry.id, mode }));
  showScene(entry, { mode });
}

function modeButtons() {
  const kinds = [...new Set(gallery.map(({ kind }) => kind))];
  if (kinds.length < 2) return [];
  return kinds.map((kind) => {
    const button = Object.assign(document.createElement('button'), { textContent: kind });
    button.addEventListener('click', () => showMode(kind));
    return button;
  });
}

function showModes() {
  const mode = viewer.get('mode');
  for (const button of find('modes').children)
    button.setAttribute('aria-pressed', String(button.textContent.toLowerCase() === mode));
}

/** The page shows files of the person's own: nothing of it speaks of the gallery's scene any more. */
function leaveGallery() {
  if (current === null) return;
  current = null;
  for (const link of find('gallery').children) link.removeAttribute('aria-current');
  history.pushState(null, '', location.pathname + location.search); // the way back leads to the scene before
}

viewer.addEventListener('load', () => {
  const changes = pending;
  pending = {};
  applyChanges(changes);
  if (viewer.ownScene) leaveGallery();
  document.title = `${viewer.sceneTitle} – Lucent`;
  find('title').textContent = viewer.sceneTitle;
  find('caption').textContent = viewer.caption;
  writeLinkSoon();
});
viewer.addEventListener('error', ({ detail }) => note(detail.message));
viewer.addEventListener('change', writeLinkSoon);
viewer.addEventListener('change', showCompare);
viewer.addEventListener('load', showCompare);
viewer.addEventListener('change', showModes);
viewer.addEventListener('load', showModes);
viewer.addEventListener('frame', showCost);

// ---- toolbar

function showCompare() {
  find('compare').value = viewer.get('compare');
  showMaking();
}

function showCost() {
  const { milliseconds, passes, draws, lights, bytes } = find('time').checked && viewer.loaded ? viewer.stats() : {};
  find('cost').textContent =
    milliseconds === undefined
      ? ''
      : `${milliseconds.toFixed(1)} ms, ${passes} passes, ${draws} draws, ${lights} lights, ` +
        `${(bytes / 1e6).toFixed(1)} MB`;
}

function openWith(button, input, kind) {
  find(button).addEventListener('click', () => find(input).click());
  find(input).addEventListener('change', ({ target }) => {
    if (target.files.length) viewer.openFile(target.files, kind);
    target.value = '';
  });
}

async function savePicture() {
  const address = URL.createObjectURL(await viewer.toBlob());
  const name = current ?? viewer.sceneTitle;
  Object.assign(document.createElement('a'), { href: address, download: `${name || 'lucent'}.png` }).click();
  URL.revokeObjectURL(address);
}

async function copyLink() {
  if (current === null) return note('A link holds no files of your own; it can name scenes of the gallery only');
  writeLink();
  try {
    await navigator.clipboard.writeText(location.href);
    note('Link copied');
  } catch {
    note('This browser keeps pages from copying: the link is in the address bar');
  }
}

find('undo').addEventListener('click', () => viewer.undo());
find('redo').addEventListener('click', () => viewer.redo());
find('reset').addEventListener('click', () => viewer.reset());
find('save').addEventListener('click', () => savePicture().catch((error) => note(error.message)));
find('copy').addEventListener('click', copyLink);
find('compare').addEventListener('change', ({ target }) => viewer.set('compare', target.value));
find('time').addEventListener('change', showCost);
find('check').addEventListener('click', async () => {
  const check = await import('./selfcheck.js').catch(({ message }) => note(`Self-check: ${message}`));
  check?.openSelfCheck(viewer);
});
openWith('open-maps', 'maps-file', 'scene');
openWith('open-environment', 'environment-file', 'environment');
openWith('open-mesh', 'mesh-file', 'scene');

async function fetchGallery() {
  const response = await fetch('gallery/index.json');
  if (!response.ok) throw new Error(`gallery/index.json: the server answers ${response.status}; scripts/run makes it`);
  return response.json();
}

async function start() {
  gallery = await fetchGallery();
  find('gallery').replaceChildren(...galleryCards());
  find('modes').replaceChildren(...modeButtons());
  addEventListener('hashchange', followLink);
  followLink();
  showMaking();
}
start().catch(({ message }) => note(message));
