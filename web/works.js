/**
 * What a person has made, kept in the browser (IndexedDB). A file is written once; the scene, which is small, at every
 * change. Every call rejects where the browser keeps nothing for this page, as in some private windows.
 */
const kMostWorks = 3; // the oldest goes
const kMostBytes = 512 * 2 ** 20; // of the files of one
const kStores = ['works', 'files'];

const lockOf = (id) => `lucent work ${id}`; // held by the tab that shows it

const resultOf = (request) =>
  new Promise((done, failed) => {
    request.onsuccess = () => done(request.result);
    request.onerror = () => failed(request.error);
  });

export class Works {
  #opened; // promise of the database
  #keys = new WeakMap(); // Blob -> its key in "files"

  #database() {
    this.#opened ??= new Promise((done, failed) => {
      const request = indexedDB.open('lucent', 1); // throws in a frame without an origin
      request.onupgradeneeded = () => kStores.forEach((name) => request.result.createObjectStore(name));
      request.onsuccess = () => done(request.result);
      request.onerror = () => failed(request.error);
    });
    return this.#opened;
  }

  async #stores(mode) {
    const transaction = (await this.#database()).transaction(kStores, mode);
    const ended = new Promise((done, failed) => {
      transaction.oncomplete = done;
      transaction.onabort = () => failed(transaction.error ?? new Error('the browser ended it'));
    });
    const [works, files] = kStores.map((name) => transaction.objectStore(name));
    return { works, files, ended, commit: () => transaction.commit?.() };
  }

  /**
   * @param work   id, title, and what else is to come back with get()
   * @param files  Map of name to Blob; those that were put before are not written again
   */
  async put(work, files) {
    const bytes = [...files.values()].reduce((sum, { size }) => sum + size, 0);
    if (bytes > kMostBytes)
      throw new Error(`${Math.ceil(bytes / 2 ** 20)} MiB are more than the ${kMostBytes / 2 ** 20} that the page keeps`);
    const stores = await this.#stores('readwrite');
    const keys = [...files].map(([name, blob]) => [name, this.#put(stores.files, blob)]);
    stores.works.put({ ...work, files: keys, when: Date.now() }, work.id);
    stores.commit(); // or it would be dropped where the page goes now
    await stores.ended;
    await this.#tidy(work.id, files);
  }

  #put(store, blob) {
    let key = this.#keys.get(blob);
    if (key) return key;
    this.#keys.set(blob, (key = crypto.randomUUID()));
    store.put(blob, key);
    return key;
  }

  /** The work, with `files`: Map of name to File; undefined where it is not there any more. */
  async get(id) {
    const { works, files } = await this.#stores('readonly');
    const work = await resultOf(works.get(id));
    if (!work) return undefined;
    const blobs = await Promise.all(work.files.map(([, key]) => resultOf(files.get(key))));
    const named = work.files.map(([name], at) => [name, new File([blobs[at]], name)]);
    return { ...work, files: new Map(named) };
  }

  /** The newest work that was not put aside and no other tab shows, without its files; undefined where there is none. */
  async newest() {
    const { works } = await this.#stores('readonly');
    const all = await resultOf(works.getAll());
    const shown = (await navigator.locks?.query())?.held.map(({ name }) => name) ?? [];
    return all
      .filter(({ id, aside }) => !aside && !shown.includes(lockOf(id)))
      .sort((one, other) => other.when - one.when)[0];
  }

  #mine; // id of the work whose lock this tab holds
  #release = () => {};
  /** Makes a work this tab's until the next one is. @return {Promise<boolean>}  false where another tab has it */
  take(id) {
    if (id === this.#mine || !navigator.locks) return Promise.resolve(true); // pages that are not secure have none
    this.#release();
    this.#mine = id;
    return new Promise((done) =>
      navigator.locks.request(lockOf(id), { ifAvailable: true }, (lock) => {
        done(lock !== null);
        if (lock) return new Promise((release) => (this.#release = release));
        this.#mine = undefined;
      }),
    );
  }

  /** Changes what is noted of a work. */
  async note(id, values) {
    const { works, ended } = await this.#stores('readwrite');
    const work = await resultOf(works.get(id));
    if (work) works.put({ ...work, ...values }, id);
    await ended;
  }

  async remove(id) {
    const { works, ended } = await this.#stores('readwrite');
    works.delete(id);
    await ended;
    await this.#tidy();
  }

  // Works beyond the number that is kept go, and files that no work names.
  // @param id     of the work that stays in any case
  // @param mine   its files: what another tab has taken away is put back
  async #tidy(id, mine = new Map()) {
    const { works, files, ended } = await this.#stores('readwrite');
    const all = (await resultOf(works.getAll())).sort((one, other) => other.when - one.when);
    const kept = all.filter((work, at) => at < kMostWorks || work.id === id);
    for (const work of all) if (!kept.includes(work)) works.delete(work.id);
    const used = new Set(kept.flatMap((work) => work.files.map(([, key]) => key)));
    const there = await resultOf(files.getAllKeys());
    for (const key of there) if (!used.has(key)) files.delete(key);
    for (const blob of mine.values()) if (!there.includes(this.#keys.get(blob))) files.put(blob, this.#keys.get(blob));
    await ended;
  }
}
