/** Long work in a worker, with progress and cancel; where a page may start none, on the page in slices. */
import { LucentError } from './runtime.js';

class NoWorker extends Error {}

const cancelled = () => new DOMException('cancelled', 'AbortError');

function runInWorker(address, request, report, signal) {
  let worker;
  try {
    worker = new Worker(address, { type: 'module' });
  } catch (error) {
    throw new NoWorker(error.message); // a sandboxed frame, a script from another site
  }
  return new Promise((done, failed) => {
    const end = (settle, value) => {
      worker.terminate();
      settle(value);
    };
    signal.addEventListener('abort', () => end(failed, cancelled()));
    worker.addEventListener('error', ({ message }) => end(failed, new NoWorker(message ?? 'it cannot be loaded')));
    worker.addEventListener('message', ({ data: { share, result, message } }) => {
      if (result) end(done, result);
      else if (message) end(failed, new LucentError('scene', message));
      else report(share);
    });
    worker.postMessage(request);
  });
}

async function runOnPage(address, request, report, signal) {
  const { work } = await import(address);
  const result = await work(request, (share) => (report(share), !signal.aborted));
  if (!result) throw cancelled();
  return result;
}

/**
 * @param address  of a module that answers as answerRequests() below lets it, and exports the same `work`
 * @param report   (share, isOnPage) is called while it works
 * @return         promise of what it comes to; rejects with an AbortError when the signal ends it
 */
export async function runJob(address, request, report, signal) {
  try {
    return await runInWorker(address, request, (share) => report(share, false), signal);
  } catch (error) {
    if (!(error instanceof NoWorker)) throw error;
    return runOnPage(address, request, (share) => report(share, true), signal);
  }
}

/** "25 %, 12 s left"; without the time while little is known about it. @param start  performance.now() then */
export function progressText(share, start) {
  const left = Math.ceil(((performance.now() - start) / 1000) * (1 / share - 1));
  return `${Math.floor(100 * share)} %${share > 0.02 ? `, ${left} s left` : ''}`;
}
