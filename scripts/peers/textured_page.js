/**
 * Runs in a page: a ring with four pictures by three.js and by Lucent; window.compare() times both and measures how
 * much light they misplace. window.picturesOf() paints the pictures.
 */
import * as THREE from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { Lucent, combinations, fetchBytes, fetchPfm, least, makeCanvas, spreadOf, timeInTurn, waitFor } from './page.js';

const kReach = 0.55; // m from the ring's middle, a little more than its own

/** Waves that go on from picture to picture, in [0,1]. */
const wave = (u, v, a, b, phase = 0) => 0.5 + 0.5 * Math.sin(2 * Math.PI * (a * u + b * v) + phase);

const kPaint = {
  color: (u, v) => [0.35 + 0.6 * wave(u, v, 9, 2), 0.3 + 0.5 * wave(u, v, -4, 7), 0.25 + 0.4 * wave(u, v, 3, 11)],
  metal: (u, v) => [0, 0.35 + 0.6 * wave(u, v, 5, -3), wave(u, v, 2, 1) > 0.6 ? 1 : 0],
  normal: (u, v) => {
    const [x, y] = [0.25 * Math.cos(2 * Math.PI * 16 * u), 0.25 * Math.cos(2 * Math.PI * 12 * v)];
    return [0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.5 * Math.sqrt(1 - x * x - y * y)];
  },
  emissive: (u, v) => Array(3).fill(wave(u, v, 6, 6) > 0.97 ? 0.5 : 0),
};

/** JPEG files as base64. */
window.picturesOf = async (side) => {
  const pictures = {};
  for (const [name, paint] of Object.entries(kPaint)) {
    const canvas = makeCanvas(side);
    const context = canvas.getContext('2d');
    const image = context.createImageData(side, side);
    for (let y = 0; y < side; ++y)
      for (let x = 0; x < side; ++x) {
        const color = paint((x + 0.5) / side, (y + 0.5) / side).map((value) => Math.round(255 * value));
        image.data.set([...color, 255], 4 * (y * side + x));
      }
    context.putImageData(image, 0, 0);
    pictures[name] = canvas.toDataURL('image/jpeg', 0.98).split(',')[1];
  }
  return pictures;
};

const readModel = async (name) => (await new GLTFLoader().loadAsync(`peers/${name}.gltf`)).scene;

class Three {
  constructor(size, scene, model) {
    this.size = size;
    this.renderer = new THREE.WebGLRenderer({ canvas: makeCanvas(size), antialias: false });
    this.renderer.toneMapping = THREE.NoToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.scene = new THREE.Scene();
    const { eye, target, fov } = scene.camera;
    this.camera = new THREE.PerspectiveCamera(fov, 1, 0.1, 10);
    this.camera.position.set(...eye);
    this.camera.lookAt(...target);
    this.light = new THREE.DirectionalLight(0xffffff, scene.lights[0].irradiance);
    const sides = { left: -kReach, right: kReach, bottom: -kReach, top: kReach };
    Object.assign(this.light.shadow.camera, { ...sides, near: 0.1, far: 3 });
    this.light.shadow.bias = -0.002;
    this.light.shadow.normalBias = 0.002;
    this.light.castShadow = true;
    model.traverse((one) => one.isMesh && Object.assign(one, { castShadow: true, receiveShadow: true }));
    this.scene.add(model, this.light, this.light.target);
    this.aim(scene.lights[0].direction);
    this.set({ samples: 1, mapSize: 1024 });
  }
  /** @param samples  of a pixel, a square number. @param mapSize  texels of the shadow map */
  set({ samples, mapSize }) {
    const side = Math.sqrt(samples) * this.size;
    this.target?.dispose();
    this.target = new THREE.WebGLRenderTarget(side, side, { type: THREE.FloatType });
    this.side = side;
    this.light.shadow.map?.dispose();
    this.light.shadow.map = null;
    this.light.shadow.mapSize.set(mapSize, mapSize);
  }
  aim(direction) {
    this.light.position.set(...direction).normalize().multiplyScalar(-1.5);
  }
  #draw(target) {
    this.renderer.setRenderTarget(target);
    this.renderer.render(this.scene, this.camera);
  }
  /** A frame of as many samples, waited for. */
  frame() {
    this.#draw(this.side === this.size ? null : this.target);
    waitFor(this.renderer.getContext());
  }
  /** Means over pixels: 4 floats each, row 0 at the top. */
  picture() {
    this.#draw(this.target);
    const { size, side } = this;
    const fine = new Float32Array(4 * side * side);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, side, side, fine);
    const [each, picture] = [side / size, new Float32Array(4 * size * size)];
    for (let y = 0; y < side; ++y)
      for (let x = 0; x < side; ++x) {
        const to = 4 * ((size - 1 - Math.floor(y / each)) * size + Math.floor(x / each));
        for (let c = 0; c < 3; ++c) picture[to + c] += fine[4 * (y * side + x) + c] / each ** 2;
      }
    return picture;
  }
  dispose() {
    this.target.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}

/** Half of what lies elsewhere, over all light. @param exact  3 floats a pixel */
function misplacedBy(picture, exact) {
  let [apart, all] = [0, 0];
  exact.forEach((value, i) => {
    apart += Math.abs(picture[4 * Math.floor(i / 3) + (i % 3)] - value);
    all += value;
  });
  return (0.5 * apart) / all;
}

/** Ways of the light of frame i. */
const turned = ([x, y, z], i) => {
  const angle = (3 * i * Math.PI) / 180;
  return [x * Math.cos(angle) - z * Math.sin(angle), y, x * Math.sin(angle) + z * Math.cos(angle)];
};

function sweepOf(one, knobs, exact, direction) {
  return combinations(knobs).map((setting) => {
    one.set(setting);
    one.aim(direction);
    const misplaced = misplacedBy(one.picture(), exact);
    const { frame } = timeInTurn({ frame: (i) => (one.aim(turned(direction, i)), one.frame()) }, 2);
    return { knobs: setting, misplaced, ms: frame.median };
  });
}

/** Milliseconds until three.js shows a model of a file, with a renderer that has shown another. */
async function firstOfThree(size, scene) {
  const before = await readModel('textured-small');
  const three = new Three(size, scene, before);
  three.frame();
  const start = performance.now();
  const model = await readModel('textured');
  three.scene.remove(before);
  model.traverse((one) => one.isMesh && Object.assign(one, { castShadow: true, receiveShadow: true }));
  three.scene.add(model);
  three.frame();
  const time = performance.now() - start;
  three.dispose();
  return time;
}

/** The same of the element, until it shows a picture, be it coarse. */
async function firstOfLucent(size) {
  const viewer = document.createElement('lucent-viewer');
  Object.assign(viewer.style, { display: 'block', width: `${size}px`, height: `${size}px`, maxHeight: 'none' });
  const shown = () =>
    new Promise((done, failed) => {
      viewer.addEventListener('error', ({ detail }) => failed(new Error(detail.message)), { once: true });
      viewer.addEventListener('load', () => viewer.addEventListener('frame', done, { once: true }), { once: true });
    });
  const wait = (name) => {
    const seen = shown();
    viewer.src = `peers/${name}.gltf.json`;
    return seen;
  };
  const first = shown();
  viewer.setAttribute('src', 'peers/textured-small.gltf.json');
  document.body.append(viewer);
  await first;
  const start = performance.now();
  await wait('textured');
  const time = performance.now() - start;
  viewer.remove();
  return time;
}

/** Both in turn, milliseconds. */
async function timeFirsts(size, scene, count) {
  const times = { three: [], lucent: [] };
  for (let i = 0; i < count; ++i) {
    times.three.push(await firstOfThree(size, scene));
    times.lucent.push(await firstOfLucent(size));
  }
  return { three: spreadOf(times.three), lucent: spreadOf(times.lucent) };
}

/** From now on a file is fetched once, and then comes from memory: what is left is the work on it. */
function keepFiles() {
  const { fetch } = window;
  const kept = new Map();
  window.fetch = async (asked, options) => {
    const { href } = new URL(asked.url ?? asked, document.baseURI);
    if (!kept.has(href)) kept.set(href, await (await fetch(href, options)).arrayBuffer());
    const bytes = kept.get(href);
    return new Response(bytes, { headers: { 'content-length': bytes.byteLength } });
  };
}

/**
 * @param options  scene; files: names of plain, the model for Lucent's bench module, and exact; repeats and firsts, of
 *                 the timings; knobs of three and lucent
 * @return         {driver, glVersion, swept: {three, lucent}, best, ms, first, atHand}, the last of files in memory
 */
window.compare = async ({ scene, files, repeats, firsts, knobs }) => {
  const [size] = scene.size;
  const { values: exact } = await fetchPfm(files.exact);
  const { direction } = scene.lights[0];

  const lucent = await Lucent.start(size);
  lucent.put('textured.mesh', await fetchBytes(files.plain));
  lucent.load(scene);
  const ours = {
    set: ({ pixelSamples }) => lucent.set('technique.sampling.pixelSamples', pixelSamples),
    aim: (way) => lucent.set('lights.0.direction', way),
    frame: () => lucent.frame(),
    picture: () => lucent.picture(),
  };
  const three = new Three(size, scene, await readModel('textured'));

  const swept = {
    three: sweepOf(three, knobs.three, exact, direction),
    lucent: sweepOf(ours, knobs.lucent, exact, direction),
  };
  const best = { three: least(swept.three, ({ misplaced }) => misplaced) };
  const asGood = swept.lucent.filter(({ misplaced }) => misplaced <= best.three.misplaced);
  best.lucent = asGood.length ? least(asGood, ({ ms }) => ms) : least(swept.lucent, ({ misplaced }) => misplaced);
  three.set(best.three.knobs);
  ours.set(best.lucent.knobs);
  const drawing = (one) => (i) => (one.aim(turned(direction, i)), one.frame());
  const ms = timeInTurn({ three: drawing(three), lucent: drawing(ours) }, repeats);
  const found = { driver: lucent.driver, glVersion: lucent.glVersion, swept, best, ms };
  three.dispose();
  lucent.release();

  const first = await timeFirsts(size, scene, firsts);
  keepFiles();
  await timeFirsts(size, scene, 1);
  return { ...found, first, atHand: await timeFirsts(size, scene, firsts) };
};
