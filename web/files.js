/** Brings files to the module: scenes with everything they name, in a form that it reads. */
import { LucentError } from './runtime.js';
import { callWasm, isAbort } from './wasm.js';

const kForeign = /\.(exr|tiff?|glb|gltf|obj)$/i;
// Keys that make a material another kind than relief,
const kKinds = ['kind', 'reflectance', 'transmission', 'scattering', 'preset'];
// and keys of "technique" that the module of reliefs knows.
const kReliefSettings = ['relief', 'sampling'];

/** An address as seen from another; undefined where there is none. */
function addressOf(name, from) {
  try {
    return new URL(name, from);
  } catch {
    return undefined;
  }
}

/**
 * How far a scene reaches: to what lies beneath its own folder, or beneath a folder that the page allows.
 *
 * @param url      of the scene
 * @param allowed  addresses of folders
 */
export class Reach {
  #folders;
  constructor(url, allowed = []) {
    this.#folders = [url, ...allowed].flatMap((one) => addressOf('.', one)?.href ?? []); // blob: has no folder
  }

  /** The address of a file. Throws a LucentError when it lies outside. @param from  address of the file that names it */
  find(name, from) {
    const address = addressOf(name, from);
    if (address && this.#holds(address)) return address;
    const folder = this.#folders[0] ?? 'the scene';
    throw new LucentError(
      'scene',
      `${name}: lies outside ${folder}; must lie beneath it, or beneath an address that allow names`,
    );
  }
  /** What was fetched may come from elsewhere than was asked. */
  check({ redirected, url }) {
    if (redirected) this.find(url, url);
  }

  // A browser takes .. and %2e out of an address; a server may take %2f for a slash.
  #holds({ protocol, href, pathname }) {
    if (protocol === 'data:') return true;
    return !/%2f|%5c/i.test(pathname) && this.#folders.some((folder) => href.startsWith(folder));
  }
}

/** @param reach  of the scene that names the file; none where the page itself does */
async function fetchBytes(url, name, reach) {
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
  reach?.check(response);
  return new Uint8Array(await response.arrayBuffer());
}

let readers;
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
 * Works with the second module, which understands glTF, OBJ and EXR and makes scenes of a person's files; it is fetched
 * when first needed.
 * @param name  of the file that is worked on
 * @param work  (wasm) => what the promise gives
 */
export async function withReaders(name, work) {
  const wasm = await loadReaders();
  try {
    return await work(wasm);
  } catch (error) {
    if (!isAbort(error)) throw error;
    readers = undefined; // the next file gets a fresh module
    throw new LucentError('scene', `${name}: cannot be read (${error.message}); must need less memory`);
  }
}

/**
 * The bytes in a form that the loader reads: glTF, OBJ and EXR are converted, everything else stays as it is.
 * @param part  (name) => promise of the bytes of a file beside it that it names, undefined when there is none
 */
export async function toPlain(name, bytes, part) {
  return kForeign.test(name) ? withReaders(name, (wasm) => convert(wasm, name, bytes, part)) : bytes;
}

async function convert(wasm, name, bytes, part) {
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
const beside = (url, reach) => async (name) => fetchBytes(reach.find(name, url), name, reach);

const fileName = (url) => decodeURIComponent(url.pathname.split('/').pop());

/** Whether a scene asks for more than the module of reliefs draws. Of what is no scene that module says what is wrong. */
export function needsWhole(bytes) {
  const isRelief = ({ shape, material = {} }) =>
    shape.type === 'heightfield' && (material.kind === 'relief' || !kKinds.some((key) => key in material));
  try {
    const { objects, technique = {} } = JSON.parse(new TextDecoder().decode(bytes));
    return !objects.every(isRelief) || Object.keys(technique).some((name) => !kReliefSettings.includes(name));
  } catch {
    return false;
  }
}

/**
 * Fetches a scene and every file it names.
 * @param start    (whole) => promise of the runtime that draws it
 * @param allowed  addresses of folders beneath which files may lie, beside the scene's own
 * @return {Promise<{path: string, files: Map<string, Uint8Array>, whole: boolean}>}  the scene's own name, all files by
 *                 name, and whether it needs the whole module
 */
export async function fetchScene(start, url, allowed) {
  const path = fileName(url) || url.href;
  const scene = await fetchBytes(url, path);
  const whole = needsWhole(scene);
  const runtime = await start(whole);
  runtime.call('file_put', path, scene);
  const { files: names, error } = runtime.json('scene_dependencies', path);
  runtime.call('file_forget', path);
  if (error) throw new LucentError('scene', error);
  const files = new Map([[path, scene]]);
  const reach = new Reach(url, allowed);
  const fetchOne = async (name) => {
    const address = reach.find(name, url);
    return [name, await toPlain(name, await fetchBytes(address, name, reach), beside(address, reach))];
  };
  for (const [name, bytes] of await Promise.all(names.map(fetchOne))) files.set(name, bytes);
  return { path, files, whole };
}

/**
 * Gives fetched files to the module for one load and takes them back, so that two scenes may use the same names. Throws a
 * LucentError.
 */
export function loadFiles({ runtime, handle }, { path, files }) {
  for (const [name, bytes] of files) runtime.call('file_put', name, bytes);
  const message = runtime.text('viewer_load', handle, path);
  for (const name of files.keys()) runtime.call('file_forget', name);
  if (message) throw new LucentError('scene', message);
}

/** The name and the bytes of one picture, in a form that the module reads. */
export async function fetchPicture(url) {
  const name = fileName(url);
  return { name, bytes: await toPlain(name, await fetchBytes(url, name), beside(url, new Reach(url))) };
}
