/** What a person opens or drops becomes a scene of its own: pictures that belong together, a model with its parts. */
import { reading, sceneAmong, toPlain } from './files.js';
import { LucentError } from './runtime.js';

const kMesh = /\.(glb|gltf|obj|mesh)$/i;

const isMesh = ({ name }) => kMesh.test(name);
const isLightFile = ({ name }) => /\.lp$/i.test(name);

/** What files are for. @param environmentWanted  the person pointed at that half, or held Alt */
export function kindOfDrop(files, environmentWanted) {
  const isAlone = files.length === 1 && !isMesh(files[0]) && !sceneAmong(files);
  return isAlone && (environmentWanted || isEnvironment(files[0])) ? 'environment' : 'scene';
}

const bytesOf = async (file) => new Uint8Array(await file.arrayBuffer());

/** Parts of a file that a person opened are among those opened with it. @param taken  Set of those that were asked for */
const among = (files, taken) => async (name) => {
  const file = files.find((one) => one.name === name.split('/').pop());
  if (file) taken?.add(file);
  return file && bytesOf(file);
};

/** A file in a form that the loader reads, under the name that such files have. */
const plainFile = async (file, files, taken) => toPlain(file.name, await bytesOf(file), among(files, taken));

/** {path, files} of a scene that the second module makes of one file. @param call  of that module */
const bring = (call, { name, bytes }) =>
  reading.ask({ task: 'bring', name, call, files: new Map([[name, bytes]]), value: name });

const kAlone = { '.binary': 'reader_bring_table', '.ptm': 'reader_bring_ptm' }; // files that are a scene each

const kOpened = /\.(png|jpe?g|tiff?|hdr|exr|pfm|glb|gltf|obj|mesh|lp|ptm|binary|json|zip)$/i;
const kParts = /\.(bin|mtl)$/i;
const kEnding = /\.[^.]+$/;

// Files that are of no kind that can be opened are told by their endings; those without one by what they hold.
function checkKinds(files) {
  const odd = files.find(({ name }) => kEnding.test(name) && !kOpened.test(name) && !kParts.test(name));
  if (!odd || files.some(({ name }) => kOpened.test(name))) return;
  throw new LucentError(
    'file',
    `${odd.name}: files ending in ${odd.name.match(kEnding)[0]} cannot be opened; must be a picture (PNG, JPEG, TIFF, ` +
      'HDR, EXR, PFM), a model (glTF, GLB, OBJ), photographs with the file of their lights (.lp), a PTM, a measured ' +
      'material (.binary) or a scene (.json, .zip)',
  );
}

const isEnvironment = ({ name }) => /\.(hdr|exr)$/i.test(name);

// A model with its parts; one light probe beside it lights it.
async function bringMesh(mesh, files) {
  const taken = new Set([mesh]);
  const scene = await bring('reader_bring_mesh', await plainFile(mesh, files, taken));
  const others = files.filter((file) => !taken.has(file) && !kParts.test(file.name));
  const probes = others.filter(isEnvironment);
  const environment = probes.length === 1 ? probes[0] : undefined;
  const left = others
    .filter((file) => file !== environment)
    .map(({ name }) => (kMesh.test(name) ? `${name}, as one model is opened at a time` : `${name}, which ${mesh.name} does not name`));
  return { ...scene, environment, left };
}

// Pictures that nobody said to leave out and that are not in the scene.
function leftAmong(pictures, uses) {
  const heights = pictures[uses.indexOf('height')];
  const normals = pictures[uses.indexOf('normal')];
  return heights && normals ? [`${normals.name}, as the heights come from ${heights.name}`] : [];
}

/** Whether nobody needs to be asked: each picture is for something else, and one tells the heights. */
export function isSet(uses) {
  const said = uses.filter((use) => use !== 'none');
  return said.every((use, at) => use && said.indexOf(use) === at) && said.some((use) => /^(height|normal)$/.test(use));
}

/**
 * The scene of files that a person brings. Throws a LucentError.
 * @param files  one or several; parts of a model come with it
 * @param ask    (pictures: {name, use, bytes}[]) => promise of their uses, null where the person goes back
 * @param solve  (light, files) => promise of the scene of photographs with the file of their lights, null likewise
 * @return {Promise<{path: string, files: Map<string, Uint8Array>, environment?: File, left?: string[]} | null>}  with a
 *         light probe that is to light it, and what is not in it, in words
 */
export async function bringScene(files, { ask, solve }) {
  const light = files.find(isLightFile);
  if (light) return solve(light, files);
  const mesh = files.find(isMesh);
  if (mesh) return bringMesh(mesh, files);
  checkKinds(files);
  for (const [ending, call] of Object.entries(kAlone)) {
    const file = files.find(({ name }) => name.toLowerCase().endsWith(ending));
    if (file) return bring(call, { name: file.name, bytes: await bytesOf(file) });
  }
  const plain = await Promise.all(files.map((file) => plainFile(file, files)));
  const content = new Map(plain.map(({ name, bytes }) => [name, bytes]));
  const name = plain[0].name;
  const known = await reading.ask({ task: 'uses', name, files: content });
  const told = plain.map(({ name }) => known.get(name));
  const uses = isSet(told) ? told : await ask(plain.map((picture, at) => ({ ...picture, use: told[at] })));
  if (!uses) return null;
  const value = JSON.stringify(Object.fromEntries(plain.map(({ name }, at) => [name, uses[at]])));
  const scene = await reading.ask({ task: 'bring', name, call: 'reader_bring_maps', files: content, value });
  return { ...scene, left: leftAmong(plain, uses) };
}

/** The bytes of one picture in a form that the module reads. */
export const openPicture = (file) => plainFile(file, [file]);

/** All files of a drop, those in folders too. */
async function droppedFiles(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.());
  if (!entries.some((entry) => entry?.isDirectory)) return [...transfer.files];
  return (await Promise.all(entries.filter(Boolean).map(filesUnder))).flat();
}

async function filesUnder(entry) {
  if (entry.isFile) return [await new Promise((done, failed) => entry.file(done, failed))];
  const reader = entry.createReader();
  const files = [];
  for (;;) {
    const some = await new Promise((done, failed) => reader.readEntries(done, failed)); // a hundred at a time
    if (!some.length) return files;
    files.push(...(await Promise.all(some.map(filesUnder))).flat());
  }
}

/**
 * Lets a viewer take what is dropped on it, unless its event drop-files is cancelled.
 * @param zones  shown over it meanwhile: one for a new scene, one for an environment
 */
export function acceptDrops(viewer, zones) {
  const [sceneZone, environmentZone] = zones.children;
  const isOfFiles = ({ dataTransfer }) => dataTransfer.types.includes('Files');
  const aimsAtEnvironment = ({ altKey, clientX }) => {
    const { left, width } = viewer.getBoundingClientRect();
    return altKey || clientX > left + width / 2;
  };
  viewer.addEventListener('dragover', (event) => {
    if (!isOfFiles(event)) return;
    event.preventDefault();
    zones.classList.add('shown');
    environmentZone.classList.toggle('aimed', aimsAtEnvironment(event));
    sceneZone.classList.toggle('aimed', !aimsAtEnvironment(event));
  });
  viewer.addEventListener('dragleave', ({ relatedTarget }) => {
    if (!viewer.contains(relatedTarget)) zones.classList.remove('shown');
  });
  viewer.addEventListener('drop', async (event) => {
    zones.classList.remove('shown');
    if (!isOfFiles(event)) return;
    event.preventDefault();
    const isAimed = aimsAtEnvironment(event);
    const files = await droppedFiles(event.dataTransfer);
    if (!files.length) return;
    const kind = kindOfDrop(files, isAimed);
    const wanted = new CustomEvent('drop-files', { detail: { files, kind }, cancelable: true });
    if (viewer.dispatchEvent(wanted)) viewer.openFile(files, kind);
  });
}
