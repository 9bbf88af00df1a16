/** Work in a worker; where a page may start none, on the page. */
import { LucentError } from './runtime.js';

class NoWorker extends Error {}

const cancelled = () => new DOMException('cancelled', 'AbortError');

/** A worker that answers several requests, told apart by numbers: see answerRequests(). */
class Answering {
  #worker;
  #asked = new Map(); // by number: {done, failed, report}
  #count = 0;

  constructor(address) {
    try {
      this.#worker = new Worker(address, { type: 'module' });
    } catch (error) {
      throw new NoWorker(error.message); // a sandboxed frame, a script from another site
    }
    this.#worker.addEventListener('message', ({ data }) => this.#take(data));
    this.#worker.addEventListener('error', ({ message }) => this.end(new NoWorker(message ?? 'it cannot be loaded')));
  }

  ask(request, report) {
    const number = ++this.#count;
    return new Promise((done, failed) => {
      this.#asked.set(number, { done, failed, report });
      this.#worker.postMessage({ number, request });
    });
  }
  /** @param error  what becomes of what was asked and not answered */
  end(error) {
    this.#worker.terminate();
    for (const { failed } of this.#asked.values()) failed(error);
    this.#asked.clear();
  }

  #take({ number, share, result, message, code = 'scene' }) {
    const { done, failed, report } = this.#asked.get(number) ?? {};
    if (share !== undefined) return report?.(share);
    this.#asked.delete(number);
    if (message === undefined) done?.(result);
    else failed?.(new LucentError(code, message));
  }
}

async function runInWorker(address, request, report, signal) {
  const worker = new Answering(address);
  signal.addEventListener('abort', () => worker.end(cancelled()));
  try {
    return await worker.ask(request, report);
  } finally {
    worker.end(cancelled());
  }
}

async function runOnPage(address, request, report, signal) {
  const { work } = await import(address);
  const result = await work(request, (share) => (report(share), !signal.aborted));
  if (!result) throw cancelled();
  return result;
}

/**
 * Long work with progress and cancel.
 * @param address  of a module that answers as answerRequests() lets it, and exports the same `work`
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

/** Short work, whose worker stays for what comes next. */
export class Service {
  #address;
  #worker; // Answering; null: the page may start none

  /** @param address  as runJob() takes it */
  constructor(address) {
    this.#address = address;
  }

  /** Rejects with a LucentError. */
  async ask(request) {
    try {
      if (this.#worker !== null) return await (this.#worker ??= new Answering(this.#address)).ask(request);
    } catch (error) {
      if (!(error instanceof NoWorker)) throw error;
      this.#worker = null;
    }
    const { work } = await import(this.#address).catch(({ message }) => {
      throw new LucentError('fetch', `${this.#address}: ${message}; it must lie beside the script`);
    });
    return work(request).catch(({ message, code = 'scene' }) => {
      throw new LucentError(code, message);
    });
  }
}

/** "25 %, 12 s left"; without the time while little is known about it. @param start  performance.now() then */
export function progressText(share, start) {
  const left = Math.ceil(((performance.now() - start) / 1000) * (1 / share - 1));
  return `${Math.floor(100 * share)} %${share > 0.02 ? `, ${left} s left` : ''}`;
}
