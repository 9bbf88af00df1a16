/** What a person opens or drops becomes a scene of its own: pictures that belong together, a model with its parts. */
import { reading, sceneAmong, toPlain } from './files.js';

const kMesh = /\.(glb|gltf|obj|mesh)$/i;

const isMesh = ({ name }) => kMesh.test(name);
const isLightFile = ({ name }) => /\.lp$/i.test(name);

/** What files are for. @param environmentWanted  the person pointed at that half, or held Alt */
export function kindOfDrop(files, environmentWanted) {
  const isAlone = files.length === 1 && !isMesh(files[0]) && !sceneAmong(files);
  return isAlone && (environmentWanted || /\.(hdr|exr)$/i.test(files[0].name)) ? 'environment' : 'scene';
}

const bytesOf = async (file) => new Uint8Array(await file.arrayBuffer());

/** Parts of a file that a person opened are among those opened with it. */
const among = (files) => async (name) => {
  const file = files.find((one) => one.name === name.split('/').pop());
  return file && bytesOf(file);
};

/** A file in a form that the loader reads, under the name that such files have. */
const plainFile = async (file, files) => toPlain(file.name, await bytesOf(file), among(files));

/** {path, files} of a scene that the second module makes of one file. @param call  of that module */
const bring = (call, { name, bytes }) =>
  reading.ask({ task: 'bring', name, call, files: new Map([[name, bytes]]), value: name });

const kAlone = { '.binary': 'reader_bring_table', '.ptm': 'reader_bring_ptm' }; // files that are a scene each

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
 * @return {Promise<{path: string, files: Map<string, Uint8Array>} | null>}
 */
export async function bringScene(files, { ask, solve }) {
  const light = files.find(isLightFile);
  if (light) return solve(light, files);
  const mesh = files.find(isMesh);
  if (mesh) return bring('reader_bring_mesh', await plainFile(mesh, files));
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
  return reading.ask({ task: 'bring', name, call: 'reader_bring_maps', files: content, value });
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
