/**
 * A textured model by three.js and by Lucent against the same exact picture, in one page, in Chromium on both software
 * drivers.
 *
 *   node scripts/peers/textured.mjs [--site build/web/site] [--driver NAME] [--size 512] [--side 2048]
 *                                   [--program build/native/lucent]
 *
 * A ring of 100,000 triangles with four pictures of 2048 x 2048: colour, metal and roughness, normals, emission; lit by
 * a distant light, with shadows. `lucent truth` solves it, with a mean over each pixel. three.js draws it with its
 * standard material and a shadow map that is fitted to the ring; both are given more samples of a pixel until they cost
 * more than they mend.
 *
 * The first picture is timed from the file's name to a picture on the page, by three's GLTFLoader and by the element,
 * whose modules have both shown another model before; once more with files that come from memory, not from a server.
 * Frames are timed in turn under a light that moves (draw, then read a pixel back): three at the setting that misplaces
 * the least, Lucent at the quickest that misplaces no more.
 */
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import {
  Truths,
  atMost,
  bringIn,
  figure,
  milliseconds,
  named,
  namesOf,
  offer,
  runOnDrivers,
  skipWithout,
} from './shared.mjs';

export const kComparison = {
  size: 512,
  side: 2048, // of the pictures, texels
  around: 316, // quadrangles around the ring, half as many around its tube
  repeats: 7,
  firsts: 3,
  knobs: { three: { samples: [1, 4, 9], mapSize: [1024, 2048] }, lucent: { pixelSamples: [1, 2, 4, 8] } },
};

const kMajor = 0.35;
const kMinor = 0.15;

/** Positions, normals, coordinates and triangles of a ring, as three.js and the file have them. */
function ringOf(around) {
  const across = around / 2;
  const [positions, normals, coordinates, indices] = [[], [], [], []];
  for (let i = 0; i <= across; ++i)
    for (let j = 0; j <= around; ++j) {
      const [u, v] = [j / around, i / across];
      const [a, b] = [2 * Math.PI * u, 2 * Math.PI * v];
      const normal = [Math.cos(b) * Math.cos(a), Math.sin(b), -Math.cos(b) * Math.sin(a)];
      const ring = [kMajor * Math.cos(a), 0, -kMajor * Math.sin(a)];
      positions.push(...ring.map((x, k) => x + kMinor * normal[k]));
      normals.push(...normal);
      coordinates.push(6 * u, 2 - 2 * v);
      if (i === across || j === around) continue;
      const first = i * (around + 1) + j;
      indices.push(first, first + 1, first + around + 2, first, first + around + 2, first + around + 1);
    }
  return { positions, normals, coordinates, indices };
}

/**
 * A ring as glTF with its buffer and pictures beside it: a policy that forbids blob: addresses keeps GLTFLoader from those
 * in one file.
 * @param pictures  {color, metal, normal, emissive}: JPEG files
 * @return          {name: bytes} of all files
 */
function gltfOf(base, around, pictures) {
  const ring = ringOf(around);
  const parts = [ring.positions, ring.normals, ring.coordinates].map((list) => new Float32Array(list));
  parts.push(new Uint32Array(ring.indices));
  const buffer = Buffer.concat(parts.map((part) => Buffer.from(part.buffer)));
  let end = 0;
  const bufferViews = parts.map(({ byteLength }) => ({ buffer: 0, byteOffset: (end += byteLength) - byteLength, byteLength }));
  const names = Object.keys(pictures);
  const texture = (name) => ({ index: names.indexOf(name) });
  const count = ring.positions.length / 3;
  const reach = [kMajor + kMinor, kMinor, kMajor + kMinor];
  const accessor = (bufferView, type, more) => ({ bufferView, componentType: 5126, count, type, ...more });
  const document = {
    asset: { version: '2.0' },
    scenes: [{ nodes: [0] }],
    scene: 0,
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1, TEXCOORD_0: 2 }, indices: 3, material: 0 }] }],
    materials: [
      {
        pbrMetallicRoughness: { baseColorTexture: texture('color'), metallicRoughnessTexture: texture('metal') },
        normalTexture: texture('normal'),
        emissiveTexture: texture('emissive'),
        emissiveFactor: [1, 1, 1],
      },
    ],
    textures: names.map((_, source) => ({ source, sampler: 0 })),
    samplers: [{ magFilter: 9729, minFilter: 9987, wrapS: 10497, wrapT: 10497 }],
    images: names.map((name) => ({ uri: `${base}-${name}.jpg` })),
    buffers: [{ byteLength: end, uri: `${base}.bin` }],
    bufferViews,
    accessors: [
      accessor(0, 'VEC3', { min: reach.map((x) => -x), max: reach }),
      accessor(1, 'VEC3'),
      accessor(2, 'VEC2'),
      { ...accessor(3, 'SCALAR'), componentType: 5125, count: ring.indices.length },
    ],
  };
  const files = names.map((name) => [`${base}-${name}.jpg`, Buffer.from(pictures[name], 'base64')]);
  return Object.fromEntries([[`${base}.gltf`, JSON.stringify(document)], [`${base}.bin`, buffer], ...files]);
}

export function sceneOf(size, source) {
  return {
    lucent: 1,
    size: [size, size],
    camera: { type: 'perspective', eye: [0.35, 0.85, 0.95], target: [0, 0, 0], fov: 40 },
    lights: [{ type: 'distant', direction: [-0.5, -1, -0.3], irradiance: Math.PI }],
    objects: [{ name: 'ring', shape: { type: 'mesh', source } }],
  };
}

/** Runs a comparison in an open page of the site. @param truths  where exact pictures are made */
export async function compare(page, truths, { size, side, around, ...comparison }) {
  await bringIn(page, 'textured_page.js');
  const files = [];
  const write = async (base, cells, texels) => {
    const pictures = await page.evaluate((each) => window.picturesOf(each), texels);
    for (const [name, bytes] of Object.entries(gltfOf(base, cells, pictures))) {
      files.push(join(truths.folder, name));
      writeFileSync(files.at(-1), bytes);
    }
  };
  await write('textured', around, side);
  await write('textured-small', 16, 16);
  const plain = truths.mesh(join(truths.folder, 'textured.gltf'), 'textured.mesh');
  const scene = sceneOf(size, 'textured.mesh');
  const exact = truths.solve(`textured-${size}-${side}`, scene, 'color', ['--samples', '64']);
  for (const source of ['textured.gltf', 'textured-small.gltf']) {
    files.push(join(truths.folder, `${source}.json`));
    writeFileSync(files.at(-1), JSON.stringify({ ...sceneOf(size, source), technique: { sampling: { pixelSamples: 1 } } }));
  }
  await offer(page, [...files, plain, exact]);
  return page.evaluate((options) => window.compare(options), { scene, files: namesOf({ plain, exact }), ...comparison });
}

const percent = (share) => `${(100 * share).toFixed(2)} %`;

function print(say, { swept, ms, first, atHand, best }) {
  for (const [who, list] of Object.entries(swept))
    for (const { knobs, misplaced, ms: time } of list)
      say(`${who}, ${named(knobs)}: ${percent(misplaced)} misplaced, about ${time.toFixed(0)} ms`);
  for (const [who, name] of Object.entries({ three: 'three.js', lucent: 'Lucent' }))
    say(`a frame of ${name} (${named(best[who].knobs)}): ${milliseconds(ms[who])}`);
  const both = ({ three, lucent }) => `three.js ${milliseconds(three)}, Lucent ${milliseconds(lucent)}`;
  say(`first picture: ${both(first)}; of files in memory: ${both(atHand)}`);
}

const ratiosOf = ({ ms, first, atHand, best }) => [
  atMost("first picture over three.js's", first.lucent.median / first.three.median, 1.5),
  atMost("first picture of files in memory over three.js's", atHand.lucent.median / atHand.three.median, 1.5),
  atMost("time of a frame over three.js's at the same error or less", ms.lucent.median / ms.three.median, 1),
  atMost("light misplaced over three.js's", best.lucent.misplaced / best.three.misplaced, 1),
  figure('light misplaced by three.js', best.three.misplaced),
];

function measurementsOf({ size }, { swept, ms, best }) {
  return Object.entries(swept).flatMap(([technique, list]) =>
    list.map((one) => ({
      technique,
      method: technique === 'three' ? 'standard material, shadow map' : 'textures',
      scene: 'textured ring',
      width: size,
      height: size,
      lights: 1,
      knobs: one.knobs,
      ...(one.knobs === best[technique].knobs && { ms: ms[technique] }),
      error: { flux: { misplaced: one.misplaced } },
    })),
  );
}

async function main(page, { size, side, program }, say) {
  const comparison = { ...kComparison, size: Number(size), side: Number(side) };
  const found = await compare(page, new Truths(program), comparison);
  print(say, found);
  return { found, measurements: measurementsOf(comparison, found), ratios: ratiosOf(found) };
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  skipWithout('textured', ['three']);
  const text = (value) => ({ type: 'string', default: String(value) });
  const more = { size: text(kComparison.size), side: text(kComparison.side), program: text('build/native/lucent') };
  await runOnDrivers('textured', more, main);
}
