/**
 * Translucency by public peers and by Lucent against the same exact radiosity of a ball of marble, in one page, in
 * Chromium on both software drivers.
 *
 *   node scripts/peers/translucency.mjs [--site build/web/site] [--driver NAME] [--size 256] [--samples NUMBER]
 *                                       [--program build/native/lucent]
 *
 * A ball of 10 mm, marble as Jensen et al. measured it in 2001, lit from the side. `lucent truth` integrates the dipole
 * over its surface by brute force. Misplaced is half the summed absolute difference of all pixels and colours over the
 * sum of the truth.
 *
 * Peers: the PBR material of Babylon.js with scattering in screen space (its pre-pass), alone or with translucency, and
 * with translucency alone; three.js by the shader of its example of subsurface scattering, and by transmission with a
 * thickness. They do not know how much light there is: each colour is given as much as the truth has. Their settings
 * are swept, then each number of the best is tuned on its own until nothing gets better; what races is the quickest
 * within the targets, else the one that misplaces the least. Babylon's picture is read from its canvas, in 8 bits.
 * Times are those of whole frames on a canvas under a light that moves (draw, then read a pixel back), all in turn.
 *
 * Prints each figure with its target, writes build/peers/translucency-DRIVER.json and translucency-DRIVER.png.
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

const kMethods = {
  lucent: 'multires',
  babylon: 'Babylon.js scattering',
  wrapped: 'Babylon.js translucency',
  scattering: 'three.js scattering',
  transmission: 'three.js transmission',
};

const kTranslucency = { intensity: [0.02, 0.1], distance: [[1, 1, 1]], tint: [[1, 1, 1]] };
const kScattering = { metersPerUnit: [0.005, 0.01, 0.03, 0.1], profile: [[1, 1, 1]] };

export const kComparison = {
  size: 256,
  repeats: 9,
  target: 0.02,
  sideTarget: 0.05,
  rounds: [2, 1.4, 1.15, 1.05],
  knobs: {
    lucent: { epsilon: [0.1, 0.07, 0.05, 0.03, 0.01] },
    babylon: [
      { mode: ['scattering'], ...kScattering },
      { mode: ['both'], ...kTranslucency, ...kScattering },
    ],
    wrapped: { mode: ['translucency'], ...kTranslucency },
    scattering: { distortion: [0.1, 0.5], ambient: [0.01, 0.1], power: [1, 4], scale: [0.1, 1] },
    transmission: { transmission: [0, 0.5], thickness: [0, 2], attenuationDistance: [0.5, 5] },
  },
};

export function sceneOf(size) {
  return {
    lucent: 1,
    size: [size, size],
    camera: { type: 'perspective', eye: [0, 0, 0.12], target: [0, 0, 0], fov: 10.5 },
    view: { show: 'radiosity' },
    lights: [{ type: 'distant', direction: [-1, 0, 0] }],
    objects: [{ name: 'ball', shape: { type: 'sphere', radius: 0.01 }, material: { preset: 'marble' } }],
    technique: { subsurface: { method: 'multires', dipoleGeometry: 'planar' } },
  };
}

/**
 * Runs the comparison in an open page of the site.
 * @param truths  where exact pictures are made
 */
export async function compare(page, truths, { size, samples, ...comparison }) {
  const scene = sceneOf(size);
  const how = ['--estimator', 'dipole', '--samples', samples]; // of few pixels: around a ball they are averaged
  const exact = truths.solve('translucency', sceneOf(64), 'radiosity', how);
  await offer(page, [exact]);
  return page.evaluate((options) => window.compare(options), {
    scene,
    files: namesOf({ exact }),
    titles: { ...kMethods, lucent: 'Lucent' },
    ...comparison,
  });
}

const shortly = (knobs) =>
  Object.fromEntries(
    Object.entries(knobs).map(([name, value]) => [
      name,
      [value].flat().map((one) => (typeof one === 'number' ? Number(one.toPrecision(3)) : one)).join(' '),
    ]),
  );

const measurementsOf = ({ size }, found) =>
  Object.entries(kMethods).flatMap(([key, method]) =>
    found.swept[key].map((one) => ({
      technique: 'subsurface',
      method,
      scene: 'ball in a page',
      width: size,
      height: size,
      lights: 1,
      knobs: shortly(one.knobs),
      ms: one.isBest ? found.ms[key] : one.ms,
      error: one.error,
    })),
  );

function ratiosOf({ target, sideTarget }, found) {
  const best = (key) => bestOf(found.swept[key]).error;
  const time = (key) => found.ms.lucent.median / found.ms[key].median;
  return [
    atMost('ball: share of the radiosity that Lucent misplaces', best('lucent').flux.misplaced, target),
    atMost('ball: its largest error 80 to 120 degrees from the light', best('lucent').side, sideTarget),
    atMost('ball: its time over that of Babylon.js scattering', time('babylon'), 1),
    ...Object.entries(kMethods)
      .filter(([key]) => key !== 'lucent')
      .flatMap(([key, method]) => [
        figure(`ball: share of the radiosity that ${method} misplaces`, best(key).flux.misplaced),
        figure(`ball: largest error of ${method} 80 to 120 degrees from the light`, best(key).side),
        ...(key === 'babylon' ? [] : [figure(`ball: Lucent's time over that of ${method}`, time(key))]),
      ]),
  ];
}

const percent = (share) => `${(100 * share).toFixed(2)} %`;

function print(say, found) {
  for (const [key, method] of Object.entries(kMethods)) {
    say(`${method}:`);
    for (const { knobs, ms, error } of found.swept[key])
      say(`  ${named(shortly(knobs))}: ${percent(error.flux.misplaced)} misplaced, about ${ms.median.toFixed(1)} ms`);
    say(`  races with ${named(shortly(bestOf(found.swept[key]).knobs))}: ${milliseconds(found.ms[key])}`);
  }
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  skipWithout('translucency', ['three', '@babylonjs/core']);
  const options = {
    size: { type: 'string', default: String(kComparison.size) },
    repeats: { type: 'string', default: String(kComparison.repeats) },
    samples: { type: 'string', default: '16384' },
    program: { type: 'string', default: 'build/native/lucent' },
  };
  await runOnDrivers('translucency', options, async (page, { size, repeats, samples, program }, say) => {
    const comparison = { ...kComparison, size: Number(size), repeats: Number(repeats), samples };
    await bringIn(page, 'translucency_page.js');
    const found = await compare(page, new Truths(program), comparison);
    print(say, found);
    const file = `translucency-${process.env.LUCENT_DRIVER}.png`;
    writeFileSync(join(kOut, file), Buffer.from(found.png, 'base64'));
    say(`wrote build/peers/${file}: ${Object.values(kMethods).join(', ')}, the truth`);
    return { found, measurements: measurementsOf(comparison, found), ratios: ratiosOf(comparison, found) };
  });
}
