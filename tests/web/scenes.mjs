/** Small scenes for the tests of the page, so that they do not depend on the gallery. File name -> content. */
import { deflateSync } from 'node:zlib';
import { kHardScenes } from './hard_scenes.mjs';

const kSide = 96; // texels

/** One channel of floats as PFM; rows run upwards in that format. @param height  of x and y in (-1, 1), y up */
function pfm(height) {
  const texels = new Float32Array(kSide * kSide);
  const place = (index) => (2 * (index + 0.5)) / kSide - 1;
  for (let row = 0; row < kSide; ++row)
    for (let column = 0; column < kSide; ++column) texels[row * kSide + column] = height(place(column), place(row));
  return Buffer.concat([Buffer.from(`Pf\n${kSide} ${kSide}\n-1.0\n`), Buffer.from(texels.buffer)]);
}

/** A relief of 1 m under one lamp that stands to the left, seen from above. */
const scene = (title, heights, changes = {}) => ({
  lucent: 1,
  title,
  caption: `${title}, lit from the left.`,
  size: [200, 200],
  camera: { type: 'orthographic', eye: [0, 0, 2], target: [0, 0, 0], up: [0, 1, 0], height: 1 },
  technique: { sampling: { directions: 16 } }, // software drivers are slow
  lights: [{ type: 'point', position: [-0.8, 0, 0.6], color: [1, 1, 1], intensity: 1 }],
  objects: [
    {
      name: 'relief',
      shape: { type: 'heightfield', heights, heightScale: 0.3 },
      material: { diffuse: [0.9, 0.8, 0.6], depth: 0.01 },
    },
  ],
  ...changes,
});

const dome = scene('A dome', 'dome.pfm');
/** A panel that a wave moves, with no relief anywhere. */
const banner = {
  lucent: 1,
  title: 'A banner',
  size: [200, 200],
  camera: { type: 'orthographic', eye: [0, 0, 2], height: 2 },
  lights: [{ type: 'distant', direction: [0, 0, -1] }],
  objects: [
    { name: 'banner', shape: { type: 'box', size: [0.5, 1, 0.1] }, wave: { amplitude: [0.4, 0, 0], wavelength: 100 } },
  ],
};
/** Still water over a floor, both half as wide as the picture, seen from straight above. */
const pond = {
  lucent: 1,
  title: 'A pond',
  size: [200, 200],
  camera: { type: 'orthographic', eye: [0, 2, 0], up: [0, 0, -1], height: 2 },
  technique: { caustics: { grid: 32, mapSize: 64 } },
  lights: [{ type: 'distant', direction: [0.1, -1, 0] }],
  objects: [
    { name: 'floor', shape: { type: 'plane' }, transform: { translate: [0, -0.3, 0] } },
    { name: 'water', shape: { type: 'water', cells: 32 }, material: { transmission: 1, ior: 1.33 } },
  ],
};
/** A ball of marble, 20 mm wide, lit from the left. */
const marble = {
  lucent: 1,
  title: 'A marble',
  size: [200, 200],
  camera: { type: 'orthographic', eye: [0, 0, 1], height: 0.03 },
  lights: [{ type: 'distant', direction: [1, -0.3, 0], irradiance: 2 }],
  objects: [{ name: 'ball', shape: { type: 'sphere', radius: 0.01 }, material: { preset: 'marble' } }],
};
/** A block of it whose subsurface scattering is precomputed. */
const baked = {
  ...marble,
  title: 'A baked block',
  technique: { throughput: { side: 256 } },
  objects: [
    {
      name: 'block',
      shape: { type: 'box', size: [0.012, 0.012, 0.012] },
      transform: { rotate: [30, 40, 0] },
      material: { preset: 'marble', precomputed: true },
    },
  ],
};
/** The same where texels count, not how they are drawn. */
const ball = { ...marble, title: 'A ball', technique: { subsurface: { method: 'lambert', epsilon: 0.3 } } };
/** A ball of glass under a sky, partly in front of a board that shines by itself. */
const bead = {
  lucent: 1,
  title: 'A bead',
  size: [64, 64],
  camera: { type: 'orthographic', eye: [0, 0, 3], height: 4.8 },
  environment: { source: 'sky' },
  objects: [
    {
      name: 'board',
      shape: { type: 'box', size: [0.6, 2, 0.1] },
      transform: { translate: [1, 0, -1.5] },
      material: { base: [0.5, 0.3, 0.1], diffuse: [0, 0, 0] },
    },
    { name: 'bead', shape: { type: 'sphere', radius: 1 }, material: { transmission: 1, ior: 1.5 } },
  ],
  technique: { sampling: { directions: 6 } }, // the board is black: they change nothing but take time
};
const broken = structuredClone(dome);
broken.objects[0].shape.heightScale = 'tall';

/** A scene as text, with one sample a pixel unless it says more: software drivers are slow. */
const ofMiddles = ({ technique, ...rest }) =>
  JSON.stringify({ ...rest, technique: { ...technique, sampling: { pixelSamples: 1, ...technique?.sampling } } });

export const kScenes = {
  ...kHardScenes,
  'dome.json': ofMiddles(dome),
  'dome.pfm': pfm((x, y) => Math.max(0, 1 - x * x - y * y)),
  'banner.json': ofMiddles(banner),
  'pond.json': ofMiddles(pond),
  'marble.json': ofMiddles(marble),
  'baked.json': ofMiddles(baked),
  'ball.json': ofMiddles(ball),
  'bead.json': ofMiddles(bead),
  'ridge.json': ofMiddles(scene('A ridge', 'ridge.pfm')),
  'ridge.pfm': pfm((x) => 1 - Math.abs(x)),
  'sky.json': ofMiddles(
    scene('A dome under a sky', 'dome.pfm', { lights: [], environment: { source: 'direction' } }),
  ),
  'broken.json': JSON.stringify(broken, null, 1),
  'missing.json': JSON.stringify(scene('Nothing', 'nowhere.pfm')),
  'index.json': JSON.stringify([
    { id: 'dome', title: 'A dome', caption: 'Round.', scene: 'dome.json', thumbnail: 'small.png', poster: 'small.png' },
    {
      id: 'ridge',
      title: 'A ridge',
      caption: 'Sharp.',
      scene: 'ridge.json',
      thumbnail: 'small.png',
      poster: 'small.png',
    },
  ]),
};

/** A triangle of glass as "pane.gltf" and the "pane.bin" that it names. */
export function glassTriangle() {
  const data = Buffer.from(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]).buffer);
  const model = JSON.stringify({
    asset: { version: '2.0' },
    extensionsUsed: ['KHR_materials_transmission'],
    buffers: [{ uri: 'pane.bin', byteLength: data.length }],
    bufferViews: [{ buffer: 0, byteLength: data.length }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 0] }],
    materials: [
      {
        name: 'glass',
        pbrMetallicRoughness: { metallicFactor: 0 },
        extensions: { KHR_materials_transmission: { transmissionFactor: 1 } },
      },
    ],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, material: 0 }] }],
    nodes: [{ mesh: 0 }],
    scenes: [{ nodes: [0] }],
    scene: 0,
  });
  return { model: Buffer.from(model), data };
}

/**
 * A square whose left half is red and whose right half is green, which shines blue likewise, under a grain that keeps its
 * two pictures large: as "square.glb", which has all in it, as "square.gltf" with its files, a scene of each by those
 * names and ".json", and a relief of it.
 */
function texturedSquares() {
  const corners = [-1, 1, -1, -1, 1, -1, -1, 1, 1, -1, 1, 1];
  const at = corners.flatMap((one, i) => (i % 2 ? [one, 0] : one));
  const coordinates = corners.map((one, i) => (1 + (i % 2 ? -one : one)) / 2);
  const data = Buffer.from(new Float32Array([...at, ...coordinates]).buffer);
  let state = 1;
  const grain = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) >>> 26; // Numerical Recipes, 7.1
  const halves = (left, right) => (x, y, channel) => grain() + (channel === (x < 96 ? left : right) ? 180 : 0);
  const colors = colorPng(192, 192, halves(0, 1));
  const emission = colorPng(192, 192, halves(2, 2));
  const modelOf = (images, views, length, place = {}) => ({
    asset: { version: '2.0' },
    buffers: [{ byteLength: length, ...place }],
    bufferViews: [{ buffer: 0, byteLength: 72 }, { buffer: 0, byteOffset: 72, byteLength: 48 }, ...views],
    accessors: [
      { bufferView: 0, componentType: 5126, count: 6, type: 'VEC3', min: [-1, -1, 0], max: [1, 1, 0] },
      { bufferView: 1, componentType: 5126, count: 6, type: 'VEC2' },
    ],
    images,
    textures: [{ source: 0 }, { source: 1 }],
    materials: [
      {
        pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 0 },
        emissiveTexture: { index: 1 },
        emissiveFactor: [0, 0, 1],
      },
    ],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, material: 0 }] }],
    nodes: [{ mesh: 0 }],
    scenes: [{ nodes: [0] }],
    scene: 0,
  });
  const names = ['square-colors.png', 'square-emission.png'];
  const beside = modelOf(names.map((uri) => ({ uri })), [], data.length, { uri: 'square.bin' });
  const views = [
    { buffer: 0, byteOffset: data.length, byteLength: colors.length },
    { buffer: 0, byteOffset: data.length + colors.length, byteLength: emission.length },
  ];
  const pictures = Buffer.concat([colors, emission]);
  const all = Buffer.concat([data, pictures, Buffer.alloc(-pictures.length & 3)]);
  const inside = modelOf([2, 3].map((bufferView) => ({ bufferView, mimeType: 'image/png' })), views, all.length);
  const files = {
    'square.bin': data,
    'square-colors.png': colors,
    'square-emission.png': emission,
    'square.gltf': JSON.stringify(beside),
    'square.glb': glbOf(inside, all),
  };
  const sceneOf = (source) => ({
    lucent: 1,
    size: [64, 64],
    camera: { type: 'orthographic', eye: [0, 0, 2], height: 2 },
    lights: [{ type: 'distant', direction: [0, 0, -1], irradiance: Math.PI }],
    objects: [{ name: 'square', shape: { type: 'mesh', source } }],
  });
  for (const name of ['square.gltf', 'square.glb']) files[`${name}.json`] = ofMiddles(sceneOf(name));
  const relief = { name: 'relief', shape: { type: 'heightfield', mesh: 'square.glb' } };
  files['square-relief.json'] = ofMiddles(scene('A square', '', { objects: [relief] }));
  return files;
}

/** A binary glTF file. @param data  of a length that 4 divides */
function glbOf(model, data) {
  const text = JSON.stringify(model);
  const json = Buffer.from(text.padEnd((text.length + 3) & ~3));
  const numbers = (...all) => Buffer.from(new Uint32Array(all).buffer);
  const [kGlb, kJson, kBinary] = [0x46546c67, 0x4e4f534a, 0x004e4942];
  const length = 28 + json.length + data.length;
  return Buffer.concat([numbers(kGlb, 2, length, json.length, kJson), json, numbers(data.length, kBinary), data]);
}

/** An 8-bit grey PNG. @param value  of column x and row y, [0, 255] */
export const greyPng = (width, height, value) => pngOf(width, height, 1, value);
/** The same of a value (x, y, channel). */
export const colorPng = (width, height, value) => pngOf(width, height, 3, value);

function pngOf(width, height, channels, value) {
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]);
    const length = Buffer.alloc(4);
    length.writeUInt32BE(data.length);
    const check = Buffer.alloc(4);
    check.writeUInt32BE(crc32(body));
    return Buffer.concat([length, body, check]);
  };
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header[8] = 8; // bits
  header[9] = channels === 1 ? 0 : 2; // grey or red, green and blue
  const row = channels * width + 1; // starts with its filter: none
  const rows = Buffer.alloc(row * height);
  for (let y = 0; y < height; ++y)
    for (let at = 0; at < channels * width; ++at)
      rows[y * row + 1 + at] = value(Math.floor(at / channels), y, at % channels);
  return Buffer.concat([
    Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]),
    chunk('IHDR', header),
    chunk('IDAT', deflateSync(rows)),
    chunk('IEND', Buffer.alloc(0)),
  ]);
}

// Cyclic redundancy check of PNG (ISO 3309), bit by bit; Node.js 18 has none.
function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

// A truth of the dome that is wrong everywhere.
kScenes['black.pfm'] = Buffer.concat([Buffer.from('PF\n48 48\n-1.0\n'), Buffer.alloc(48 * 48 * 12)]);
kScenes['small.png'] = greyPng(8, 6, () => 128);
Object.assign(kScenes, texturedSquares());
