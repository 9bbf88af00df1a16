/**
 * Runs in a page: directions of light behind glass by three.js, by rays through a tree of three-mesh-bvh, and by
 * Lucent; window.compare() times them and measures their errors.
 */
import * as THREE from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import {
  BVHShaderGLSL,
  CENTER,
  FloatVertexAttributeTexture,
  MeshBVH,
  MeshBVHUniformStruct,
  SAH,
  getBVHExtremes,
} from 'three-mesh-bvh';
import { Lucent, combinations, fetchBytes, fetchPfm, least, timeInTurn, waitFor } from './page.js';
import { ThreeCanvas } from './three_canvas.js';

const kSides = { front: THREE.FrontSide, double: THREE.DoubleSide };
const kStrategies = { center: CENTER, sah: SAH };

// --- what is seen

/** Triangles of a scene's object, in the world. @param segments  around a sphere or a torus; @param model  a mesh's file */
async function geometryOf({ shape, transform }, segments, model) {
  const geometry = await {
    sphere: () => new THREE.SphereGeometry(shape.radius, segments, segments / 2),
    torus: () => new THREE.TorusGeometry(shape.major, shape.minor, segments / 2, segments).rotateX(Math.PI / 2),
    mesh: () => readModel(model),
  }[shape.type]();
  const { rotate = [0, 0, 0], scale = 1, translate = [0, 0, 0] } = transform;
  const turns = rotate.map((degrees) => THREE.MathUtils.degToRad(degrees));
  return geometry.applyMatrix4(
    new THREE.Matrix4().compose(
      new THREE.Vector3(...translate),
      new THREE.Quaternion().setFromEuler(new THREE.Euler(...turns, 'ZYX')), // about the fixed axes x, y, z
      new THREE.Vector3(scale, scale, scale),
    ),
  );
}

async function readModel(model) {
  const bytes = await fetchBytes(model);
  const { scene } = await new GLTFLoader().parseAsync(bytes.buffer, '');
  let geometry;
  scene.traverse((node) => (geometry ??= node.geometry));
  geometry.computeVertexNormals(); // by area, as Lucent has them
  return geometry;
}

/** All around the scene, of the colour of its direction. */
function makeDome() {
  const material = new THREE.ShaderMaterial({
    side: THREE.BackSide,
    vertexShader: `
      varying vec3 vPlace;
      void main() {
        vPlace = position;
        gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `
      varying vec3 vPlace;
      void main() { gl_FragColor = vec4(normalize(vPlace - cameraPosition), 1.0); }`,
  });
  return new THREE.Mesh(new THREE.BoxGeometry(20, 20, 20), material);
}

// --- peers

/** One of three's scenes with one object of glass. */
class Three extends ThreeCanvas {
  constructor(size, camera) {
    super(size);
    this.camera = new THREE.PerspectiveCamera(camera.fov, 1, 0.1, 50);
    this.scene = new THREE.Scene();
    this.glass = new THREE.Mesh();
    this.scene.add(makeDome(), this.glass);
    this.look = camera;
    this.aim(camera.eye);
  }
  aim(eye) {
    this.camera.position.set(...eye);
    this.camera.lookAt(...this.look.target);
  }
  show(geometry, material) {
    this.glass.material?.dispose();
    Object.assign(this.glass, { geometry, material });
  }
  /** A frame on the canvas, waited for. */
  frame() {
    this.renderer.setRenderTarget(null);
    this.renderer.render(this.scene, this.camera);
    waitFor(this.renderer.getContext());
  }
  /** 4 floats a pixel, row 0 at the top. */
  picture() {
    this.renderer.setRenderTarget(this.target);
    this.renderer.render(this.scene, this.camera);
    return this.read();
  }
}

// Without highlights nothing is added to what is transmitted.
function transmissionMaterial({ thickness, side }) {
  return new THREE.MeshPhysicalMaterial({
    transmission: 1,
    ior: 1.5,
    thickness,
    side: kSides[side],
    roughness: 0,
    specularIntensity: 0,
  });
}

/** A geometry with the textures by which a shader asks for the first hit of a ray. */
class Tree {
  constructor(geometry, { strategy, leaf }) {
    this.geometry = geometry.clone(); // whose indices the tree sorts
    const tree = new MeshBVH(this.geometry, { strategy: kStrategies[strategy], targetLeafSize: leaf });
    this.depth = getBVHExtremes(tree)[0].depth.max;
    this.bvh = new MeshBVHUniformStruct();
    this.bvh.updateFrom(tree);
    this.normals = new FloatVertexAttributeTexture();
    this.normals.updateFrom(this.geometry.attributes.normal);
  }
  dispose() {
    this.bvh.dispose();
    this.normals.dispose();
    this.geometry.dispose();
  }
}

const kRayShader = `
  precision highp isampler2D;
  precision highp usampler2D;
  ${BVHShaderGLSL.common_functions}
  ${BVHShaderGLSL.bvh_struct_definitions}
  ${BVHShaderGLSL.bvh_ray_functions}
  uniform BVH bvh;
  uniform sampler2D normals;
  in vec3 vPlace;
  in vec3 vNormal;
  out vec4 color;

  const float kIor = 1.5;
  const float kStep = 1e-4; // m, away from the surface that was just met

  void main() {
    uvec4 corners = uvec4(0u);
    vec3 faceNormal = vec3(0.0), weights = vec3(0.0);
    float side = 1.0, way = 0.0;
    vec3 direction = normalize(vPlace - cameraPosition);
    vec3 normal = ENTRY_NORMAL;
    direction = refract(direction, normal, 1.0 / kIor);
    vec3 place = vPlace + kStep * direction;
    bool inside = true;
    for (int i = 0; i < BOUNCES; ++i) {
      if (!bvhIntersectFirstHit(bvh, place, direction, corners, faceNormal, weights, side, way)) break;
      place += way * direction;
      #ifdef SMOOTH
        normal = normalize(textureSampleBarycoord(normals, weights, corners.xyz).xyz);
      #else
        normal = side * faceNormal;
      #endif
      if (inside) normal = -normal;
      vec3 bent = refract(direction, normal, inside ? kIor : 1.0 / kIor);
      if (bent == vec3(0.0)) {
        direction = reflect(direction, normal);
      } else {
        direction = bent;
        inside = !inside;
        #ifndef REENTERS
          break;
        #endif
      }
      place += kStep * direction;
    }
    color = vec4(direction, 1.0);
  }`;

function rayMaterial(tree, { bounces, normals, reenters }) {
  const smooth = normals === 'smooth';
  return new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    defines: {
      BOUNCES: bounces,
      BVH_STACK_DEPTH: tree.depth + 2, // two children are put in place of their parent
      ENTRY_NORMAL: smooth ? 'normalize(vNormal)' : 'normalize(cross(dFdx(vPlace), dFdy(vPlace)))',
      ...(smooth && { SMOOTH: 1 }),
      ...(reenters && { REENTERS: 1 }),
    },
    uniforms: { bvh: { value: tree.bvh }, normals: { value: tree.normals } },
    vertexShader: `
      out vec3 vPlace;
      out vec3 vNormal;
      void main() {
        vPlace = position;
        vNormal = normal;
        gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: kRayShader,
  });
}

// --- errors

/** The smallest of the values that a share of them is not above, as src/measure/Metrics.cpp has it. */
function percentile(sorted, share) {
  return sorted.length ? sorted[Math.ceil(share * sorted.length) - 1] : NaN;
}

class Angles {
  #degrees = [];
  #pixels = 0;

  add(picture, exact, i) {
    this.#pixels += 1;
    if (picture[4 * i + 3] === 0) return;
    const a = picture.subarray(4 * i, 4 * i + 3);
    const b = exact.subarray(3 * i, 3 * i + 3);
    const cross = Math.hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    const dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    this.#degrees.push((Math.atan2(cross, dot) * 180) / Math.PI);
  }
  get json() {
    const sorted = Float64Array.from(this.#degrees).sort();
    const [median, p95, p99] = [0.5, 0.95, 0.99].map((share) => percentile(sorted, share));
    return { median, p95, p99, lost: 1 - sorted.length / this.#pixels, pixels: this.#pixels };
  }
}

/** How far directions are from exact ones, wherever the eye sees glass, as `lucent bench refraction` counts. */
class Judge {
  static async of({ exact, layers }) {
    const one = new Judge();
    [one.exact, one.layers] = await Promise.all([fetchPfm(exact), fetchPfm(layers)]);
    return one;
  }
  #layersAt(x, y) {
    return this.layers.values[3 * (y * this.layers.width + x)];
  }
  #isInside(x, y) {
    const { width, height } = this.layers;
    if (x < 1 || y < 1 || x + 1 >= width || y + 1 >= height) return false;
    for (let i = 0; i < 9; ++i)
      if (this.#layersAt(x + (i % 3) - 1, y + Math.floor(i / 3) - 1) !== this.#layersAt(x, y)) return false;
    return true;
  }
  // A ray that the truth gave up has no direction.
  #isKnown(i) {
    return Math.hypot(...this.exact.values.subarray(3 * i, 3 * i + 3)) > 0.5;
  }
  angles(picture) {
    const { width, height } = this.exact;
    const [all, inside] = [new Angles(), new Angles()];
    for (let i = 0; i < width * height; ++i) {
      const [x, y] = [i % width, Math.floor(i / width)];
      if (this.#layersAt(x, y) === 0 || !this.#isKnown(i)) continue;
      all.add(picture, this.exact.values, i);
      if (this.#isInside(x, y)) inside.add(picture, this.exact.values, i);
    }
    return { all: all.json, inside: inside.json };
  }
}

// --- the comparison

const kSweepRepeats = 1;

/** Marks the quickest that keeps the targets, else the nearest. @return its knobs */
function chooseRacer(swept, { median, p95 }) {
  const good = swept.filter(({ error }) => error.all.median <= median && error.all.p95 <= p95);
  const best = good.length ? least(good, ({ ms }) => ms.median) : least(swept, ({ error }) => error.all.p95);
  best.isBest = true;
  return best.knobs;
}

/** The i-th eye on a circle around the y axis. */
function eyeOf({ eye }, i) {
  const angle = (i * 3 * Math.PI) / 180;
  const [sine, cosine] = [Math.sin(angle), Math.cos(angle)];
  return [cosine * eye[0] + sine * eye[2], eye[1], cosine * eye[2] - sine * eye[0]];
}

class Comparison {
  constructor({ scene, files, size, knobs, targets, repeats }, judge, lucent) {
    Object.assign(this, { scene, files, knobs, targets, repeats, judge, lucent });
    this.object = scene.objects[0];
    this.three = new Three(size, scene.camera);
    this.geometries = new Map();
    this.trees = new Map();
  }
  async geometry(segments) {
    const key = this.object.shape.type === 'mesh' ? 0 : segments;
    if (!this.geometries.has(key)) this.geometries.set(key, await geometryOf(this.object, segments, this.files.model));
    return this.geometries.get(key);
  }
  async tree(segments, knobs) {
    const geometry = await this.geometry(segments);
    const key = `${geometry.id} ${knobs.strategy} ${knobs.leaf}`;
    if (!this.trees.has(key)) this.trees.set(key, new Tree(geometry, knobs));
    return this.trees.get(key);
  }

  frameOfThree(i) {
    this.three.aim(eyeOf(this.scene.camera, i));
    this.three.frame();
  }
  frameOfLucent(i) {
    this.lucent.set('camera.eye', eyeOf(this.scene.camera, i));
    this.lucent.frame();
  }
  // One setting of a peer, which is showing: its error, and about its time.
  measure(knobs) {
    this.three.aim(this.scene.camera.eye);
    const error = this.judge.angles(this.three.picture());
    const { ms } = timeInTurn({ ms: (i) => this.frameOfThree(i) }, kSweepRepeats);
    return { knobs, error, ms };
  }

  async showTransmission(knobs) {
    this.three.show(await this.geometry(256), transmissionMaterial(knobs));
  }
  async showRays(knobs, treeKnobs) {
    const tree = await this.tree(knobs.segments, treeKnobs);
    this.three.show(tree.geometry, rayMaterial(tree, knobs));
  }

  async sweepTransmission() {
    const swept = [];
    for (const knobs of combinations(this.knobs.transmission)) {
      await this.showTransmission(knobs);
      swept.push(this.measure(knobs));
    }
    return swept;
  }
  async sweepTrees() {
    const swept = [];
    const rays = combinations(this.knobs.rays).at(-1);
    for (const knobs of combinations(this.knobs.tree)) {
      await this.showRays(rays, knobs);
      swept.push(this.measure(knobs));
    }
    return swept;
  }
  async sweepRays(tree) {
    const swept = [];
    const settings = [this.knobs.rays, this.knobs.flat].flatMap(combinations);
    const isMesh = this.object.shape.type === 'mesh';
    const segments = this.knobs.rays.segments.at(-1);
    for (const knobs of settings) {
      if (isMesh && knobs.segments !== segments) continue;
      await this.showRays(knobs, tree);
      swept.push(this.measure({ ...knobs, ...tree }));
    }
    return swept;
  }

  // Programs and textures stay while several settings take turns.
  async frameOf(peer, knobs) {
    if (peer === 'transmission') await this.showTransmission(knobs);
    else await this.showRays(knobs, knobs);
    const { geometry, material } = this.three.glass;
    this.three.glass.material = undefined;
    return (i) => {
      Object.assign(this.three.glass, { geometry, material });
      this.frameOfThree(i);
    };
  }
  async run() {
    const trees = await this.sweepTrees();
    const rays = await this.sweepRays(least(trees, ({ ms }) => ms.median).knobs);
    const swept = {
      transmission: await this.sweepTransmission(),
      example: rays.filter(({ knobs }) => !knobs.reenters),
      reentering: rays.filter(({ knobs }) => knobs.reenters),
    };
    const frames = { lucent: (i) => this.frameOfLucent(i) };
    for (const [peer, list] of Object.entries(swept))
      frames[peer] = await this.frameOf(peer, chooseRacer(list, this.targets));
    const ms = timeInTurn(frames, this.repeats);
    this.lucent.set('camera.eye', this.scene.camera.eye);
    const lucent = this.judge.angles(this.lucent.picture());
    const deforming = this.files.model && (await this.deform(swept.example.find(({ isBest }) => isBest).knobs));
    return { trees, swept, ms, lucent, deforming };
  }
  // Lucent's frames of a body that a wave bends, and what building a tree anew takes.
  async deform(knobs) {
    const geometry = await this.geometry(knobs.segments);
    const start = performance.now();
    new Tree(geometry, knobs).dispose();
    const rebuilt = performance.now() - start;
    this.lucent.set(`objects.${this.object.name}.wave.amplitude`, [0.02, 0, 0]);
    const frame = (i) => {
      this.lucent.set('view.time', 0.05 * i);
      this.lucent.frame();
    };
    return { rebuilt, ...timeInTurn({ ms: frame }, this.repeats) };
  }
  dispose() {
    this.trees.forEach((tree) => tree.dispose());
    this.three.dispose();
  }
}

/**
 * @param options  scene as a file has it, with one object of glass; files, names of its exact directions and layers and
 *                 of a mesh's model;
 *                 size in pixels; knobs, lists of the peers' settings; targets in degrees; repeats of the race
 * @return         {driver, glVersion, trees, swept: {peer: [{knobs, error, ms, isBest}]}, ms of lucent and each peer,
 *                 lucent: error, deforming: {ms, rebuilt} of a mesh}
 */
window.compare = async (options) => {
  const judge = await Judge.of(options.files);
  const lucent = await Lucent.start(options.size);
  if (options.files.model) lucent.put('body.mesh', await fetchBytes('body.mesh'));
  lucent.load(options.scene);
  const comparison = new Comparison(options, judge, lucent);
  const found = await comparison.run();
  comparison.dispose();
  const { driver, glVersion } = lucent;
  lucent.release();
  return { driver, glVersion, ...found };
};
