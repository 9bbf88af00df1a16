/** Brings files to the module: scenes with everything they name, in a form that it reads. */
import { Service } from './job.js';
import { LucentError } from './runtime.js';
import { nextTask } from './task.js';

const kForeign = /\.(exr|tiff?|glb|gltf|obj)$/i;
// Keys that make a material another kind than relief,
const kKinds = ['kind', 'reflectance', 'transmission', 'scattering', 'preset'];
// and keys of "technique" that the module of reliefs knows.
const kReliefSettings = ['relief', 'sampling'];

/** An address as seen from another; undefined where there is none. */
function addressOf(name, from) {
  try {
    return new URL(name, from);
  } catch {
    return undefined;
  }
}

/**
 * How far a scene reaches: to what lies beneath its own folder, or beneath a folder that the page allows.
 *
 * @param url      of the scene
 * @param allowed  addresses of folders
 */
export class Reach {
  #folders;
  constructor(url, allowed = []) {
    this.#folders = [url, ...allowed].flatMap((one) => addressOf('.', one)?.href ?? []); // blob: has no folder
  }

  /** The address of a file. Throws a LucentError when it lies outside. @param from  address of the file that names it */
  find(name, from) {
    const address = addressOf(name, from);
    if (address && this.#holds(address)) return address;
    const folder = this.#folders[0] ?? 'the scene';
    throw new LucentError(
      'scene',
      `${name}: lies outside ${folder}; must lie beneath it, or beneath an address that allow names`,
    );
  }
  /** What was fetched may come from elsewhere than was asked. */
  check({ redirected, url }) {
    if (redirected) this.find(url, url);
  }

  // A browser takes .. and %2e out of an address; a server may take %2f for a slash.
  #holds({ protocol, href, pathname }) {
    if (protocol === 'data:') return true;
    return !/%2f|%5c/i.test(pathname) && this.#folders.some((folder) => href.startsWith(folder));
  }
}

/** What is fetched for one scene: how far it is, of what servers have announced, and an end to it. */
export class Fetching {
  #report;
  #signal;
  #announced = 0; // bytes
  #came = 0;

  /** @param report  (share) is called as bytes come; it falls where more is announced. @param signal  AbortSignal */
  constructor(report, signal) {
    this.#report = report;
    this.#signal = signal;
  }

  fetch(url) {
    return fetch(url, { signal: this.#signal });
  }
  /** The bytes of an answer. */
  async take({ body, headers }) {
    const length = Number(headers.get('content-length')); // of what is packed less than comes
    this.#announced += length;
    const parts = [];
    let [size, came] = [0, 0];
    for (const reader = body.getReader(); ; ) {
      const { done, value } = await reader.read();
      if (done) break;
      parts.push(value);
      size += value.length;
      this.#count(Math.min(value.length, length - came));
      came = Math.min(length, came + value.length);
    }
    this.#count(length - came);
    const bytes = new Uint8Array(size);
    parts.reduce((at, part) => (bytes.set(part, at), at + part.length), 0);
    return bytes;
  }

  #count(bytes) {
    this.#came += bytes;
    if (this.#announced) this.#report(this.#came / this.#announced);
  }
}

/**
 * @param reach     of the scene that names the file; none where the page itself does
 * @param fetching  of that scene
 */
async function fetchBytes(url, name, reach, fetching = new Fetching(() => {})) {
  let response;
  try {
    response = await fetching.fetch(url);
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new LucentError(
      'fetch',
      `${name}: cannot be fetched from ${url.origin}; must be a file that this page may read`,
    );
  }
  if (!response.ok) throw new LucentError('fetch', `${name}: the server answers ${response.status}; must be there`);
  reach?.check(response);
  return fetching.take(response);
}

const kReading = new URL('lucent-reading.js', import.meta.url).href;
/** The second module, fetched when first needed: see reading.js. */
export const reading = new Service(kReading);

const kPicture = /\.(png|jpe?g)$/i;
const kLeastApart = 65536; // bytes of a picture: less is decoded in less than a frame's time
const kMostApart = 255;

/** Pictures of a mesh, decoded side by side apart from it. */
class Pictures {
  static #services = [reading, new Service(kReading)];
  /** By the numbers that stand for them in the mesh. */
  texels = new Map();

  /** What stands for a picture in the mesh: itself where decoding it apart is not worth it, or not possible. */
  async take(bytes) {
    const number = this.texels.size;
    if (bytes.length < kLeastApart || number > kMostApart) return bytes;
    this.texels.set(number, undefined);
    const service = Pictures.#services[number % Pictures.#services.length];
    const made = await service.ask({ task: 'texels', name: 'picture', bytes, number });
    if (!made) return bytes; // and the mesh's reader says what is wrong with it
    this.texels.set(number, made.files.get('texels'));
    return made.files.get('standIn');
  }
  /** The same of one that lies in its mesh's file, written over it there. */
  async takeInside({ at, size }, file) {
    file.set(await this.take(file.slice(at, at + size)), at);
  }
}

/**
 * A file in a form that the loader reads: glTF, OBJ, EXR and TIFF are converted, everything else stays as it is.
 * @param part      (name) => promise of the bytes of a file beside it that it names, undefined when there is none
 * @param pictures  where the texels of its pictures go; none: they go into the file itself
 * @return {Promise<{name: string, bytes: Uint8Array}>}  under the name that such files have
 */
export async function toPlain(name, bytes, part, pictures) {
  if (!kForeign.test(name)) return { name, bytes };
  const needs = await reading.ask({ task: 'needs', name, bytes });
  if (!needs) return { name, bytes };
  const parts = new Map([[name, bytes]]);
  const take = (need) => ('at' in need ? pictures?.takeInside(need, bytes) : collectPart(need, part, parts, pictures));
  await Promise.all(needs.map(take));
  return reading.ask({ task: 'convert', name, parts });
}

/** Adds a file that another one needs, and what that file needs itself, to `parts`. */
async function collectPart({ file, optional }, part, parts, pictures) {
  const content = await part(file).catch((error) => {
    if (!optional || error.name === 'AbortError') throw error;
  });
  if (!content) return;
  parts.set(file, pictures && kPicture.test(file) ? await pictures.take(content) : content);
  if (!/\.mtl$/i.test(file)) return;
  const textures = await reading.ask({ task: 'needs', name: file, bytes: content });
  const beside = textures.map((one) => ({ ...one, file: besideFile(file, one.file) }));
  await Promise.all(beside.map((one) => collectPart(one, part, parts, pictures)));
}

/** Linear values as EXR. @param picture  width, height and bytes of 4 floats a pixel @return {Promise<Blob>} */
export async function encodeExr(picture) {
  const { bytes } = await reading.ask({ task: 'exr', name: 'picture', ...picture });
  return new Blob([bytes], { type: 'image/x-exr' });
}

/** The name of a file that another one names, as seen from where that one's own name is. */
const besideFile = (from, name) => (from.includes('/') ? from.slice(0, from.lastIndexOf('/') + 1) : '') + name;

/** A file among those that a person opened together: by its whole name, else by the last part of it. */
async function among(files, name) {
  const last = (path) => path.split('/').pop();
  const file = files.find((one) => one.name === name) ?? files.find((one) => last(one.name) === last(name));
  return file && new Uint8Array(await file.arrayBuffer());
}

const fileName = (url) => decodeURIComponent(url.pathname.split('/').pop());

/** Whether a scene asks for more than the module of reliefs draws. Of what is no scene that module says what is wrong. */
export function needsWhole(bytes) {
  const isRelief = ({ shape, material = {} }) =>
    shape.type === 'heightfield' && (material.kind === 'relief' || !kKinds.some((key) => key in material));
  try {
    const { objects, technique = {} } = JSON.parse(new TextDecoder().decode(bytes));
    return !objects.every(isRelief) || Object.keys(technique).some((name) => !kReliefSettings.includes(name));
  } catch {
    return false;
  }
}

/**
 * A file in the plain form, the texels of its pictures, and what was read for it: '' itself, and its parts by the
 * names that it has for them.
 * @param read  (name, part) => promise of the bytes of such a part
 */
async function readSource(name, read) {
  const source = new Map();
  const take = async (part) => {
    const bytes = await read(name, part);
    if (bytes) source.set(part, new Blob([bytes]));
    return bytes;
  };
  const pictures = new Pictures();
  const { bytes } = await toPlain(name, await take(''), take, pictures);
  return { source, bytes, texels: pictures.texels };
}

/**
 * Collects what a scene needs.
 * @param start  (whole) => promise of the runtime that draws it
 * @param path   name of the scene file, whose content is `scene`
 * @param read   see readSource()
 * @return {Promise<object>}  path; files, all in the plain form by name; whole, whether it needs the whole module;
 *                            sources, by name what was read for each
 */
async function collect(start, path, scene, read) {
  const whole = needsWhole(scene);
  const runtime = await start(whole);
  const names = namesIn(runtime, path, scene);
  const files = new Map([[path, scene]]);
  const sources = new Map();
  const all = await Promise.all(names.map((name) => readSource(name, read)));
  all.forEach(({ source, bytes, texels }, at) => {
    files.set(names[at], bytes);
    for (const [number, of] of texels) if (of) files.set(`${names[at]}#${number}`, of);
    sources.set(names[at], source);
  });
  return { path, files, whole, sources };
}

/** Files that a scene names, as seen from `path`. */
export function namesIn(runtime, path, scene) {
  runtime.put(path, scene);
  const { files, error } = runtime.json('scene_dependencies', path);
  runtime.call('file_forget', path);
  if (error) throw new LucentError('scene', error);
  return files;
}

const isZip = ([a, b]) => a === 0x50 && b === 0x4b; // PK

/** A scene in an archive, whose files lie in it too. */
async function collectZip(start, name, blob) {
  const { openZip } = await loadZip();
  try {
    const archive = await openZip(name, blob);
    const read = (file, part) => archive.read(part ? besideFile(file, part) : file);
    return await collect(start, archive.scene, await read(archive.scene), read);
  } catch (error) {
    throw error instanceof LucentError ? error : new LucentError('file', error.message);
  }
}

/** The module of archives, fetched when the first is opened or made. */
export const loadZip = () =>
  import('./zip.js').catch(({ message }) => {
    throw new LucentError('fetch', `zip.js: ${message}; it must lie beside the script`);
  });

/**
 * Fetches a scene and every file it names, or an archive of both. See collect().
 * @param allowed   addresses of folders beneath which files may lie, beside the scene's own
 * @param fetching  Fetching, which says how far that is. Rejects with an AbortError where its signal ends it
 */
export async function fetchScene(start, url, allowed, fetching) {
  const path = fileName(url) || url.href;
  const scene = await fetchBytes(url, path, undefined, fetching);
  if (isZip(scene)) return collectZip(start, path, new Blob([scene]));
  const reach = new Reach(url, allowed);
  return collect(start, path, scene, async (name, part) => {
    const address = reach.find(name, url);
    return fetchBytes(part ? reach.find(part, address) : address, part || name, reach, fetching);
  });
}

/**
 * A scene that a person opened: an archive, or a scene file among the files that it names. See collect().
 * @param files  File objects, of which one is a scene
 */
export async function openScene(start, files) {
  const main = sceneAmong(files);
  if (isArchive(main)) return collectZip(start, main.name, main);
  return collect(start, main.name, new Uint8Array(await main.arrayBuffer()), async (name, part) => {
    const bytes = await among(files, part ? besideFile(name, part) : name);
    if (bytes || part) return bytes;
    throw new LucentError(
      'file',
      `${main.name}: names ${name}, which was not opened with it; must be opened together with all that it names`,
    );
  });
}

/**
 * Gives fetched files to the module for one load, which ends where another of the same viewer begins. Throws a
 * LucentError. @return  the scene's sources: see collect(); the files themselves where nobody says them
 */
export async function loadFiles({ runtime, handle }, { path, files, sources }) {
  for (const [name, bytes] of files) runtime.put(name, bytes);
  const load = runtime.call('viewer_load', handle, path);
  do await nextTask();
  while (runtime.call('viewer_load_on', handle, load));
  const message = runtime.text('viewer_load_error', handle);
  if (message) throw new LucentError('scene', message);
  return sources ?? sourcesOf([...files].filter(([name]) => name !== path));
}

/** Sources of files that need no others. @param files  [name, bytes] of each */
export const sourcesOf = (files) => new Map(files.map(([name, bytes]) => [name, new Map([['', new Blob([bytes])]])]));

/** The name and the bytes of one picture, in a form that the module reads. */
export async function fetchPicture(url) {
  const name = fileName(url);
  return { ...(await toPlain(name, await fetchBytes(url, name))), name };
}
const isArchive = ({ name }) => /\.zip$/i.test(name);
/** An archive of a scene, or a scene file. */
const isScene = ({ name }) => /\.(zip|json)$/i.test(name);

/** Of files that a person opened together the scene; undefined where they are none. */
export const sceneAmong = (files) =>
  [isArchive, ({ name }) => name === 'scene.json', isScene].map((is) => files.find(is)).find(Boolean);

/** `name`, or with a number where it is taken. @param taken  has() says what is */
export function freeName(name, taken) {
  const [stem, ending] = name.split(/(?=\.[^.]*$)/);
  let free = name;
  for (let number = 2; taken.has(free); ++number) free = `${stem}-${number}${ending ?? ''}`;
  return free;
}

const kTexts = ['title', 'caption', 'name', 'part']; // of a scene that are no files' names

/** A name that stays in an archive: beneath its top, without parts "." or "..". */
function nameInside(name, taken) {
  const stays = !/^[a-z]+:|[?#\\]/i.test(name) && !name.split('/').some((part) => ['', '.', '..'].includes(part));
  return freeName(stays ? name : decodeURIComponent(name.replace(/[?#].*/, '').split('/').pop()) || 'file', taken);
}

/**
 * A scene with all its files as an archive holds them: "scene.json", and what it names.
 * @param json     the scene
 * @param sources  see collect()
 * @return {Map<string, Blob>}
 */
export function filesOfScene(runtime, json, sources) {
  const files = new Map([['scene.json', undefined]]);
  const renamed = new Map();
  for (const name of namesIn(runtime, 'scene.json', new TextEncoder().encode(json))) {
    const source = sources.get(name);
    if (!source) throw new LucentError('file', `${name}: its content is not at hand; must be opened again`);
    const inside = nameInside(name, files);
    if (inside !== name) renamed.set(name, inside);
    for (const [part, blob] of source) files.set(part ? besideFile(inside, part) : inside, blob);
  }
  const rename = (key, value) => (kTexts.includes(key) ? value : (renamed.get(value) ?? value));
  const text = renamed.size ? JSON.stringify(JSON.parse(json), rename, 2) : json;
  return files.set('scene.json', new Blob([text], { type: 'application/json' }));
}
