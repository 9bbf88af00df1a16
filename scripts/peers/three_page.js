/**
 * Runs in a page: the same field under the same light by three.js, as a displaced mesh with a shadow map, and by
 * Lucent; window.compare() times both and counts their errors.
 */
import * as THREE from 'three';
import { Lucent, combinations, makeCanvas, timeInTurn, waitFor } from './page.js';
import { centreOf, directionOf, sampleWaves, solveWaves } from './waves.mjs';

const kMapSize = 2048;
const kTypes = { basic: THREE.BasicShadowMap, pcf: THREE.PCFShadowMap };
const kSides = { front: THREE.FrontSide, back: THREE.BackSide };

/** Normals by central differences, as Lucent takes them: nearer to the smooth field than the mean of the triangles'. */
function normalsOf(heights, n, scale) {
  const normals = new Float32Array(3 * n * n);
  const at = (row, column) => heights[row * n + column] * scale;
  for (let row = 0; row < n; ++row)
    for (let column = 0; column < n; ++column) {
      const [left, right] = [Math.max(column - 1, 0), Math.min(column + 1, n - 1)];
      const [above, below] = [Math.max(row - 1, 0), Math.min(row + 1, n - 1)];
      const x = (-(at(row, right) - at(row, left)) * n) / (right - left);
      const y = ((at(below, column) - at(above, column)) * n) / (below - above);
      const length = Math.hypot(x, y, 1);
      normals.set([x / length, y / length, 1 / length], 3 * (row * n + column));
    }
  return normals;
}

/** Two triangles between four neighbouring texel centres. */
function makeGeometry(heights, n, scale) {
  const positions = new Float32Array(3 * n * n);
  const indices = new Uint32Array(6 * (n - 1) * (n - 1));
  let next = 0;
  for (let row = 0; row < n; ++row)
    for (let column = 0; column < n; ++column) {
      const i = row * n + column;
      positions.set([centreOf(column, n), -centreOf(row, n), heights[i] * scale], 3 * i);
      if (row === n - 1 || column === n - 1) continue;
      indices.set([i, i + n, i + 1, i + 1, i + n, i + n + 1], next);
      next += 6;
    }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(normalsOf(heights, n, scale), 3));
  geometry.setIndex(new THREE.BufferAttribute(indices, 1));
  return geometry;
}

class Three {
  constructor(heights, n, scale) {
    this.n = n;
    this.renderer = new THREE.WebGLRenderer({ canvas: makeCanvas(n), antialias: false });
    this.renderer.shadowMap.enabled = true;
    this.target = new THREE.WebGLRenderTarget(n, n, { type: THREE.FloatType });
    this.camera = new THREE.OrthographicCamera(-0.5, 0.5, 0.5, -0.5, 0.1, 10);
    this.camera.position.z = 5;
    this.scene = new THREE.Scene();
    this.light = new THREE.DirectionalLight(0xffffff, Math.PI); // Lambert's factor is 1 / pi
    this.light.shadow.mapSize.set(kMapSize, kMapSize);
    this.scene.add(this.light, this.light.target);
    this.geometry = makeGeometry(heights, n, scale);
    this.box = new THREE.Box3().setFromBufferAttribute(this.geometry.attributes.position);
    this.mesh = new THREE.Mesh(this.geometry, new THREE.MeshLambertMaterial({ color: 0xffffff }));
    this.mesh.receiveShadow = this.mesh.castShadow = true;
    this.scene.add(this.mesh);
  }

  /** @param settings  {type, side, bias, normalBias}; lengths in metres */
  set({ type, side, bias, normalBias }) {
    this.mesh.material.dispose(); // the type is compiled into its program
    this.mesh.material = new THREE.MeshLambertMaterial({ color: 0xffffff, shadowSide: kSides[side] });
    this.renderer.shadowMap.type = kTypes[type];
    this.light.shadow.map?.dispose();
    this.light.shadow.map = null;
    this.bias = bias;
    this.light.shadow.normalBias = normalBias;
  }

  /** Moves the light and fits its map tightly around the field. */
  aim(direction) {
    const { light, box } = this;
    light.position.set(...direction).multiplyScalar(3);
    light.updateMatrixWorld();
    const { camera } = light.shadow;
    camera.position.copy(light.position);
    camera.lookAt(0, 0, 0);
    camera.updateMatrixWorld();
    const inLight = box.clone().applyMatrix4(camera.matrixWorld.clone().invert());
    const { min, max } = inLight;
    const depths = { near: -max.z - 0.01, far: -min.z + 0.01 };
    Object.assign(camera, { left: min.x, right: max.x, bottom: min.y, top: max.y, ...depths });
    camera.updateProjectionMatrix();
    light.shadow.bias = -this.bias / (camera.far - camera.near); // three's unit is the depth range
  }

  /** A frame on the canvas, waited for. */
  frame() {
    this.light.castShadow = true;
    this.renderer.setRenderTarget(null);
    this.renderer.render(this.scene, this.camera);
    waitFor(this.renderer.getContext());
  }

  /** Linear red of every pixel in a row of RGBA, row 0 at the bottom. */
  read(shadows) {
    const { n } = this;
    this.light.castShadow = shadows;
    this.renderer.setRenderTarget(this.target);
    this.renderer.render(this.scene, this.camera);
    const pixels = new Float32Array(4 * n * n);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, n, n, pixels);
    return pixels;
  }

  /**
   * Light of every pixel, row 0 at the top; dark where the shadow takes half of it or more.
   * @param open  what read(false) gave under this light
   */
  picture(open) {
    const { n } = this;
    const shadowed = this.read(true);
    const values = new Float64Array(n * n);
    for (let row = 0; row < n; ++row)
      for (let column = 0; column < n; ++column) {
        const from = 4 * ((n - 1 - row) * n + column);
        values[row * n + column] = shadowed[from] > 0.5 * open[from] ? shadowed[from] : 0;
      }
    return values;
  }
}

async function startLucent(heights, n, scale) {
  const lucent = await Lucent.start(n);
  lucent.put('waves.pfm', pfm(heights, n));
  lucent.load(sceneOf(n, scale));
  return lucent;
}
const aimLucent = (lucent, direction) => lucent.set('lights.0.direction', direction.map((part) => -part));

/** First channel of four. */
const firstOf = (values) => Float64Array.from({ length: values.length / 4 }, (_, i) => values[4 * i]);

function pfm(heights, n) {
  const head = new TextEncoder().encode(`Pf\n${n} ${n}\n-1.0\n`);
  const upwards = new Float32Array(n * n);
  for (let row = 0; row < n; ++row) upwards.set(heights.subarray(row * n, (row + 1) * n), (n - 1 - row) * n);
  const file = new Uint8Array(head.length + upwards.byteLength);
  file.set(head);
  file.set(new Uint8Array(upwards.buffer), head.length);
  return file;
}

// A depth far below half a texel: Lambert with hard shadows.
const sceneOf = (n, scale) => ({
  lucent: 1,
  size: [n, n],
  camera: { type: 'orthographic', eye: [0, 0, scale + 1], target: [0, 0, 0], up: [0, 1, 0], height: 1 },
  view: { show: 'd' },
  lights: [{ type: 'distant', direction: [0, 0, -1] }],
  objects: [
    {
      name: 'waves',
      shape: { type: 'heightfield', heights: 'waves.pfm', heightScale: scale },
      material: { depth: 1e-6 },
    },
  ],
});

/**
 * Counts over several lights, without the outermost pixels: their centres lie on the mesh's border.
 * wrong: share of texels that are lit in one and dark in the other; rmse: of the cosine where both are lit.
 */
class Errors {
  #wrong = 0;
  #texels = 0;
  #squares = 0;
  #lit = 0;

  add(values, exact, n) {
    for (let row = 1; row < n - 1; ++row)
      for (let column = 1; column < n - 1; ++column) {
        const [value, truth] = [values[row * n + column], exact[row * n + column]];
        this.#texels += 1;
        if (value > 0 !== truth > 0) this.#wrong += 1;
        if (!(value > 0 && truth > 0)) continue;
        this.#lit += 1;
        this.#squares += (value - truth) ** 2;
      }
  }
  get json() {
    return { wrongShare: this.#wrong / this.#texels, rmse: Math.sqrt(this.#squares / this.#lit) };
  }
}

// Frames of both in turn under a light that moves.
function timeBoth(three, lucent, elevation, repeats) {
  const lightOf = (i) => directionOf(elevation, 40 + 3 * i);
  return timeInTurn(
    {
      three: (i) => (three.aim(lightOf(i)), three.frame()),
      lucent: (i) => (aimLucent(lucent, lightOf(i)), lucent.frame()),
    },
    repeats,
  );
}

/**
 * @param options  n texels and pixels a side; scale, m for a height of 1; elevations of the lights, degrees; repeats of
 *                 the timing; knobs, lists of three's settings, biases in texels
 * @return         {driver, glVersion, revision of three.js, three: [{knobs, exact, sampled}], lucent: {exact, sampled},
 *                 sampling: error of the sampled field's own truth, ms: {three, lucent}}
 */
window.compare = async ({ n, scale, elevations, repeats, knobs }) => {
  const heights = sampleWaves(n);
  const lucent = await startLucent(heights, n, scale);
  const three = new Three(heights, n, scale);
  const lights = elevations.map((elevation) => directionOf(elevation, 40));
  const truths = lights.map((light) => {
    aimLucent(lucent, light);
    return { exact: solveWaves(n, scale, light), sampled: firstOf(lucent.truth()) };
  });
  const open = lights.map((light) => {
    three.aim(light);
    return three.read(false);
  });
  const errorsOf = (pictureUnder) => {
    const errors = { exact: new Errors(), sampled: new Errors() };
    lights.forEach((light, i) => {
      const picture = pictureUnder(light, open[i]);
      for (const kind of ['exact', 'sampled']) errors[kind].add(picture, truths[i][kind], n);
    });
    return { exact: errors.exact.json, sampled: errors.sampled.json };
  };
  const set = (setting) => three.set({ ...setting, bias: setting.bias / n, normalBias: setting.normalBias / n });
  const swept = combinations(knobs).map((setting) => {
    set(setting);
    return { knobs: setting, ...errorsOf((light, unshadowed) => (three.aim(light), three.picture(unshadowed))) };
  });
  const best = swept.reduce((a, b) => (b.exact.wrongShare < a.exact.wrongShare ? b : a));
  set(best.knobs);
  const ms = timeBoth(three, lucent, elevations[0], repeats);
  const limits = new Errors();
  truths.forEach(({ exact, sampled }) => limits.add(sampled, exact, n));
  return {
    driver: lucent.driver,
    glVersion: lucent.glVersion,
    revision: THREE.REVISION,
    three: swept,
    lucent: errorsOf((light) => (aimLucent(lucent, light), firstOf(lucent.picture()))),
    sampling: limits.json,
    ms,
  };
};
