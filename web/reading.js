/**
 * What the second module does: it understands glTF, OBJ, EXR and TIFF and makes scenes of a person's files. Pages start
 * this file as a worker; where they cannot, they import it and the work is done on the page.
 */
import { answerRequests } from './answering.js';
import { callWasm, isAbort, putFile } from './wasm.js';

let module;
function loadModule() {
  const address = (name) => new URL(name, import.meta.url).href;
  module ??= import(address('lucent-readers.js'))
    .then(({ default: create }) => create({ locateFile: address }))
    .catch(({ message }) => {
      module = undefined;
      throw failure('fetch', `lucent-readers.js: ${message}; it must lie beside the script with its .wasm`);
    });
  return module;
}

const failure = (code, message) => Object.assign(new Error(message), { code });

const text = (wasm, call, ...values) => wasm.UTF8ToString(callWasm(wasm, call, ...values));
const put = (wasm, files) => files.forEach((bytes, name) => putFile(wasm, 'reader_file_space', name, bytes));
const bytesAt = (wasm, at, size) => wasm.HEAPU8.slice(at, at + size);
const filesAt = (wasm, files) => new Map(files.map(({ name, at, size }) => [name, bytesAt(wasm, at, size)]));

function converted(wasm, code, message) {
  if (message) throw failure(code, message);
  return bytesAt(wasm, callWasm(wasm, 'reader_bytes'), callWasm(wasm, 'reader_size'));
}

const kTasks = {
  /** Files that one names for itself, [{file, optional}]; null where it is in a plain form already. */
  needs(wasm, { name, bytes }) {
    if (!/\.mtl$/i.test(name) && !callWasm(wasm, 'reader_is_foreign', name, bytes)) return null;
    putFile(wasm, 'reader_file_space', name, bytes);
    return JSON.parse(text(wasm, 'reader_needs', name));
  },
  /** A file in its plain form, and the name that such files have. @param parts  Map with it, and what it needs */
  convert(wasm, { name, parts }) {
    put(wasm, parts);
    const bytes = converted(wasm, 'scene', text(wasm, 'reader_to_plain', name));
    return { bytes, name: text(wasm, 'reader_plain_name', name, bytes) };
  },
  /** {files: texels, standIn} of a picture for a mesh, decoded apart from it; null where it cannot be. */
  texels(wasm, { bytes, number }) {
    const { files } = JSON.parse(text(wasm, 'reader_to_texels', number, bytes));
    return files ? { files: filesAt(wasm, files) } : null;
  },
  /** What each of several pictures is for, by name. @param files  Map */
  uses(wasm, { files }) {
    put(wasm, files);
    return new Map(JSON.parse(text(wasm, 'reader_uses')).map(({ name, use }) => [name, use]));
  },
  /** {path, files} of a scene of a person's files. @param call  of the module, which takes `value` */
  bring(wasm, { call, files, value }) {
    put(wasm, files);
    const { files: made, error } = JSON.parse(text(wasm, call, value));
    if (error) throw failure('file', error);
    return { path: made[0].name, files: filesAt(wasm, made) };
  },
  /** Linear values, 4 floats a pixel as bytes, as EXR. */
  exr(wasm, { width, height, bytes }) {
    return { bytes: converted(wasm, 'file', text(wasm, 'reader_to_exr', width, height, 4, bytes)) };
  },
};

/** @param request  task, a name above; what it wants; name of the file, for messages */
export async function work({ task, ...request }) {
  const wasm = await loadModule();
  try {
    return kTasks[task](wasm, request);
  } catch (error) {
    if (!isAbort(error)) throw error;
    module = undefined; // the next file gets a fresh one
    throw failure('scene', `${request.name}: cannot be read (${error.message}); must need less memory`);
  }
}

const buffersOf = ({ bytes, files = new Map() }) => [bytes, ...files.values()].flatMap((one) => one?.buffer ?? []);
answerRequests(work, (result) => (result instanceof Map || !result ? [] : buffersOf(result)));
