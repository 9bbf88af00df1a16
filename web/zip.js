/** Zip archives of scenes and of pictures. Fetched when one is opened or made; the browser's own streams pack. */
import { BlobReader, BlobWriter, configure, ZipReader, ZipWriter } from '@zip.js/zip.js/lib/zip-core-custom.js';

configure({ useWebWorkers: false }); // its worker is a blob, which the page's policy forbids

const kMostFiles = 1000; // both as in the program: src/base/Archive.h
const kMostBytes = 2 ** 30;
const kPacked = /\.(png|jpe?g|exr|glb)$/i; // another time gains nothing

/** Neither absolute nor with a part "." or "..". */
const staysInside = (name) => !name.split('/').some((part) => ['', '.', '..'].includes(part));

/**
 * @param files    Map of name to Blob
 * @param signal   AbortSignal that ends it
 * @return {Promise<Blob>}
 */
export async function packZip(files, signal) {
  const zip = new ZipWriter(new BlobWriter('application/zip'), { signal, extendedTimestamp: false });
  for (const [name, blob] of files) await zip.add(name, new BlobReader(blob), { level: kPacked.test(name) ? 0 : 6 });
  return zip.close();
}

/** Files of an archive; each is unpacked when it is asked for. */
class Archive {
  #name;
  #entries;
  constructor(name, entries) {
    this.#name = name;
    this.#entries = entries;
  }

  /** "scene.json", else the only .json that lies in no folder. */
  get scene() {
    if (this.#entries.has('scene.json')) return 'scene.json';
    const scenes = [...this.#entries.keys()].filter((name) => /^[^/]*\.json$/.test(name));
    if (scenes.length === 1) return scenes[0];
    const found = scenes.length ? `${scenes.length} .json files` : 'no scene';
    throw new Error(`${this.#name}: has ${found}; must have scene.json, or one .json file`);
  }

  /** The bytes of a file, no more than the archive says; the checksum is compared. */
  async read(name) {
    const where = `${this.#name}/${name}`;
    const entry = this.#entries.get(name);
    if (!entry) throw new Error(`${where}: is not in the archive; must be`);
    if (entry.encrypted) throw new Error(`${where}: is encrypted; must be a plain file`);
    const bytes = [];
    let size = 0;
    const keep = (chunk) => {
      size += chunk.length;
      if (size > entry.uncompressedSize)
        throw new Error(`unpacks to more than the ${entry.uncompressedSize} bytes that the archive says`);
      bytes.push(chunk);
    };
    try {
      await entry.getData(new WritableStream({ write: keep }), { checkCrc32: true, checkOverlappingEntry: true });
    } catch ({ message }) {
      throw new Error(`${where}: cannot be read (${message}); must be undamaged`);
    }
    return new Uint8Array(await new Blob(bytes).arrayBuffer());
  }
}

/**
 * Opens an archive. Rejects, before anything is unpacked, where it is none, has a name twice or one that leads outside,
 * or says that it unpacks to more than 1 GiB or 1000 files.
 * @return {Promise<Archive>}
 */
export async function openZip(name, blob) {
  let list;
  try {
    list = await new ZipReader(new BlobReader(blob)).getEntries({ filenameValidation: 'tolerant' });
  } catch ({ message }) {
    throw new Error(`${name}: cannot be read (${message}); must be a zip archive`);
  }
  if (list.length > kMostFiles) throw new Error(`${name}: has ${list.length} files; must have at most ${kMostFiles}`);
  const entries = new Map();
  let total = 0;
  for (const entry of list) {
    const { filename, directory, uncompressedSize } = entry;
    const file = JSON.stringify(filename);
    if (!staysInside(directory ? filename.replace(/\/$/, '') : filename))
      throw new Error(`${name}: has a file ${file}, which leads outside; must lie in it`);
    if ((total += uncompressedSize) > kMostBytes)
      throw new Error(`${name}: unpacks to more than 1 GiB with ${file}; must be at most that`);
    if (entries.has(filename)) throw new Error(`${name}: has two files ${file}; must have one of a name`);
    if (!directory) entries.set(filename, entry);
  }
  return new Archive(name, entries);
}
