/**
 * Caustics by public peers and by Lucent against the same exact light on a floor, in one page, in Chromium on both
 * software drivers.
 *
 *   node scripts/peers/caustics.mjs [--site build/web/site] [--driver NAME] [--size 256] [--scene NAME]
 *                                   [--photons NUMBER] [--program build/native/lucent] [--picture FILE]
 *
 * A glass ball and sine water over a floor, lit and seen straight from above: the scenes of `lucent bench caustics`.
 * `lucent truth` traces the light. What counts is the light that comes by way of glass or water: of the ball's truth
 * the light past the ball is taken away in closed form, of Lucent's picture another one in which the ball is opaque.
 * Misplaced is half the summed absolute difference of means over 5 x 5 pixels, over the sum of the truth.
 *
 * The ball's peer is Caustics of @pmndrs/vanilla, light past the ball not counted. The water's peer is written here as
 * such water commonly is: a grid refracted at its corners onto the floor, each fragment as bright as its area was over
 * its area now by screen derivatives, added up. Settings of all are swept. Peers do not know how much light there is:
 * they are given as much as the truth has. Who races is the quickest within the target, else the one with the least
 * misplaced. Times are those of whole frames on a canvas under a light that moves (draw, then read a pixel back), all
 * in turn.
 *
 * Prints each figure with its target, writes build/peers/caustics-DRIVER.json and, there or where --picture says,
 * caustics-DRIVER.png: a row for each scene with the truth, Lucent and what public pages do: on water they overwrite
 * where light falls twice, and take the product of two sides for an area.
 */
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import {
  Truths,
  atMost,
  bestOf,
  bringIn,
  figure,
  kOut,
  milliseconds,
  named,
  namesOf,
  offer,
  runOnDrivers,
  skipWithout,
} from './shared.mjs';

const kGlass = { transmission: 1 };

const kScenes = {
  ball: {
    height: 4, // m of the floor
    photons: 2e7, // of the truth, so that its own noise stays well below the target
    target: 0.005,
    timeTarget: 0.5,
    peer: '@pmndrs/vanilla',
    object: {
      name: 'ball',
      shape: { type: 'sphere', radius: 1 },
      material: { ...kGlass, ior: 1.5 },
      transform: { translate: [0, 1.2, 0] },
    },
    knobs: {
      peer: {
        resolution: [512, 1024, 2024],
        worldRadius: [0.05, 0.3125],
        ior: [1.1, 1.5],
        backsideIOR: [0, 1.1], // 0: back faces are left out
      },
      lucent: { grid: [64, 96, 128, 144], mapSize: [512, 640, 1024], refine: [false, true] },
    },
  },
  water: {
    height: 1,
    photons: 2e8,
    target: 0.01,
    timeTarget: 1,
    peer: 'area ratios',
    object: {
      name: 'water',
      shape: { type: 'water', size: [2, 2], cells: 640, damping: 0, amplitude: 0.015, wavelength: 0.25 },
      material: { ...kGlass, ior: 1.33 },
      transform: { translate: [0, 0.6, 0] },
    },
    knobs: {
      peer: { cells: [64, 128, 256, 512], map: [256, 512, 1024, 2048] },
      lucent: { cells: [160, 320, 640], grid: [128, 256], mapSize: [512, 1024] },
    },
  },
};

export const kComparison = { size: 256, repeats: 9 };

export function sceneOf(name, size) {
  const { height, object } = kScenes[name];
  return {
    lucent: 1,
    size: [size, size],
    camera: { type: 'orthographic', eye: [0, 20, 0], target: [0, 0, 0], up: [0, 0, -1], height },
    view: { show: 'irradiance' },
    lights: [{ type: 'distant', direction: [0, -1, 0] }],
    objects: [{ name: 'floor', shape: { type: 'plane', size: [40, 40] } }, { ...object, visible: false }],
  };
}

/**
 * Runs the comparison of one scene in an open page of the site.
 * @param truths  where exact pictures are made
 */
export async function compare(page, truths, name, { size, photons, ...comparison }) {
  const scene = sceneOf(name, size);
  const base = `caustics-${name}-${size}`;
  const noise = join(truths.folder, `${base}-noise.pfm`);
  const rays = String(photons ?? kScenes[name].photons);
  const exact = truths.solve(base, scene, 'irradiance', ['--photons', rays, '--errors', noise]);
  await page.unroute('**/peers/*');
  await offer(page, [exact, noise]);
  const { knobs, target } = kScenes[name];
  const files = namesOf({ exact, noise });
  return page.evaluate((options) => window.compare(options), { scene, files, knobs, target, ...comparison });
}

function measurementsOf(name, { size }, found) {
  const methods = { lucent: 'beam', peer: kScenes[name].peer };
  return Object.entries(methods).flatMap(([key, method]) =>
    found.swept[key].map((one) => ({
      technique: 'caustics',
      method,
      scene: name,
      width: size,
      height: size,
      lights: 1,
      knobs: one.knobs,
      ms: one.isBest ? found.ms[key] : one.ms,
      error: one.error,
    })),
  );
}

function ratiosOf(name, found) {
  const { target, timeTarget, peer } = kScenes[name];
  const misplaced = (key) => bestOf(found.swept[key]).error.flux.misplaced;
  return [
    atMost(`${name}: share of the light that Lucent misplaces`, misplaced('lucent'), target),
    atMost(`${name}: its time over that of ${peer}`, found.ms.lucent.median / found.ms.peer.median, timeTarget),
    figure(`${name}: share of the light that ${peer} misplaces`, misplaced('peer')),
    figure(`${name}: what the truth's own noise looks like`, found.swept.lucent[0].error.flux.byNoise),
  ];
}

const percent = (share) => `${(100 * share).toFixed(2)} %`;

function print(say, name, found) {
  for (const [key, method] of Object.entries({ lucent: 'Lucent', peer: kScenes[name].peer })) {
    say(`${name}: ${method}:`);
    for (const { knobs, ms, error } of found.swept[key])
      say(`  ${named(knobs)}: ${percent(error.flux.misplaced)} misplaced, about ${ms.median.toFixed(1)} ms`);
    say(`  races with ${named(bestOf(found.swept[key]).knobs)}: ${milliseconds(found.ms[key])}`);
  }
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  skipWithout('caustics', ['three', '@pmndrs/vanilla']);
  const options = {
    size: { type: 'string', default: String(kComparison.size) },
    repeats: { type: 'string', default: String(kComparison.repeats) },
    photons: { type: 'string' },
    scene: { type: 'string', default: Object.keys(kScenes).join() },
    program: { type: 'string', default: 'build/native/lucent' },
    picture: { type: 'string' },
  };
  await runOnDrivers('caustics', options, async (page, { size, repeats, photons, scene, program, picture }, say) => {
    const truths = new Truths(program);
    const comparison = { size: Number(size), repeats: Number(repeats), photons };
    await bringIn(page, 'caustics_page.js');
    const all = { measurements: [], ratios: [] };
    const rows = [];
    for (const name of scene.split(',')) {
      all.found = await compare(page, truths, name, comparison);
      print(say, name, all.found);
      all.measurements.push(...measurementsOf(name, comparison, all.found));
      all.ratios.push(...ratiosOf(name, all.found));
      rows.push(all.found.png);
    }
    const file = picture ?? join(kOut, `caustics-${process.env.LUCENT_DRIVER}.png`);
    const png = await page.evaluate((pngs) => window.stacked(pngs), rows);
    writeFileSync(file, Buffer.from(png, 'base64'));
    say(`wrote ${file}`);
    return all;
  });
}
