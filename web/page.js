/** The product page: one large viewer, the gallery below it, and links that carry what was changed. */
import './lucent-viewer.js';
import { ask, download, make } from './dialog.js';
import { Keeper } from './keep.js';

const kLinkDelay = 300; // ms of rest before the address follows
const kNoteTime = 2500; // ms
const kMakingTime = 5000; // ms between looks at a gallery that is still being made

const kBare = location.pathname + location.search; // the address of the person's own work

const find = (id) => document.getElementById(id);
const viewer = find('viewer');
const keeper = new Keeper(viewer, tellNotKept);
let gallery = [];
let current = {}; // scene: id of the gallery's that is shown, or src: its address; neither for the person's own
let shown = current; // what current was when the scene that is shown came
let isRestoring = false;
let pending = {}; // parameters that a link sets once its scene is there

function note(text) {
  find('note').textContent = text;
  clearTimeout(note.timer);
  note.timer = setTimeout(() => (find('note').textContent = ''), kNoteTime);
}

/** Says something that stays, above the picture. @param actions  [label, what to do] of buttons */
function tell(text, ...actions) {
  const buttons = actions.map(([textContent, act]) => {
    const button = make('button', { textContent });
    button.addEventListener('click', () => (tell(''), act()));
    return button;
  });
  find('kept').replaceChildren(...(text ? [make('span', { textContent: text }), ...buttons] : []));
}

// ---- links: #scene=coin&light.intensity=2, or #src=ADDRESS for a scene elsewhere on this site

function readLink() {
  const { scene, src, ...changes } = Object.fromEntries(new URLSearchParams(location.hash.slice(1)));
  return { scene, src, changes };
}

/** The address of what is shown; the person's own scenes have none. */
function linkOfPage() {
  const { scene, src, ...changes } = keeper.link;
  const first = src ? { src } : { scene };
  return '#' + new URLSearchParams({ ...first, ...changes });
}

function writeLink() {
  // A person has just gone to another scene: that link is to be followed, not written over, and nothing is known of its
  // scene before it is there.
  const { scene = current.scene, src } = readLink();
  const isOfScene = (link) => link.scene === current.scene && link.src === current.src;
  if (!shownByLink() || !isOfScene({ scene, src }) || !isOfScene(keeper.link)) return;
  history.replaceState(history.state, '', linkOfPage());
}
const shownByLink = () => Boolean(current.scene || current.src);

function writeLinkSoon() {
  clearTimeout(writeLink.timer);
  writeLink.timer = setTimeout(writeLink, kLinkDelay);
}

/** Goes where the address leads, unless the person wants to keep what is shown. */
async function follow() {
  const work = history.state?.work;
  if (work && work === keeper.id) return;
  keeper.leave();
  if (!(await mayReplace())) {
    history.pushState({ work: keeper.id }, '', shownByLink() ? linkOfPage() : kBare);
    return keeper.stay();
  }
  await keeper.putAside();
  if (!work || !(await restore(work))) followLink();
}

function followLink() {
  const { scene, src, changes } = readLink();
  if (src) return showAddress(src, changes);
  const named = gallery.find(({ id }) => id === scene);
  const wanted = [named, ...gallery].find((entry) => entry && !isMaking(entry, 'scene'));
  if (!wanted) return;
  if (scene && wanted.id !== scene) {
    note(named ? `${named.title} is still being made` : `There is no scene "${scene}" here`);
    history.replaceState(null, '', '#' + new URLSearchParams({ scene: wanted.id, ...changes }));
  }
  if (wanted.id === current.scene && viewer.loaded && !keeper.beyondLink.length) {
    viewer.reset();
    applyChanges(changes);
  } else showScene(wanted, changes);
}

// The picture shows one message: where several values of a link are wrong, all are told above it.
function applyChanges(changes) {
  const wrong = [];
  const collect = ({ detail }) => wrong.push(detail.message);
  viewer.addEventListener('error', collect);
  for (const [path, text] of Object.entries(changes)) viewer.set(path, text);
  viewer.removeEventListener('error', collect);
  if (wrong.length > 1) tell(`Not taken from the link: ${wrong.join('; ')}`, ['Close', () => {}]);
}

// ---- scenes

/** Whether the "scene", its "picture" or its "truth" is still being made. */
const isMaking = ({ making = [] }, what) => making.includes(what);

function showScene({ id, title, scene, poster, truth, kind }, changes = {}) {
  current = { scene: id };
  pending = kind === 'Paint' ? { mode: 'paint', ...changes } : changes;
  tell('');
  if (poster && !viewer.loaded) viewer.poster = 'gallery/' + poster;
  viewer.alt = title;
  viewer.truth = truth && 'gallery/' + truth.file;
  viewer.truthNoise = truth?.noise;
  viewer.src = 'gallery/' + scene;
  markCard();
}

/** A scene at another address of this site. */
function showAddress(src, changes = {}) {
  current = { src };
  pending = changes;
  tell('');
  viewer.truth = undefined;
  viewer.src = src;
  markCard();
}

function markCard() {
  for (const link of find('gallery').children) link.toggleAttribute('aria-current', link.dataset.id === current.scene);
}

// ---- work of the person's own

function tellNotKept(reason) {
  const text = `This browser does not keep your work (${reason}): save the scene before you leave the page.`;
  tell(text, ['Save scene', saveScene]);
}

/** Whether something else may take the place of what is shown: asks where work would be lost. */
async function mayReplace() {
  if (!keeper.unsaved) return true;
  const answer = await ask(
    'Save your scene first?',
    `“${viewer.sceneTitle}” has work of yours that no file holds yet.`,
    ['save', 'Save scene'],
    ['replace', 'Replace it'],
    ['cancel', 'Cancel'],
  );
  return answer === 'save' ? saveScene() : answer === 'replace';
}

/** Shows a work that the page has kept, and says so. @return {Promise<boolean>}  false where it is gone */
async function restore(id) {
  isRestoring = true;
  const work = await keeper.restore(id).finally(() => (isRestoring = false));
  if (!work) return false;
  const { scene, src } = work.base;
  shown = current = scene ? { scene } : src ? { src } : {};
  markCard();
  const text = work.isCopy
    ? 'Another tab shows this work; here you have a copy of it.'
    : 'Your work is back as you left it.';
  tell(text, ['Start from the gallery instead', startFromGallery]);
  return true;
}

/** The way back from a work: it stays where it is kept. */
async function startFromGallery() {
  const { id } = keeper;
  await keeper.putAside();
  showGallery();
  offer(id);
}

function showGallery() {
  history.pushState(null, '', kBare);
  showScene(gallery.find((entry) => !isMaking(entry, 'scene')));
}

/** Says that there is a work to come back to. */
function offer(id, title = 'Your work') {
  tell(`${title} is still kept in this browser.`, ['Open it', async () => {
    if (!(await mayReplace())) return;
    history.pushState({ work: id }, '', kBare);
    if (await restore(id)) return;
    note('It is not there any more');
    keeper.resume();
  }]);
}

// What should have come did not: the address is that of what is shown again.
function stayWhereWeAre() {
  if (shown.scene !== current.scene || shown.src !== current.src) {
    current = shown;
    history.replaceState(null, '', shownByLink() ? linkOfPage() : kBare);
    markCard();
  }
  keeper.resume();
}

// What a person opened has taken the place of the scene that the address names.
function takeOwn() {
  current = {};
  tell('');
  history.pushState(null, '', kBare);
  markCard();
}

/** @return {Promise<boolean>}  whether the file was handed out */
async function saveScene() {
  try {
    const name = `${nameOfScene()}.lucent.zip`;
    download(await viewer.saveScene(), name);
    keeper.saved();
    tellTag(name);
    return true;
  } catch ({ message }) {
    note(message);
    return false;
  }
}

/** How a saved scene comes into a page. */
function tellTag(name) {
  const quoted = (text) => `"${text.replaceAll('&', '&amp;').replaceAll('"', '&quot;')}"`;
  const tag = `<lucent-viewer src=${quoted(name)} alt=${quoted(viewer.sceneTitle)}></lucent-viewer>`;
  tell(`Scene saved. Beside your page it is shown by ${tag}`, ['Copy tag', () => copy(tag, 'Tag copied')], ['Close', () => {}]);
}

async function copy(text, done) {
  try {
    await navigator.clipboard.writeText(text);
    note(done);
  } catch {
    note(`This browser keeps pages from copying: ${text}`);
  }
}

/** For files: of the gallery's scene, else its title without what no file may be called. */
function nameOfScene() {
  return current.scene ?? (viewer.sceneTitle.replace(/[/\\:*?"<>|]+/g, '-').trim() || 'lucent');
}

async function openFiles(files, kind) {
  if (kind !== 'environment' && !(await mayReplace())) return; // which comes into the scene
  await viewer.openFile(files, kind);
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
  card.toggleAttribute('aria-current', id === current.scene);
  const name = Object.assign(document.createElement('b'), { textContent: title });
  const text = Object.assign(document.createElement('small'), { textContent: caption });
  card.append(image, name, text);
  card.addEventListener('click', async (event) => {
    viewer.scrollIntoView({ block: 'nearest' });
    if (id !== current.scene || !keeper.beyondLink.length) return;
    event.preventDefault(); // the address is that of the scene, but more is shown than it says
    if (!(await mayReplace())) return;
    await keeper.putAside();
    history.pushState(null, '', card.href);
    showScene(entry);
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
    if (entry.id === current.scene && entry.truth && !viewer.truth) {
      viewer.truthNoise = entry.truth.noise;
      viewer.truth = 'gallery/' + entry.truth.file;
    }
  }
  if (!viewer.loaded && !shownByLink()) followLink();
  showMaking();
}

/** Says what is being made, and asks again as long as something is. */
function showMaking() {
  const count = (what) => gallery.filter((entry) => isMaking(entry, what)).length;
  const names = { scene: 'scene', picture: 'picture', truth: 'exact solution' };
  const parts = Object.keys(names)
    .filter(count)
    .map((what) => `${count(what)} ${names[what]}${count(what) > 1 ? 's' : ''}`);
  const entry = gallery.find(({ id }) => id === current.scene);
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

/** Shows a mode of the scene at hand, or else of the first scene that has it, unless the person's own would go. */
function showMode(kind) {
  const mode = kind.toLowerCase();
  if (viewer.stats().modes?.includes(mode)) return viewer.set('mode', mode);
  if (keeper.beyondLink.length)
    return note(`${kind}: nothing in your scene is for this mode; the gallery below has scenes that are`);
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

viewer.addEventListener('load', ({ detail }) => {
  const isNew = !isRestoring && !detail.moved && !detail.into;
  if (isNew && viewer.ownScene) takeOwn();
  shown = current;
  if (isNew) keeper.begin(current);
  else keeper.keep(); // it has one more file
  const changes = pending;
  pending = {};
  applyChanges(changes);
  document.title = `${viewer.sceneTitle} – Lucent`;
  find('title').textContent = viewer.sceneTitle;
  find('caption').textContent = viewer.caption;
  writeLinkSoon();
});
viewer.addEventListener('error', ({ detail }) => {
  if (!['fetch', 'scene', 'file'].includes(detail.code)) return;
  if (viewer.loaded) return stayWhereWeAre();
  find('title').textContent = 'Nothing is shown yet';
  tell(detail.message, ['Start from the gallery', showGallery]);
});
viewer.addEventListener('drop-files', (event) => {
  event.preventDefault();
  openFiles(event.detail.files, event.detail.kind);
});
viewer.addEventListener('change', writeLinkSoon);
viewer.addEventListener('change', showCompare);
viewer.addEventListener('load', showCompare);
viewer.addEventListener('change', showModes);
viewer.addEventListener('load', showModes);
viewer.addEventListener('frame', showCost);
for (const type of ['change', 'edit', 'load']) viewer.addEventListener(type, showSteps);

// ---- toolbar

/** Which of the buttons have something to take back. They keep the focus: keyboards stand on them. */
function showSteps() {
  const { canUndo, canRedo } = viewer.stats();
  find('undo').ariaDisabled = String(!canUndo);
  find('redo').ariaDisabled = String(!canRedo);
}

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
    const files = [...target.files];
    target.value = '';
    if (files.length) openFiles(files, kind);
  });
}

/** Copies a link that keeps all that a link can, and says what it cannot. */
async function copyLink() {
  const beyond = keeper.beyondLink;
  const save = ['Save scene', saveScene];
  if (beyond.includes('scene'))
    return tell('No link can hold a scene of your own; a saved one is a file that you can send.', save);
  writeLink();
  await copy(new URL(linkOfPage(), location.href).href, 'Link copied');
  const names = { files: 'the files that you opened', paint: 'what you painted' };
  const lacking = beyond.map((one) => names[one]).join(' and ');
  if (lacking) tell(`The link keeps all but ${lacking}; a saved scene holds everything.`, save);
}

/** A dialog that is fetched when it is asked for. */
function openDialog(button, load, open) {
  find(button).addEventListener('click', () => load().then(open, ({ message }) => note(message)));
}

find('undo').addEventListener('click', () => viewer.undo());
find('redo').addEventListener('click', () => viewer.redo());
find('reset').addEventListener('click', () => viewer.reset());
openDialog('save', () => import('./picture.js'), ({ openPictureDialog }) => openPictureDialog(viewer, nameOfScene()));
openDialog('open-scene', () => import('./open.js'), ({ openSceneDialog }) => openSceneDialog({ openFiles, openLink }));
find('save-scene').addEventListener('click', saveScene);
find('copy').addEventListener('click', copyLink);
find('compare').addEventListener('change', ({ target }) => viewer.set('compare', target.value));
find('time').addEventListener('change', showCost);
openDialog('check', () => import('./selfcheck.js'), ({ openSelfCheck }) => openSelfCheck(viewer));
openDialog('tour', () => import('./tour.js'), ({ showTour }) => showTour());
openWith('open-maps', 'maps-file', 'scene');
openWith('open-environment', 'environment-file', 'environment');
openWith('open-mesh', 'mesh-file', 'scene');

async function fetchGallery() {
  const response = await fetch('gallery/index.json');
  if (!response.ok) throw new Error(`gallery/index.json: the server answers ${response.status}; scripts/run makes it`);
  return response.json();
}

/** What the page opens with: the work that was here when it was left, else what the address says. */
async function showFirst() {
  const newest = await keeper.newest();
  const here = history.state?.work ?? (location.hash ? undefined : newest?.id);
  if (here && (await restore(here))) return;
  followLink();
  if (newest) viewer.addEventListener('load', () => offer(newest.id, `“${newest.title}”`), { once: true });
}

/** A link that a person pasted: of this page, or the address of a scene. */
async function openLink(text) {
  const address = new URL(text, location.href);
  const isPage = address.origin === location.origin && address.pathname === location.pathname && address.hash;
  if (!(await mayReplace())) return;
  await keeper.putAside();
  history.pushState(null, '', isPage ? address.hash : '#' + new URLSearchParams({ src: address.href }));
  followLink();
}

// True where a page may remember nothing: it would be shown again and again.
function seenTour() {
  try {
    return localStorage.getItem('lucent.tour') !== null;
  } catch {
    return true;
  }
}

async function start() {
  gallery = await fetchGallery();
  find('gallery').replaceChildren(...galleryCards());
  find('modes').replaceChildren(...modeButtons());
  addEventListener('popstate', follow);
  await showFirst();
  showMaking();
  if (!seenTour()) (await import('./tour.js')).showTour();
}
start().catch(({ message }) => note(message));
