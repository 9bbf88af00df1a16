/**
 * Refraction by public peers and by Lucent against the same exact directions, in one page, in Chromium on both software
 * drivers.
 *
 *   node scripts/peers/refraction.mjs [--site build/web/site] [--driver NAME] [--size 256] [--scene NAME]
 *                                     [--program build/native/lucent]
 *
 * A sphere, a torus, a bunny (58,784 triangles) and a dragon (871,414) of glass, ior 1.5, under the camera of
 * `lucent bench refraction`; both meshes also while they deform, for which a tree has to be built anew.
 * Pictures hold the direction in which each ray leaves; `lucent truth` says the exact one. Degrees count wherever the
 * eye sees glass; "inside" leaves out pixels beside which another number of surfaces lies.
 *
 * three.js: MeshPhysicalMaterial with transmission, before a dome that shows its direction, into a float target.
 * three-mesh-bvh: rays through its tree in a fragment shader with smooth normals. In the logic of its public examples a
 * ray that has left the glass is done; "reenters" goes on with it, which none of them does. Settings are swept, what
 * builds the tree by time, the rest by error; the setting that races is the quickest that keeps the targets of Lucent,
 * else the one with the least 95 %. Times are those of frames on a canvas under an eye that moves (draw, then read a
 * pixel back), all in turn; all draw directions.
 *
 * Prints each figure with its target, writes build/peers/refraction-DRIVER.json.
 */
import { readFileSync } from 'node:fs';
import { basename, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import {
  Truths,
  atLeast,
  atMost,
  bestOf,
  bringIn,
  figure,
  milliseconds,
  named,
  namesOf,
  offer,
  runOnDrivers,
  skipWithout,
} from './shared.mjs';

const kMesh = { type: 'mesh', source: 'body.mesh' };

const kScenes = {
  sphere: { shape: { type: 'sphere', radius: 1 }, targets: { median: 0.1, p95: 2 } },
  torus: {
    shape: { type: 'torus', major: 0.8, minor: 0.35 },
    transform: { rotate: [50, 0, 20] },
    targets: { median: 0.1, p95: 2 },
  },
  bunny: { shape: kMesh, file: 'assets/generated/gallery/bunny.glb', targets: { median: 0.3, p95: 3 } },
  // Drawn in software its time is a figure without a target.
  dragon: { shape: kMesh, file: 'assets/generated/meshes/dragon.glb', targets: { median: 0.3, p95: 3 }, isTimed: false },
};

export const kComparison = {
  size: 256,
  repeats: 9,
  knobs: {
    transmission: { thickness: [0, 1, 2, 4, 8], side: ['front', 'double'] },
    tree: { strategy: ['center', 'sah'], leaf: [4, 10] },
    rays: { segments: [64, 128], bounces: [2, 4, 8], normals: ['smooth'], reenters: [false, true] },
    flat: { segments: [128], bounces: [4], normals: ['flat'], reenters: [false] },
  },
};

/** As glassScene() of src/techniques/refract/bench/Bench.cpp has it: two metres long, in the picture's middle. */
function fitted(file) {
  const bytes = readFileSync(resolve(file));
  const head = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString());
  const { min, max } = head.accessors[head.meshes[0].primitives[0].attributes.POSITION];
  const scale = 2 / Math.max(...max.map((high, i) => high - min[i]));
  return { scale, translate: max.map((high, i) => (-scale * (high + min[i])) / 2) };
}

const kCamera = { type: 'perspective', eye: [0, 0.6, 3], target: [0, 0, 0], fov: 45 };

export function sceneOf(name, size) {
  const { shape, file, transform } = kScenes[name];
  return {
    lucent: 1,
    size: [size, size],
    camera: kCamera,
    view: { show: 'direction' },
    environment: { source: 'rainbow' },
    objects: [
      {
        name,
        shape,
        material: { transmission: 1, ior: 1.5 },
        transform: file ? fitted(file) : (transform ?? {}),
      },
    ],
  };
}

/**
 * Runs the comparison of one scene in an open page of the site.
 * @param truths  where exact pictures are made
 */
export async function compare(page, truths, name, comparison) {
  const scene = sceneOf(name, comparison.size);
  const { targets, file } = kScenes[name];
  const bodies = file ? [truths.mesh(file, 'body.mesh'), resolve(file)] : [];
  const exact = truths.solve(`refraction-${name}-${comparison.size}`, scene, 'direction');
  const layers = truths.solve(`refraction-${name}-${comparison.size}`, scene, 'layers');
  await page.unroute('**/peers/*');
  await offer(page, [...bodies, exact, layers]);
  const files = { ...namesOf({ exact, layers }), ...(file && { model: basename(file) }) };
  return page.evaluate((options) => window.compare(options), { scene, files, targets, ...comparison });
}

const kPeers = {
  transmission: 'three.js transmission',
  example: 'three-mesh-bvh',
  reentering: 'three-mesh-bvh, reentering',
};

function measurementsOf(name, { size }, found) {
  const measurement = (method, { knobs, ms, error }) => ({
    technique: 'refract',
    method,
    scene: name,
    width: size,
    height: size,
    lights: 0,
    knobs,
    ...(ms && { ms }),
    error: { degrees: error },
  });
  const swept = Object.entries(kPeers).flatMap(([key, method]) =>
    found.swept[key].map((one) => measurement(method, one.isBest ? { ...one, ms: found.ms[key] } : one)),
  );
  return [measurement('peel', { knobs: {}, ms: found.ms.lucent, error: found.lucent }), ...swept];
}

function ratiosOf(name, found) {
  const { all, inside } = found.lucent;
  const { targets, isTimed = true } = kScenes[name];
  const { median, p95 } = targets;
  const times = (peer) => found.ms[peer].median / found.ms.lucent.median;
  return [
    atMost(`${name}: median of degrees off`, all.median, median),
    atMost(`${name}: 95 % of degrees off`, all.p95, p95),
    figure(`${name}: 99 % of degrees off`, all.p99),
    figure(`${name}: 95 % of degrees off, inside`, inside.p95),
    isTimed
      ? atLeast(`${name}: three-mesh-bvh's time over Lucent's`, times('example'), 5)
      : figure(`${name}: three-mesh-bvh's time over Lucent's`, times('example')),
    ...(found.deforming ? [deformingRatio(name, found)] : []),
    figure(`${name}: that of three-mesh-bvh with rays that reenter over Lucent's`, times('reentering')),
    figure(`${name}: three.js transmission's over Lucent's`, times('transmission')),
  ];
}

function deformingRatio(name, { ms, deforming }) {
  const peer = deforming.rebuilt + ms.example.median;
  return figure(`${name}, deforming: that of three-mesh-bvh with a new tree over Lucent's`, peer / deforming.ms.median);
}

function errorText({ all, inside }) {
  const degrees = ({ median, p95, p99 }) => [median, p95, p99].map((value) => value.toPrecision(3)).join(' / ');
  return `${degrees(all)}, ${(100 * all.lost).toFixed(2)} % lost; inside ${degrees(inside)}`;
}

function print(say, name, found) {
  say(`${name}: degrees off in median / 95 % / 99 %:`);
  for (const [key, method] of Object.entries(kPeers)) {
    for (const { knobs, ms, error } of found.swept[key])
      say(`  ${method} (${named(knobs)}): ${errorText(error)}; about ${ms.median.toFixed(1)} ms`);
    say(`  ${method} races with ${named(bestOf(found.swept[key]).knobs)}: ${milliseconds(found.ms[key])}`);
  }
  say(`  trees: ${found.trees.map(({ knobs, ms }) => `${named(knobs)} ${ms.median.toFixed(1)} ms`).join('; ')}`);
  say(`  Lucent: ${errorText(found.lucent)}; ${milliseconds(found.ms.lucent)}`);
  if (found.deforming)
    say(`  deforming: Lucent ${milliseconds(found.deforming.ms)}; a new tree ${found.deforming.rebuilt.toFixed(0)} ms`);
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  skipWithout('refraction', ['three', 'three-mesh-bvh']);
  const options = {
    size: { type: 'string', default: String(kComparison.size) },
    repeats: { type: 'string', default: String(kComparison.repeats) },
    scene: { type: 'string', default: Object.keys(kScenes).join() },
    program: { type: 'string', default: 'build/native/lucent' },
  };
  await runOnDrivers('refraction', options, async (page, { size, repeats, scene, program }, say) => {
    const truths = new Truths(program);
    const comparison = { ...kComparison, size: Number(size), repeats: Number(repeats) };
    await bringIn(page, 'refraction_page.js');
    const all = { measurements: [], ratios: [] };
    for (const name of scene.split(',')) {
      all.found = await compare(page, truths, name, comparison);
      print(say, name, all.found);
      all.measurements.push(...measurementsOf(name, comparison, all.found));
      all.ratios.push(...ratiosOf(name, all.found));
    }
    return all;
  });
}
