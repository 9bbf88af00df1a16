/**
 * Works out once what a technique needs of an object, with the whole module and no context. Pages start this file as a
 * worker; where they cannot, they import it and the work is done on the page, in short slices.
 */
import { answerRequests, kPageSlice, workThrough } from './answering.js';
import { callWasm, putFile } from './wasm.js';

/**
 * @param request  files: Map of name to bytes with "scene.json", whose object the technique bakes; technique
 * @param report   called with the finished share, [0,1]; the work ends when it returns false
 * @return {Promise<{bytes: Uint8Array} | null>}  the file that `lucent bake` would write; null when it was ended
 */
export async function work({ files, technique }, report, slice = kPageSlice) {
  const locateFile = (name) => new URL(name, import.meta.url).href;
  const { default: create } = await import(locateFile('./lucent.js'));
  const wasm = await create({ locateFile });
  const text = (call, ...values) => wasm.UTF8ToString(callWasm(wasm, call, ...values));
  for (const [name, bytes] of files) putFile(wasm, 'file_space', name, bytes);
  const message = text('bake_begin', 'scene.json', technique);
  if (message) throw new Error(message);
  if (!(await workThrough((ms) => callWasm(wasm, 'bake_step', ms), report, slice))) return null;
  const { at, size, error } = JSON.parse(text('bake_file'));
  if (error) throw new Error(error);
  return { bytes: wasm.HEAPU8.slice(at, at + size) };
}

answerRequests(work, ({ bytes }) => [bytes.buffer]);
