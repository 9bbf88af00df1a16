/** Brings files to the module: scenes with everything they name, and what a person opens. */
import { LucentError } from './runtime.js';
import { callWasm } from './wasm.js';

const kForeign = /\.(exr|glb|gltf|obj)$/i;
const kMesh = /\.(glb|gltf|obj|mesh)$/i;

async function fetchBytes(url, name) {
  let response;
  try {
    response = await fetch(url);
  } catch {
    throw new LucentError(
      'fetch',
      `${name}: cannot be fetched from ${url.origin}; must be a file that this page may read`,
    );
  }
  if (!response.ok) throw new LucentError('fetch', `${name}: the server answers ${response.status}; must be there`);
  return new Uint8Array(await response.arrayBuffer());
}

let readers;
/** The second module, which understands glTF, OBJ and EXR; fetched when the first such file is met. */
function loadReaders() {
  const address = (name) => new URL(name, import.meta.url).href;
  readers ??= import(address('lucent-readers.js'))
    .then(({ default: create }) => create({ locateFile: address }))
    .catch(({ message }) => {
      throw new LucentError('fetch', `lucent-readers.js: ${message}; it must lie beside the script with its .wasm`);
    });
  return readers;
}

/**
 * The bytes in a form that the loader reads: glTF, OBJ and EXR are converted, everything else stays as it is.
 * @param part  (name) => promise of the bytes of a file beside it that it names, undefined when there is none
 */
async function toPlain(name, bytes, part) {
  if (!kForeign.test(name)) return bytes;
  const wasm = await loadReaders();
  if (!callWasm(wasm, 'reader_is_foreign', name, bytes)) return bytes;
  const parts = new Map([[name, bytes]]);
  callWasm(wasm, 'reader_file_put', name, bytes);
  for (const needed of JSON.parse(wasm.UTF8ToString(callWasm(wasm, 'reader_needs', name)))) {
    const content = await part(needed).catch((error) => {
      if (!/\.obj$/i.test(name)) throw error; // which has triangles without its materials
    });
    if (content) parts.set(needed, content);
  }
  // Without a pause from here on: the module forgets all files after a conversion.
  for (const [path, content] of parts) callWasm(wasm, 'reader_file_put', path, content);
  const message = wasm.UTF8ToString(callWasm(wasm, 'reader_to_plain', name));
  if (message) throw new LucentError('scene', message);
  const start = callWasm(wasm, 'reader_bytes');
  return wasm.HEAPU8.slice(start, start + callWasm(wasm, 'reader_size'));
}

/** Parts of a file that was fetched lie beside it. */
const beside = (url) => (name) => fetchBytes(new URL(name, url), name);

/** Parts of a file that a person opened are among those opened with it. */
const among = (files) => async (name) => {
  const file = files.find((one) => one.name === name.split('/').pop());
  return file && new Uint8Array(await file.arrayBuffer());
};

const fileName = (url) => decodeURIComponent(url.pathname.split('/').pop());

/**
 * Fetches a scene and every file it names.
 * @param starting  promise of the runtime: the scene is on its way meanwhile
 * @return {Promise<{path: string, files: Map<string, Uint8Array>}>}  the scene's own name and all files by name
 */
export async function fetchScene(starting, url) {
  const path = fileName(url) || url.href;
  const [runtime, scene] = await Promise.all([starting, fetchBytes(url, path)]);
  runtime.call('file_put', path, scene);
  const { files: names, error } = runtime.json('scene_dependencies', path);
  runtime.call('file_forget', path);
  if (error) throw new LucentError('scene', error);
  const files = new Map([[path, scene]]);
  const fetchOne = async (name) => {
    const address = new URL(name, url);
    return [name, await toPlain(name, await fetchBytes(address, name), beside(address))];
  };
  for (const [name, bytes] of await Promise.all(names.map(fetchOne))) files.set(name, bytes);
  return { path, files };
}

/**
 * Gives fetched files to the module for one load and takes them back, so that two scenes may use the same names.
 * @return {string}  "" or what is wrong
 */
export function loadFiles(runtime, handle, { path, files }) {
  for (const [name, bytes] of files) runtime.call('file_put', name, bytes);
  const message = runtime.text('viewer_load', handle, path);
  for (const name of files.keys()) runtime.call('file_forget', name);
  return message;
}

/** The name and the bytes of one picture, in a form that the module reads. */
export async function fetchPicture(url) {
  const name = fileName(url);
  return { name, bytes: await toPlain(name, await fetchBytes(url, name), beside(url)) };
}

/** Of files dropped together the one that is opened: a mesh before its parts. */
export const mainFile = (files) => files.find(({ name }) => kMesh.test(name)) ?? files[0];

/** What a dropped picture is for. @param environmentWanted  the person pointed at that half, or held Alt */
export function kindOfDrop(name, environmentWanted) {
  return environmentWanted || /\.(hdr|exr)$/i.test(name) ? 'environment' : 'height';
}

/**
 * Shows a picture or a mesh that a person opened. Throws a LucentError.
 * @param files  one, or a mesh with its parts
 * @param kind   of a picture: 'height' or 'environment'
 */
export async function openOwn(runtime, handle, files, kind) {
  const file = mainFile(files);
  const { name } = file;
  if (/\.json$/i.test(name))
    throw new LucentError(
      'file',
      `${name}: a scene names further files, which a page cannot read from disk; put it on a server and name it in src`,
    );
  const bytes = await toPlain(name, new Uint8Array(await file.arrayBuffer()), among(files));
  const message = kMesh.test(name)
    ? runtime.text('viewer_open_mesh', handle, name, bytes)
    : runtime.text('viewer_open_image', handle, name, bytes, kind === 'environment' ? 1 : 0);
  if (message) throw new LucentError('file', message);
}
