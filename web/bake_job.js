/**
 * Works out once what a technique needs of an object, with the whole module and no context. Pages start this file as a
 * worker; where they cannot, they import it and wait.
 */
import { answerRequests } from './answering.js';
import { callWasm, putFile } from './wasm.js';

const kPaint = 50; // ms in which a page shows that it waits

/**
 * @param request  files: Map of name to bytes with "scene.json", whose object the technique bakes; technique
 * @param report   called with the finished share, [0,1]
 * @return {Promise<{bytes: Uint8Array}>}  the file that `lucent bake` would write
 */
export async function work({ files, technique }, report) {
  const locateFile = (name) => new URL(name, import.meta.url).href;
  const { default: create } = await import(locateFile('./lucent.js'));
  const wasm = await create({ locateFile, reportShare: report });
  report(0);
  await new Promise((done) => setTimeout(done, kPaint));
  for (const [name, bytes] of files) putFile(wasm, 'file_space', name, bytes);
  const { at, size, error } = JSON.parse(wasm.UTF8ToString(callWasm(wasm, 'bake_scene', 'scene.json', technique)));
  if (error) throw new Error(error);
  return { bytes: wasm.HEAPU8.slice(at, at + size) };
}

answerRequests(work, ({ bytes }) => [bytes.buffer]);
