/**
 * Computes the exact picture of a scene with the third module. Pages start this file as a worker; where they cannot,
 * they import it and the work is done on the page, in short slices.
 */
import createTruth from 'lucent-truth-wasm'; // the build names the file
import { callWasm } from './wasm.js';

const kSlice = { worker: 100, page: 8 }; // ms

/**
 * @param request  files: Map of name to bytes with "scene.json", width, height, samples
 * @param report   called with the finished share, [0,1]; the work ends when it returns false
 * @return {Promise<{pixels: Float32Array, noise: number} | null>}  4 floats a pixel; null when it was ended
 */
export async function computeTruth({ files, width, height, samples }, report, slice = kSlice.page) {
  const wasm = await createTruth({ locateFile: (name) => new URL(name, import.meta.url).href });
  for (const [name, bytes] of files) callWasm(wasm, 'truth_file_put', name, bytes);
  const message = wasm.UTF8ToString(callWasm(wasm, 'truth_start', width, height, samples));
  if (message) throw new Error(message);
  for (let share = 0; share < 1; ) {
    share = callWasm(wasm, 'truth_step', slice);
    if (report(share) === false) return null;
    await new Promise((done) => setTimeout(done));
  }
  const start = callWasm(wasm, 'truth_pixels') / Float32Array.BYTES_PER_ELEMENT;
  const pixels = wasm.HEAPF32.slice(start, start + 4 * width * height);
  return { pixels, noise: callWasm(wasm, 'truth_noise') };
}

async function answer({ data }) {
  try {
    const truth = await computeTruth(data, (share) => postMessage({ share }), kSlice.worker);
    postMessage({ truth }, [truth.pixels.buffer]);
  } catch (error) {
    postMessage({ message: error.message });
  }
}

if (typeof WorkerGlobalScope !== 'undefined' && self instanceof WorkerGlobalScope) addEventListener('message', answer);
