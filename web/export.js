/**
 * Pictures at sizes of their own and sequences of them, drawn by a viewer without an element beside what the page shows.
 * Fetched when one is asked for.
 */
import { nextTask } from './task.js';

const kSwing = 50; // degrees to each side: from farther aside a relief shows little
const kBitsPerPixel = 0.4; // of a frame of video
const kTurn = 360; // degrees

// ---- vectors: arrays of 3

const sum = (a, b) => a.map((value, axis) => value + b[axis]);
const difference = (a, b) => a.map((value, axis) => value - b[axis]);
const unit = (a) => a.map((value) => value / Math.hypot(...a));

/** A vector turned about an axis of length 1 (Rodrigues). */
function turned(a, axis, degrees) {
  const angle = (degrees * Math.PI) / 180;
  const [x, y, z] = axis;
  const across = [y * a[2] - z * a[1], z * a[0] - x * a[2], x * a[1] - y * a[0]];
  const along = axis.reduce((dot, value, at) => dot + value * a[at], 0) * (1 - Math.cos(angle));
  return a.map((value, at) => value * Math.cos(angle) + across[at] * Math.sin(angle) + axis[at] * along);
}

const turnedAround = (place, middle, axis, degrees) => sum(middle, turned(difference(place, middle), axis, degrees));

// ---- drawing

/** A viewer that shows what another one shows now. */
class Offscreen {
  #runtime;
  #handle;
  #size;
  #picture; // the last that was drawn
  constructor({ runtime, handle, width, height }) {
    const most = runtime.largestSide;
    for (const side of [width, height])
      if (!(Number.isInteger(side) && side >= 1 && side <= most))
        throw new Error(`size: is ${width} x ${height}; must be whole pixels, each from 1 to ${most} on this device`);
    this.#runtime = runtime;
    this.#size = [width, height];
    this.#handle = runtime.copyOf(handle);
    runtime.call('viewer_resize', this.#handle, width, height, 1);
  }
  get(path) {
    return this.#runtime.text('viewer_get', this.#handle, path);
  }
  vector(path) {
    return this.get(path).split(' ').map(Number);
  }
  set(path, vector) {
    const message = this.#runtime.text('viewer_set', this.#handle, path, vector.join(' '));
    if (message) throw new Error(message);
  }

  /** Draws until the picture is finished, in slices. What nothing has changed since the last is not drawn again. */
  async draw(signal) {
    const [runtime, handle] = [this.#runtime, this.#handle];
    for (;;) {
      signal?.throwIfAborted();
      const { more, drawn } = runtime.draw(handle, ...this.#size, performance.now() / 1000);
      if (runtime.lost) throw new Error('picture: the graphics context was lost; a smaller one needs less memory');
      const failure = runtime.text('viewer_failure', handle);
      if (failure) throw new Error(`picture: ${failure}`);
      const { finished } = runtime.json('viewer_stats', handle);
      if (finished && drawn) this.#picture = runtime.copyPicture(); // lies there until the task ends
      if (finished && (drawn || (!more && this.#picture))) return;
      if (!more) throw new Error('picture: was not drawn to its end; a smaller one needs less memory');
      await nextTask();
    }
  }
  /** The picture that draw() has just left. @return {HTMLCanvasElement} */
  canvas() {
    const { width, height } = this.#picture;
    if (width === this.#size[0] && height === this.#size[1]) return this.#picture;
    throw new Error(`picture: is ${width} x ${height}; must be ${this.#size.join(' x ')}`);
  }
  linear() {
    return this.#runtime.linear(this.#handle);
  }
  close() {
    this.#runtime.drop(this.#handle);
  }
}

async function withOffscreen(studio, work) {
  const offscreen = new Offscreen(studio);
  try {
    return await work(offscreen);
  } finally {
    offscreen.close();
  }
}

async function encoded(canvas, type, quality) {
  const blob = await new Promise((done) => canvas.toBlob(done, type, quality));
  if (blob) return blob;
  throw new Error(`picture: ${canvas.width} x ${canvas.height} pixels cannot be encoded as ${type}; must be fewer`);
}

/**
 * @param studio   runtime, handle: of the viewer whose scene it is; width, height; scene: it as a scene file
 * @param options  see toBlob() of the element
 */
export function picture(studio, { type = 'image/png', quality, signal }) {
  return withOffscreen(studio, async (offscreen) => {
    await offscreen.draw(signal);
    return type === 'image/x-exr' ? studio.encodeExr(offscreen.linear()) : encoded(offscreen.canvas(), type, quality);
  });
}

// ---- paths

const isRelief = ({ objects }) =>
  objects.some(({ shape, material }) => shape.type === 'heightfield' && (material?.kind ?? 'relief') === 'relief');

/** Once around the target; of a relief, which has no back, to and fro. @return  share of the way => values */
function cameraPath(offscreen, scene) {
  const [eye, target] = [offscreen.vector('camera.eye'), offscreen.vector('camera.target')];
  const up = unit(offscreen.vector('camera.up'));
  const angle = isRelief(scene)
    ? (share) => kSwing * Math.sin(2 * Math.PI * share)
    : (share) => kTurn * share;
  return (share) => ({ 'camera.eye': turnedAround(eye, target, up, angle(share)) });
}

const kPlaces = ['position', 'corner'];
const kWays = ['direction', 'edgeU', 'edgeV'];

/** The first lamp once around what the camera looks at: over a relief in the plane of the picture, else level. */
function lampPath(offscreen, scene) {
  const [eye, target] = [offscreen.vector('camera.eye'), offscreen.vector('camera.target')];
  const axis = unit(isRelief(scene) ? difference(eye, target) : offscreen.vector('camera.up'));
  if (!scene.lights.length) return environmentPath(offscreen, scene);
  const had = (keys) => keys.map((key) => `lights.0.${key}`).filter((path) => offscreen.get(path) !== '');
  const start = new Map([...had(kPlaces), ...had(kWays)].map((path) => [path, offscreen.vector(path)]));
  return (share) => {
    const angle = kTurn * share;
    const places = had(kPlaces).map((path) => [path, turnedAround(start.get(path), target, axis, angle)]);
    const ways = had(kWays).map((path) => [path, turned(start.get(path), axis, angle)]);
    return Object.fromEntries([...places, ...ways]);
  };
}

function environmentPath(offscreen, scene) {
  if (!scene.environment) throw new Error('path: nothing shines in this scene; must have a lamp or an environment');
  const start = offscreen.vector('environment.rotation');
  const axis = isRelief(scene) ? 2 : 1;
  const within = (degrees) => ((degrees + 540) % 360) - 180;
  return (share) => ({
    'environment.rotation': start.map((value, at) => (at === axis ? within(value + kTurn * share) : value)),
  });
}

const kPaths = { camera: cameraPath, lamp: lampPath };

// ---- sequences

/** Draws all pictures as PNG files. */
async function drawAll(studio, { path, frames, signal, progress }) {
  return withOffscreen(studio, async (offscreen) => {
    const valuesAt = kPaths[path](offscreen, studio.scene);
    const pictures = [];
    for (let frame = 0; frame < frames; ++frame) {
      for (const [name, vector] of Object.entries(valuesAt(frame / frames))) offscreen.set(name, vector);
      await offscreen.draw(signal);
      pictures.push(await encoded(offscreen.canvas(), 'image/png'));
      progress?.((frame + 1) / frames);
    }
    return pictures;
  });
}

/** Plays the pictures on a canvas, which the browser records. It takes as long as the video. */
async function record(pictures, { width, height, fps, signal }) {
  const canvas = Object.assign(document.createElement('canvas'), { width, height });
  const sheet = canvas.getContext('2d');
  const stream = canvas.captureStream(0);
  const [track] = stream.getVideoTracks();
  const recorder = new MediaRecorder(stream, {
    mimeType: 'video/webm',
    videoBitsPerSecond: Math.round(kBitsPerPixel * width * height * fps),
  });
  const parts = [];
  recorder.addEventListener('dataavailable', ({ data }) => parts.push(data));
  const ended = new Promise((done, failed) => {
    recorder.addEventListener('stop', done);
    recorder.addEventListener('error', ({ error }) => failed(error ?? new Error('video: cannot be recorded here')));
  });
  recorder.start();
  try {
    const start = performance.now();
    for (const [number, picture] of pictures.entries()) {
      signal?.throwIfAborted();
      const bitmap = await createImageBitmap(picture);
      sheet.drawImage(bitmap, 0, 0);
      bitmap.close();
      track.requestFrame();
      const left = start + ((number + 1) * 1000) / fps - performance.now();
      await new Promise((done) => setTimeout(done, Math.max(0, left)));
    }
  } finally {
    if (recorder.state !== 'inactive') recorder.stop();
  }
  await ended;
  return new Blob(parts, { type: 'video/webm' });
}

/** @param options  see toSequence() of the element */
export async function sequence(studio, options) {
  const { path, frames, type = 'application/zip', name = 'picture', fps = 30, signal } = options;
  if (!kPaths[path]) throw new Error(`path: is "${path}"; must be camera or lamp`);
  if (!(Number.isInteger(frames) && frames >= 1 && frames <= 9999))
    throw new Error(`frames: is ${frames}; must be a whole number from 1 to 9999`);
  if (!['application/zip', 'video/webm'].includes(type))
    throw new Error(`type: is "${type}"; must be application/zip or video/webm`);
  const pictures = await drawAll(studio, options);
  if (type === 'video/webm') return record(pictures, { ...studio, fps, signal });
  const numbered = pictures.map((blob, at) => [`${name}-${String(at + 1).padStart(4, '0')}.png`, blob]);
  const { packZip } = await studio.loadZip();
  return packZip(new Map(numbered), signal);
}
