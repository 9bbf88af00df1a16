/**
 * Runs in a page: light on a floor by way of a glass ball or of water, by a peer and by Lucent; window.compare() times
 * both and measures how much of it they misplace.
 */
import { Caustics } from '@pmndrs/vanilla';
import * as THREE from 'three';
import { FullScreenQuad } from 'three/examples/jsm/postprocessing/Pass.js';
import { Lucent, fetchPfm, markBest, misplacedText, paint, stacked, sumOf, sweep, timeInTurn, waitFor } from './page.js';
import { ThreeCanvas } from './three_canvas.js';

const kCell = 5; // pixels a side, over which light may lie where it likes
const kWhite = 4; // times the light without the object: white in pictures

const kLight = {
  still: [0, -1, 0],
  moving(i) {
    const angle = (i * 3 * Math.PI) / 180;
    return [0.1 * Math.cos(angle), -1, 0.1 * Math.sin(angle)];
  },
};

// --- errors

/** Sums over cells; what is left at the right and below is in none. */
function cellsOf(values, size) {
  const side = Math.floor(size / kCell);
  const sums = new Float64Array(side * side);
  const cellAt = (x, y) => Math.floor(y / kCell) * side + Math.floor(x / kCell);
  for (let y = 0; y < side * kCell; ++y)
    for (let x = 0; x < side * kCell; ++x) sums[cellAt(x, y)] += values[y * size + x];
  return sums;
}

/** Green of pictures with so many channels: the light is white. */
function greenOf(values, channels) {
  return Float64Array.from({ length: values.length / channels }, (_, i) => values[channels * i + 1]);
}

/** Light by way of the object, exactly, and how far others are from it. */
class Judge {
  static async of({ scene, files }) {
    const one = new Judge();
    const [exact, noise] = await Promise.all([fetchPfm(files.exact), fetchPfm(files.noise)]);
    one.size = exact.width;
    const direct = directLight(scene);
    one.exact = greenOf(exact.values, 3).map((value, i) => value - direct[i]);
    one.cells = cellsOf(one.exact, one.size);
    one.all = sumOf(one.cells);
    const variances = cellsOf(greenOf(noise.values, 3).map((error) => error * error), one.size);
    // Half the mean of the absolute value of a Gaussian.
    one.byNoise = (0.5 * sumOf(variances.map((variance) => Math.sqrt((variance * 2) / Math.PI)))) / one.all;
    return one;
  }
  #misplaced(cells, gain) {
    return (0.5 * this.cells.reduce((sum, wanted, i) => sum + Math.abs(gain * cells[i] - wanted), 0)) / this.all;
  }
  /** @param gain  by which the picture's values are multiplied */
  errorOf(picture, gain = 1) {
    const squares = this.exact.reduce((sum, wanted, i) => sum + (gain * picture[i] - wanted) ** 2, 0);
    const rmse = Math.sqrt(squares / this.exact.length);
    const relRmse = rmse / (sumOf(this.exact) / this.exact.length);
    const misplaced = this.#misplaced(cellsOf(picture, this.size), gain);
    return { rmse, relRmse, flux: { misplaced, byNoise: this.byNoise } };
  }
  /** Of a picture whose brightness is not known: as much light as there is. @return {error, gain} */
  fit(picture) {
    const gain = this.all / Math.max(sumOf(cellsOf(picture, this.size)), 1e-30);
    return { error: this.errorOf(picture, gain), gain };
  }
}

/** Light from straight above past a ball over the floor, in the middle of each pixel; behind water there is none. */
function directLight({ size: [width, height], camera, objects }) {
  const { shape } = objects[1];
  return Float64Array.from({ length: width * height }, (_, i) => {
    const [x, y] = [(i % width) + 0.5 - width / 2, Math.floor(i / width) + 0.5 - height / 2];
    return shape.type === 'sphere' && (Math.hypot(x, y) * camera.height) / height > shape.radius ? 1 : 0;
  });
}

// --- what draws

/** Three's pictures as the scene's camera sees them; of their light the green. */
class Three extends ThreeCanvas {
  constructor({ size: [size], camera: { height } }) {
    super(size);
    this.camera = new THREE.OrthographicCamera(-height / 2, height / 2, height / 2, -height / 2, 0.1, 50);
    this.camera.position.y = 20;
    this.camera.up.set(0, 0, -1);
    this.camera.lookAt(0, 0, 0);
  }
  green() {
    return greenOf(this.read(), 4);
  }
}

/** Caustics of @pmndrs/vanilla on a black floor. */
class Vanilla extends Three {
  constructor(scene) {
    super(scene);
    const { shape, transform } = scene.objects[1];
    this.ball = new THREE.Mesh(new THREE.SphereGeometry(shape.radius, 128, 64));
    this.ball.position.set(...transform.translate);
    this.scene = new THREE.Scene();
    const floor = new THREE.PlaneGeometry(40, 40).rotateX(-Math.PI / 2);
    this.scene.add(new THREE.Mesh(floor, new THREE.MeshBasicMaterial({ color: 0 })));
  }
  // Its target's size is chosen once.
  #make(resolution) {
    if (this.caustics?.params.resolution === resolution) return;
    if (this.caustics) {
      this.scene.remove(this.caustics.group);
      const { normalTarget, normalTargetB, causticsTarget, causticsTargetB } = this.caustics;
      [normalTarget, normalTargetB, causticsTarget, causticsTargetB].forEach((target) => target.dispose());
    }
    this.caustics = Caustics(this.renderer, { frames: Infinity, causticsOnly: true, intensity: 1, resolution });
    this.caustics.scene.add(this.ball);
    this.scene.add(this.caustics.group);
  }
  set({ resolution, worldRadius, ior, backsideIOR }) {
    this.#make(resolution);
    Object.assign(this.caustics.params, { worldRadius, ior, backsideIOR, backside: backsideIOR > 0 });
  }
  aim(way) {
    this.caustics.params.lightSource = new THREE.Vector3(...way).negate();
  }
  #draw(target) {
    this.renderer.setRenderTarget(null);
    this.caustics.update();
    this.renderer.setRenderTarget(target);
    this.renderer.render(this.scene, this.camera);
  }
  frame() {
    this.#draw(null);
    waitFor(this.renderer.getContext());
  }
  picture() {
    this.#draw(this.target);
    return this.green();
  }
}

/**
 * Water whose light is added up by ratios of areas in a map over the picture's floor; or, as public demos have it, where
 * the last triangle overwrites what others brought and areas are products of two sides.
 */
class AreaRatios extends Three {
  constructor(scene) {
    super(scene);
    const { shape, material, transform } = scene.objects[1];
    this.water = { shape, material, depth: transform.translate[1], height: scene.camera.height };
    this.way = new THREE.Vector3();
    this.scene = new THREE.Scene();
    this.floor = new FullScreenQuad(
      new THREE.ShaderMaterial({
        uniforms: { light: { value: null } },
        vertexShader: `
          varying vec2 vAt;
          void main() {
            vAt = uv;
            gl_Position = vec4(position.xy, 0.0, 1.0);
          }`,
        fragmentShader: `
          uniform sampler2D light;
          varying vec2 vAt;
          void main() { gl_FragColor = texture2D(light, vAt); }`,
      }),
    );
  }
  #material(overwrites) {
    const { shape, material, depth, height } = this.water;
    const number = (value) => value.toFixed(9);
    return new THREE.ShaderMaterial({
      uniforms: { way: { value: this.way } },
      side: THREE.DoubleSide,
      depthTest: false,
      depthWrite: false,
      blending: overwrites ? THREE.NoBlending : THREE.CustomBlending,
      blendSrc: THREE.OneFactor,
      blendDst: THREE.OneFactor,
      vertexShader: `
        uniform vec3 way;
        varying vec3 vOld, vNew;
        void main() {
          float turns = ${number((2 * Math.PI) / shape.wavelength)};
          float angle = turns * position.x;
          vec3 normal = normalize(vec3(${number(-shape.amplitude)} * turns * cos(angle), 1.0, 0.0));
          vec3 place = vec3(position.x, ${number(shape.amplitude)} * sin(angle), position.z);
          vec3 bent = refract(way, normal, 1.0 / ${number(material.ior)});
          vOld = place - way * (place.y / way.y); // where the ray meets y = 0
          vNew = place - bent * ((place.y + ${number(depth)}) / bent.y);
          gl_Position = vec4(vNew.x / ${number(height / 2)}, -vNew.z / ${number(height / 2)}, 0.0, 1.0);
        }`,
      fragmentShader: `
        varying vec3 vOld, vNew;
        float area(vec3 place) {
          ${overwrites ? 'return length(dFdx(place)) * length(dFdy(place));' : 'return length(cross(dFdx(place), dFdy(place)));'}
        }
        void main() { gl_FragColor = vec4(vec3(area(vOld) / area(vNew)), 1.0); }`,
    });
  }
  set({ cells, map, overwrites = false }) {
    const [width, depth] = this.water.shape.size;
    this.mesh?.geometry.dispose();
    this.mesh?.material.dispose();
    this.map?.dispose();
    const grid = new THREE.PlaneGeometry(width, depth, cells, cells).rotateX(-Math.PI / 2);
    this.mesh = new THREE.Mesh(grid, this.#material(overwrites));
    this.mesh.frustumCulled = false;
    this.scene.clear().add(this.mesh);
    const filters = { minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter };
    this.map = new THREE.WebGLRenderTarget(map, map, { type: THREE.FloatType, depthBuffer: false, ...filters });
    this.floor.material.uniforms.light.value = this.map.texture;
  }
  aim(way) {
    this.way.set(...way).normalize();
  }
  #draw(target) {
    this.renderer.setRenderTarget(this.map);
    this.renderer.clear();
    this.renderer.render(this.scene, this.camera);
    this.renderer.setRenderTarget(target);
    this.floor.render(this.renderer);
  }
  frame() {
    this.#draw(null);
    waitFor(this.renderer.getContext());
  }
  picture() {
    this.#draw(this.target);
    return this.green();
  }
}

/** Lucent with the knobs of its technique, and the cells of water. */
class Ours {
  constructor(lucent, scene) {
    Object.assign(this, { lucent, scene });
  }
  set({ cells, ...settings }) {
    const [floor, { shape, ...object }] = this.scene.objects;
    const objects = [floor, { ...object, shape: { ...shape, ...(cells && { cells }) } }];
    this.lucent.load({ ...this.scene, objects, technique: { caustics: settings } });
  }
  aim(way) {
    this.lucent.set('lights.0.direction', way);
  }
  frame() {
    this.lucent.frame();
  }
  #green() {
    return greenOf(this.lucent.picture(), 4);
  }
  /** Light by way of the object: without what is there when the object is opaque. */
  picture() {
    const all = this.#green();
    this.lucent.set('objects.1.material.transmission', 0);
    const past = this.#green();
    this.lucent.set('objects.1.material.transmission', 1);
    return all.map((value, i) => value - past[i]);
  }
}

// --- the comparison

window.stacked = stacked;

/**
 * @param options  scene as a file has it, its second object bends the light; files, names of its truth and of the
 *                 truth's standard errors; knobs: {peer, lucent}, lists of settings; target, share; repeats of the race
 * @return         {driver, glVersion, swept: {lucent, peer: [{knobs, error, ms, isBest}]}, ms: {lucent, peer}, png: the
 *                 truth, Lucent and what public pages do}
 */
window.compare = async ({ scene, files, knobs, target, repeats }) => {
  const judge = await Judge.of({ scene, files });
  const lucent = await Lucent.start(scene.size[0]);
  const isBall = scene.objects[1].shape.type === 'sphere';
  const ours = new Ours(lucent, scene);
  const peer = isBall ? new Vanilla(scene) : new AreaRatios(scene);
  const swept = {
    lucent: await sweep(ours, knobs.lucent, (picture) => ({ error: judge.errorOf(picture) }), kLight),
    peer: await sweep(peer, knobs.peer, (picture) => judge.fit(picture), kLight),
  };
  const bestOfOurs = markBest(swept.lucent, target);
  ours.set(bestOfOurs.knobs);
  const best = markBest(swept.peer, target);
  peer.set(best.knobs);
  const frame = (one) => (i) => (one.aim(kLight.moving(i)), one.frame());
  const ms = timeInTurn({ lucent: frame(ours), peer: frame(peer) }, repeats);
  const { driver, glVersion } = lucent;
  const direct = directLight(scene);
  const panel = (text, values, gain = 1) => ({
    text,
    values: [...values].flatMap((value, i) => Array(3).fill(direct[i] + gain * value)),
  });
  const judged = (name, { error }) => `${name}, ${misplacedText(error.flux.misplaced)}`;
  ours.aim(kLight.still);
  peer.aim(kLight.still);
  if (!isBall) peer.set({ ...best.knobs, overwrites: true });
  const shown = peer.picture();
  const fitted = judge.fit(shown);
  const panels = [
    panel('exact', judge.exact),
    panel(judged('Lucent', bestOfOurs), ours.picture()),
    panel(judged(isBall ? '@pmndrs/vanilla' : 'areas, overwritten', fitted), shown, fitted.gain),
  ];
  const found = { driver, glVersion, swept, ms, png: paint(panels, judge.size, kWhite) };
  peer.dispose();
  lucent.release();
  return found;
};
