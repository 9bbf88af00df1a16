/**
 * Holds three.js (a displaced mesh with a shadow map) and Lucent against the same exact pictures, in one page, in
 * Chromium on both software drivers.
 *
 *   node scripts/peers/three.mjs [--site build/web/site] [--driver NAME] [--size 512]
 *
 * The field is three waves in closed form (waves.mjs), which both know by a sample a texel; pictures are seen from
 * above, one pixel a texel, lit by a distant light 20 and 40 degrees high. three.js draws a mesh with a vertex at each
 * texel centre, Lambert's material and a shadow map of 2048 x 2048 that is fitted to the field; its settings are swept,
 * and the best found for each error stands. Times are those of finished frames on a canvas (draw, then read a pixel
 * back) under a light that moves, both in turn. Errors leave the outermost pixels out, whose centres lie on the mesh's
 * border.
 *
 * Prints each figure with its target, writes build/peers/three-DRIVER.json: "error" there is against the exact picture
 * of the sampled field, "modelError" against that of the smooth one.
 */
import { pathToFileURL } from 'node:url';
import { atMost, bringIn, milliseconds, named, runOnDrivers, skipWithout } from './shared.mjs';

// Biases in texels: along the light, and along the normal.
export const kComparison = {
  n: 512,
  scale: 0.2,
  elevations: [20, 40],
  repeats: 9,
  knobs: {
    type: ['basic', 'pcf'],
    side: ['front', 'back'],
    bias: [-0.25, 0, 0.25],
    normalBias: [0, 0.5],
  },
};

/** Runs a comparison in an open page of the site. */
export async function compare(page, comparison) {
  await bringIn(page, 'three_page.js');
  return page.evaluate((options) => window.compare(options), comparison);
}

const least = (swept, kind, error) => swept.reduce((a, b) => (b[kind][error] < a[kind][error] ? b : a));
const percent = (share) => `${(100 * share).toFixed(4)} %`;

function ratiosOf({ lucent, ms }) {
  return [
    atMost('wrong texels against the smooth field', lucent.exact.wrongShare, 0.001),
    atMost('RMSE of the cosine against the smooth field', lucent.exact.rmse, 0.001),
    atMost('wrong texels against the sampled field', lucent.sampled.wrongShare, 0.00001),
    atMost("time over three.js's", ms.lucent.median / ms.three.median, 0.2),
  ];
}

function measurementsOf({ n, elevations }, found) {
  const scene = `waves, sun at ${elevations.join(' and ')} degrees`;
  const base = { scene, width: n, height: n, lights: 1 };
  const measurement = (technique, method, knobs, ms, { exact, sampled }) => ({
    technique,
    method,
    ...base,
    knobs,
    ...(ms && { ms }),
    error: sampled,
    modelError: exact,
  });
  const timed = least(found.three, 'exact', 'wrongShare');
  return [
    measurement('relief', 'hierarchy', {}, found.ms.lucent, found.lucent),
    ...found.three.map((one) => measurement('three.js', 'shadow map', one.knobs, one === timed && found.ms.three, one)),
  ];
}

const kFields = { exact: 'smooth field', sampled: 'sampled field' };
const kErrors = {
  wrongShare: { name: 'wrong texels', text: percent },
  rmse: { name: 'RMSE of the cosine', text: (value) => value.toExponential(2) },
};

function print(say, found) {
  say(`three.js r${found.revision}, ${found.three.length} settings of its shadow map:`);
  for (const [kind, field] of Object.entries(kFields))
    for (const [error, { name, text }] of Object.entries(kErrors)) {
      const best = least(found.three, kind, error);
      say(`  least ${name} against the ${field}: ${text(best[kind][error])} (${named(best.knobs)})`);
    }
  const { wrongShare, rmse } = found.sampling;
  const unknown = `${percent(wrongShare)} wrong texels, RMSE of the cosine ${rmse.toExponential(2)}`;
  say(`what the samples cannot know of the smooth field: ${unknown}`);
  say(`a frame: three.js ${milliseconds(found.ms.three)}, Lucent ${milliseconds(found.ms.lucent)}`);
}

async function main(page, { size }, say) {
  const comparison = { ...kComparison, n: Number(size) };
  const found = await compare(page, comparison);
  print(say, found);
  return { found, measurements: measurementsOf(comparison, found), ratios: ratiosOf(found) };
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  skipWithout('three', ['three']);
  await runOnDrivers('three', { size: { type: 'string', default: String(kComparison.n) } }, main);
}
