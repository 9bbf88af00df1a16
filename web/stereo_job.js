/**
 * Photometric stereo of a person's photographs with the second module. Pages start this file as a worker; where they
 * cannot, they import it and the work is done on the page, in short slices.
 */
import { answerRequests, kPageSlice, workThrough } from './answering.js';
import { callWasm } from './wasm.js';

const kReading = 0.4; // of the progress: reading photographs, the rest is solving

const bytesOf = async (file) => new Uint8Array(await file.arrayBuffer());

/** The file that a light file means: of that name, whatever folder it is said to lie in. */
function fileNamed(name, files) {
  const last = name.split('/').pop().toLowerCase();
  const file = files.find((one) => one.name.toLowerCase() === last);
  if (!file) throw new Error(`${name}: is named by the light file; must be opened together with it`);
  return file;
}

/**
 * @param request  light: File of the lights (.lp); files: File[] with all photographs that it names
 * @param report   called with the finished share, [0,1]; the work ends when it returns false
 * @return {Promise<object | null>}  path of the scene, files: Map of name to bytes with those of the scene, the normals
 *                 and the residual; residual: the name of the latter, text: what it comes to. null when it was ended
 */
export async function work({ light, files }, report, slice = kPageSlice) {
  const { default: create } = await import(new URL('lucent-readers.js', import.meta.url).href);
  const wasm = await create({ locateFile: (name) => new URL(name, import.meta.url).href });
  const text = (call, ...values) => wasm.UTF8ToString(callWasm(wasm, call, ...values));
  const begun = JSON.parse(text('stereo_begin', light.name, await bytesOf(light)));
  if (begun.error) throw new Error(begun.error);
  for (const [at, name] of begun.files.entries()) {
    const message = text('stereo_add', await bytesOf(fileNamed(name, files)));
    if (message) throw new Error(message);
    if (report((kReading * (at + 1)) / begun.files.length) === false) return null;
  }
  const step = (ms) => kReading + (1 - kReading) * callWasm(wasm, 'stereo_step', ms);
  if (!(await workThrough(step, report, slice))) return null;
  const summary = text('stereo_text');
  const title = text('reader_title', light.name);
  const { error, files: made } = JSON.parse(text('stereo_scene', title));
  if (error) throw new Error(error);
  const bytes = made.map(({ name, at, size }) => [name, wasm.HEAPU8.slice(at, at + size)]);
  return { path: made[0].name, files: new Map(bytes), residual: `${title}_residual.png`, text: summary };
}

answerRequests(work, ({ files }) => [...files.values()].map(({ buffer }) => buffer));
