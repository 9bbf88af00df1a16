/** What a module that is started as a worker does. */
import { nextTask } from './task.js';

/**
 * Answers the requests that such a worker gets, each with its number; on a page nothing happens.
 * @param work       (request, report, slice) => promise of the result, null when report() returned false
 * @param transfers  (result) => the buffers in it
 */
export function answerRequests(work, transfers) {
  if (typeof WorkerGlobalScope === 'undefined' || !(self instanceof WorkerGlobalScope)) return;
  const kSlice = 100; // ms
  addEventListener('message', async ({ data: { number, request } }) => {
    try {
      const result = await work(request, (share) => postMessage({ number, share }), kSlice);
      postMessage({ number, result }, transfers(result));
    } catch ({ message, code }) {
      postMessage({ number, message, code });
    }
  });
}

/** Works through slices until all is done. @param step  (ms) => share. @return  false when report() ended it */
export async function workThrough(step, report, slice) {
  for (let share = 0; share < 1; ) {
    share = step(slice);
    if (report(share) === false) return false;
    await nextTask();
  }
  return true;
}

export const kPageSlice = 8; // ms that work on the page may take before it lets others in
