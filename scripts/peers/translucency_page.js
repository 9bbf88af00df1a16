/**
 * Runs in a page: a ball that scatters light inside, by three.js, by Babylon.js and by Lucent; window.compare() times
 * them and measures how much of the radiosity they misplace.
 */
import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { DirectionalLight } from '@babylonjs/core/Lights/directionalLight.js';
import { PBRMaterial } from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import { Color3, Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { CreateSphere } from '@babylonjs/core/Meshes/Builders/sphereBuilder.js';
import '@babylonjs/core/Rendering/prePassRendererSceneComponent.js';
import '@babylonjs/core/Rendering/subSurfaceSceneComponent.js';
import { Scene } from '@babylonjs/core/scene.js';
import * as THREE from 'three';
import { SubsurfaceScatteringShader } from 'three/examples/jsm/shaders/SubsurfaceScatteringShader.js';
import {
  Lucent,
  fetchPfm,
  least,
  makeCanvas,
  markBest,
  misplacedText,
  paint,
  sweep,
  timeInTurn,
  turned,
  waitFor,
} from './page.js';
import { ThreeCanvas } from './three_canvas.js';

const kSegments = 128; // around the ball, as all draw it
const kColors = [0, 1, 2];

/** Ways of the light: from the right, and around in frame i. */
const lightOf = ([x, y, z]) => ({
  still: [x, y, z],
  moving(i) {
    const angle = (i * 3 * Math.PI) / 180;
    return [x * Math.cos(angle) - z * Math.sin(angle), y, x * Math.sin(angle) + z * Math.cos(angle)];
  },
});

// --- errors

/** Radiosity of the ball, exactly, and how far others are from it. */
class Judge {
  static async of({ scene, exact }) {
    const one = new Judge();
    const { width, values } = await fetchPfm(exact);
    const lightAt = averagedByAngle(values, anglesToLight(scene, width));
    one.size = scene.size[0];
    one.angles = anglesToLight(scene, one.size);
    one.exact = Float32Array.from([...one.angles].flatMap((angle) => (angle < 0 ? [0, 0, 0] : lightAt(angle))));
    one.sums = one.#sumsOf(one.exact);
    return one;
  }
  // Of each colour, where the ball is.
  #sumsOf(values) {
    return kColors.map((c) => this.angles.reduce((sum, angle, i) => sum + (angle < 0 ? 0 : values[3 * i + c]), 0));
  }
  // side: largest share of a degree's light that is wrong, 80 to 120 degrees from the lamp.
  #errorOf(values, gain) {
    let [apart, all, squares, count] = [0, 0, 0, 0];
    const degrees = Array.from({ length: 40 * 3 }, () => ({ error: 0, wanted: 0 }));
    this.angles.forEach((angle, i) => {
      if (angle < 0) return;
      for (const c of kColors) {
        const wanted = this.exact[3 * i + c];
        const error = gain[c] * values[3 * i + c] - wanted;
        apart += Math.abs(error);
        all += wanted;
        squares += error * error;
        count += 1;
        const degree = degrees[3 * Math.floor(angle - 80) + c];
        if (!degree) continue;
        degree.error += error;
        degree.wanted += wanted;
      }
    });
    const side = Math.max(...degrees.map(({ error, wanted }) => Math.abs(error) / Math.max(wanted, 1e-30)));
    const rmse = Math.sqrt(squares / count);
    return { rmse, relRmse: (rmse * count) / all, flux: { misplaced: (0.5 * apart) / all }, side };
  }
  /** @param values  3 floats a pixel, W/m². @return {error, gain} */
  judge(values) {
    const gain = [1, 1, 1];
    return { error: this.#errorOf(values, gain), gain };
  }
  /** Of a picture whose brightness is not known: as much light of each colour as there is. */
  fit(values) {
    const gain = this.#sumsOf(values).map((sum, c) => this.sums[c] / Math.max(sum, 1e-30));
    return { error: this.#errorOf(values, gain), gain };
  }
}

/**
 * A ball's light depends on the angle alone: the truth's noise is averaged over whole degrees.
 * @return  (angle) => light, linear between them
 */
function averagedByAngle(values, pixels) {
  const degrees = Array.from({ length: 180 }, () => ({ sum: [0, 0, 0], angles: 0, count: 0 }));
  pixels.forEach((angle, i) => {
    if (angle < 0) return;
    const degree = degrees[Math.min(179, Math.floor(angle))];
    kColors.forEach((c) => (degree.sum[c] += values[3 * i + c]));
    degree.angles += angle;
    degree.count += 1;
  });
  const known = degrees
    .filter(({ count }) => count > 0)
    .map(({ sum, angles, count }) => ({ at: angles / count, light: sum.map((one) => one / count) }));
  return (angle) => {
    const above = known.findIndex(({ at }) => at > angle);
    const [a, b] = [known.at(above > 0 ? above - 1 : above), known.at(above)];
    const share = a === b ? 0 : (angle - a.at) / (b.at - a.at);
    return a.light.map((light, c) => light + share * (b.light[c] - light));
  };
}

/** Degrees between the normal of a ball around the origin and the light, for each pixel; -1 where it is not. */
function anglesToLight({ camera, objects: [{ shape }], lights: [{ direction }] }, size) {
  const half = Math.tan((camera.fov * Math.PI) / 360);
  const away = camera.eye[2]; // the eye looks along -z
  const long = Math.hypot(...direction);
  return Float64Array.from({ length: size * size }, (_, i) => {
    const [x, y] = [(2 * ((i % size) + 0.5)) / size - 1, 1 - (2 * (Math.floor(i / size) + 0.5)) / size];
    const ray = [half * x, half * y, -1];
    const square = ray.reduce((sum, part) => sum + part * part, 0);
    const root = away * away - square * (away * away - shape.radius * shape.radius);
    if (root < 0) return -1;
    const distance = (away - Math.sqrt(root)) / square;
    const place = [distance * ray[0], distance * ray[1], away + distance * ray[2]];
    const cosine = -direction.reduce((sum, part, k) => sum + part * place[k], 0) / long / shape.radius;
    return (Math.acos(Math.min(1, Math.max(-1, cosine))) * 180) / Math.PI;
  });
}

/** Of 4 values a pixel the first three. */
const colorsOf = (values) => values.filter((_, i) => i % 4 !== 3);

// --- three.js

const kUnit = 100; // peers' scenes are in cm

/** A ball of three's under one light. */
class ThreeBall extends ThreeCanvas {
  constructor({ size: [size], camera: { eye, fov }, objects: [{ shape }] }) {
    super(size);
    this.camera = new THREE.PerspectiveCamera(fov, 1, 1, 100);
    this.camera.position.set(...eye.map((value) => kUnit * value));
    this.camera.lookAt(0, 0, 0);
    this.light = new THREE.DirectionalLight(0xffffff, 1);
    this.ball = new THREE.Mesh(new THREE.SphereGeometry(kUnit * shape.radius, kSegments, kSegments / 2));
    this.scene = new THREE.Scene().add(this.light, this.ball);
  }
  aim(way) {
    this.light.position.set(...way).multiplyScalar(-1);
  }
  #draw(target) {
    this.renderer.setRenderTarget(target);
    this.renderer.render(this.scene, this.camera);
  }
  frame() {
    this.#draw(null);
    waitFor(this.renderer.getContext());
  }
  picture() {
    this.#draw(this.target);
    return colorsOf(this.read());
  }
}

/** The shader of three's example of subsurface scattering (Barré-Brisebois, Bouchard 2011). */
class ThreeScattering extends ThreeBall {
  constructor(scene) {
    super(scene);
    const white = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
    white.needsUpdate = true;
    const material = new THREE.ShaderMaterial({
      uniforms: THREE.UniformsUtils.clone(SubsurfaceScatteringShader.uniforms),
      vertexShader: SubsurfaceScatteringShader.vertexShader,
      fragmentShader: SubsurfaceScatteringShader.fragmentShader,
      lights: true,
    });
    material.uniforms.diffuse.value = new THREE.Vector3(1, 1, 1);
    material.uniforms.specular.value = new THREE.Vector3(0, 0, 0);
    material.uniforms.thicknessMap.value = white;
    this.ball.material = material;
  }
  set({ distortion, ambient, power, scale }) {
    const { uniforms } = this.ball.material;
    uniforms.thicknessDistortion.value = distortion;
    uniforms.thicknessAmbient.value = ambient;
    uniforms.thicknessAttenuation.value = 1;
    uniforms.thicknessPower.value = power;
    uniforms.thicknessScale.value = scale;
  }
}

/** Three's physical material: light of what stands behind, refracted and absorbed, mixed with matt light. */
class ThreeTransmission extends ThreeBall {
  constructor(scene) {
    super(scene);
    this.scene.background = new THREE.Color(0);
    this.ball.material = new THREE.MeshPhysicalMaterial({ ior: 1.5, roughness: 1, specularIntensity: 0 });
  }
  set({ transmission, thickness, attenuationDistance }) {
    Object.assign(this.ball.material, { transmission, thickness, attenuationDistance });
  }
}

// --- Babylon.js

/** A ball of Babylon's: translucency of the material, scattering in screen space, or both. */
class Babylon {
  constructor({ size: [size], camera: { eye, fov }, objects: [{ shape }] }) {
    this.size = size;
    const canvas = makeCanvas(size);
    this.engine = new Engine(canvas, false, { preserveDrawingBuffer: true, stencil: false });
    this.scene = new Scene(this.engine);
    this.scene.useRightHandedSystem = true;
    this.scene.clearColor = new Color4(0, 0, 0, 1);
    const camera = new FreeCamera('eye', Vector3.FromArray(eye.map((value) => kUnit * value)), this.scene);
    camera.setTarget(Vector3.Zero());
    Object.assign(camera, { fov: (fov * Math.PI) / 180, minZ: 1, maxZ: 100 });
    this.light = new DirectionalLight('light', new Vector3(-1, 0, 0), this.scene);
    this.light.specular = Color3.Black();
    this.ball = CreateSphere('ball', { diameter: 2 * kUnit * shape.radius, segments: kSegments / 2 }, this.scene);
  }
  #make(mode) {
    if (mode === this.mode) return;
    this.mode = mode;
    this.ball.material?.dispose();
    const material = new PBRMaterial('marble', this.scene);
    Object.assign(material, { metallic: 0, roughness: 1, albedoColor: Color3.White() });
    material.subSurface.isTranslucencyEnabled = mode !== 'scattering';
    if (mode === 'translucency') {
      this.scene.disableSubSurfaceForPrePass();
      this.scene.disablePrePassRenderer();
    } else {
      this.scattering = this.scene.enableSubSurfaceForPrePass();
      material.subSurface.isScatteringEnabled = true;
    }
    this.ball.material = material;
  }
  /** Uniforms, but for the mode. */
  async set({ mode, metersPerUnit, profile, intensity, distance, tint }) {
    this.#make(mode);
    const { subSurface } = this.ball.material;
    if (mode !== 'scattering') {
      subSurface.translucencyIntensity = intensity;
      subSurface.minimumThickness = subSurface.maximumThickness = 2; // cm: the ball
      subSurface.diffusionDistance = Color3.FromArray(distance);
      subSurface.tintColor = Color3.FromArray(tint);
    }
    if (mode !== 'translucency') {
      this.scattering.metersPerUnit = metersPerUnit;
      this.scattering.clearAllDiffusionProfiles();
      this.scattering.ssFilterRadii.length = 0; // which that leaves as they are
      subSurface.scatteringDiffusionProfile = Color3.FromArray(profile);
    }
    await this.scene.whenReadyAsync();
    this.scene.render(); // the first picture of a mode is empty
  }
  aim(way) {
    this.light.direction = Vector3.FromArray(way);
  }
  frame() {
    this.scene.render();
    waitFor(this.engine._gl);
  }
  /** The canvas holds 8 bits, raised to 1 / 2.2. */
  picture() {
    this.scene.render();
    const bytes = new Uint8Array(4 * this.size * this.size);
    const gl = this.engine._gl;
    gl.readPixels(0, 0, this.size, this.size, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return colorsOf(turned(Float32Array.from(bytes, (value) => (value / 255) ** 2.2), 4 * this.size));
  }
  dispose() {
    this.engine.dispose();
  }
}

// --- Lucent

/** Lucent: the frames that are timed show the picture, those that are judged the radiosity. */
class Ours {
  constructor(lucent, scene) {
    Object.assign(this, { lucent, scene });
  }
  set(settings) {
    this.lucent.load({ ...this.scene, technique: { subsurface: { ...this.scene.technique.subsurface, ...settings } } });
    this.lucent.set('view.show', 'color');
  }
  aim(way) {
    this.lucent.set('lights.0.direction', way);
  }
  frame() {
    this.lucent.frame();
  }
  picture() {
    this.lucent.set('view.show', 'radiosity');
    const values = colorsOf(this.lucent.picture());
    this.lucent.set('view.show', 'color');
    return values;
  }
}

// --- the comparison

const misplaced = ({ error }) => error.flux.misplaced;

/** Steps of a setting's numbers, one at a time: what was a list has a step for each. */
function* stepsFrom(setting, factor) {
  for (const [name, value] of Object.entries(setting)) {
    if (typeof value === 'number') {
      yield { ...setting, [name]: value * factor };
      yield { ...setting, [name]: value / factor };
    } else if (Array.isArray(value))
      for (const k of value.keys())
        for (const by of [factor, 1 / factor])
          yield { ...setting, [name]: value.map((one, i) => (i === k ? one * by : one)) };
  }
}

/**
 * Looks around the best of a sweep, each number on its own, by ever smaller factors, and adds what it finds; around the
 * best with each of the words that a setting has.
 * @param judge  (picture) => {error, gain}
 */
async function refine(one, swept, judge, light, rounds) {
  const wordsOf = ({ knobs }) => Object.values(knobs).filter((value) => typeof value === 'string').join();
  one.aim(light.still);
  for (const words of new Set(swept.map(wordsOf))) {
    let best = least(swept.filter((one) => wordsOf(one) === words), misplaced);
    for (const factor of rounds)
      for (let better = true; better; ) {
        better = false;
        for (const knobs of stepsFrom(best.knobs, factor)) {
          await one.set(knobs);
          const found = judge(one.picture());
          if (misplaced(found) >= 0.999 * misplaced(best)) continue;
          best = { ...best, ...found, knobs };
          better = true;
        }
      }
    if (!swept.includes(best)) swept.push(best);
  }
}

/**
 * @param options  scene as a file has it: a ball around the origin, one distant light, an eye that looks along -z;
 *                 files: {exact}, name of its radiosity at any size; titles and knobs, lists of settings: {lucent,
 *                 babylon, wrapped, scattering, transmission}; rounds, factors by which settings of peers are refined;
 *                 target and sideTarget, shares: of the light that may be misplaced, and of light 80 to 120 degrees
 *                 from the lamp that may be wrong; repeats of the race
 * @return         {driver, glVersion, swept: {name: [{knobs, error, ms, isBest}]}, ms: {name}, png}
 */
window.compare = async ({ scene, files, titles, knobs, rounds, target, sideTarget, repeats }) => {
  const judge = await Judge.of({ scene, exact: files.exact });
  const light = lightOf(scene.lights[0].direction);
  const lucent = await Lucent.start(scene.size[0]);
  const all = {
    lucent: new Ours(lucent, scene),
    babylon: new Babylon(scene),
    wrapped: new Babylon(scene),
    scattering: new ThreeScattering(scene),
    transmission: new ThreeTransmission(scene),
  };
  const swept = {};
  for (const [name, one] of Object.entries(all)) {
    const isOurs = name === 'lucent';
    const judged = (picture) => (isOurs ? judge.judge(picture) : judge.fit(picture));
    swept[name] = await sweep(one, knobs[name], judged, light);
    if (!isOurs) await refine(one, swept[name], judged, light, rounds);
    await one.set(markBest(swept[name], target, ({ error }) => error.side <= sideTarget).knobs);
  }
  const frame = (one) => (i) => (one.aim(light.moving(i)), one.frame());
  const ms = timeInTurn(Object.fromEntries(Object.entries(all).map(([name, one]) => [name, frame(one)])), repeats);
  const panels = Object.entries(all).map(([name, one]) => {
    one.aim(light.still);
    const { error, gain } = swept[name].find(({ isBest }) => isBest);
    return {
      text: `${titles[name]}, ${misplacedText(error.flux.misplaced)}`,
      values: one.picture().map((value, i) => gain[i % 3] * value),
    };
  });
  panels.push({ text: 'exact', values: judge.exact });
  const png = paint(panels, judge.size, 0.8); // what leaves marble that is lit straight on
  Object.values(all).forEach((one) => one.dispose?.());
  const { driver, glVersion } = lucent;
  lucent.release();
  return { driver, glVersion, swept, ms, png };
};
