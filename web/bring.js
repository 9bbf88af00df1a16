/** What a person opens or drops becomes a scene of its own: pictures that belong together, a model with its parts. */
import { sceneAmong, toPlain, withReaders } from './files.js';
import { LucentError } from './runtime.js';
import { callWasm } from './wasm.js';

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
async function plainFile(file, files) {
  const own = await bytesOf(file);
  const bytes = await toPlain(file.name, own, among(files));
  if (bytes === own) return { name: file.name, bytes };
  const nameIn = (wasm) => wasm.UTF8ToString(callWasm(wasm, 'reader_plain_name', file.name, bytes));
  return { name: await withReaders(file.name, nameIn), bytes };
}

/** What the second module answers about files in plain form: take(answer, wasm) while their bytes are there. */
const askReaders = (plain, take, call, ...values) =>
  withReaders(plain[0].name, (wasm) => {
    for (const { name, bytes } of plain) callWasm(wasm, 'reader_file_put', name, bytes);
    return take(JSON.parse(wasm.UTF8ToString(callWasm(wasm, call, ...values))), wasm);
  });

/** {path, files} of an answer: the scene's own name, all files by name. */
function takeScene({ files, error }, wasm) {
  if (error) throw new LucentError('file', error);
  const bytesAt = ({ name, at, size }) => [name, wasm.HEAPU8.slice(at, at + size)];
  return { path: files[0].name, files: new Map(files.map(bytesAt)) };
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
 * @return {Promise<{path: string, files: Map<string, Uint8Array>} | null>}
 */
export async function bringScene(files, { ask, solve }) {
  const light = files.find(isLightFile);
  if (light) return solve(light, files);
  const mesh = files.find(isMesh);
  if (mesh) {
    const plain = await plainFile(mesh, files);
    return askReaders([plain], takeScene, 'reader_bring_mesh', plain.name);
  }
  const table = files.find(({ name }) => /\.binary$/i.test(name));
  if (table) return askReaders([{ name: table.name, bytes: await bytesOf(table) }], takeScene, 'reader_bring_table', table.name);
  const ptm = files.find(({ name }) => /\.ptm$/i.test(name));
  if (ptm) return askReaders([{ name: ptm.name, bytes: await bytesOf(ptm) }], takeScene, 'reader_bring_ptm', ptm.name);
  const plain = await Promise.all(files.map((file) => plainFile(file, files)));
  const known = await askReaders(plain, (uses) => new Map(uses.map(({ name, use }) => [name, use])), 'reader_uses');
  const told = plain.map(({ name }) => known.get(name));
  const uses = isSet(told) ? told : await ask(plain.map((picture, at) => ({ ...picture, use: told[at] })));
  if (!uses) return null;
  const useOf = Object.fromEntries(plain.map(({ name }, at) => [name, uses[at]]));
  return askReaders(plain, takeScene, 'reader_bring_maps', JSON.stringify(useOf));
}

/** The bytes of one picture in a form that the module reads. */
export const openPicture = (file) => plainFile(file, [file]);

/** All files of a drop, those in folders too. */
export async function droppedFiles(transfer) {
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
