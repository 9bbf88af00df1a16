/**
 * Computes the exact picture of a scene with the third module. Pages start this file as a worker; where they cannot,
 * they import it and the work is done on the page, in short slices.
 */
import createTruth from 'lucent-truth-wasm'; // the build names the file
import { answerRequests, kPageSlice, workThrough } from './answering.js';
import { callWasm, putFile } from './wasm.js';

/**
 * @param request  files: Map of name to bytes with "scene.json", width, height, samples
 * @param report   called with the finished share, [0,1]; the work ends when it returns false
 * @return {Promise<{pixels: Float32Array, noise: number} | null>}  4 floats a pixel; null when it was ended
 */
export async function work({ files, width, height, samples }, report, slice = kPageSlice) {
  const wasm = await createTruth({ locateFile: (name) => new URL(name, import.meta.url).href });
  for (const [name, bytes] of files) putFile(wasm, 'truth_file_space', name, bytes);
  const message = wasm.UTF8ToString(callWasm(wasm, 'truth_start', width, height, samples));
  if (message) throw new Error(message);
  if (!(await workThrough((ms) => callWasm(wasm, 'truth_step', ms), report, slice))) return null;
  const start = callWasm(wasm, 'truth_pixels') / Float32Array.BYTES_PER_ELEMENT;
  const pixels = wasm.HEAPF32.slice(start, start + 4 * width * height);
  return { pixels, noise: callWasm(wasm, 'truth_noise') };
}

answerRequests(work, ({ pixels }) => [pixels.buffer]);
