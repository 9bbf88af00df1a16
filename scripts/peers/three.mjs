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
import { build } from 'esbuild';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { cpus, totalmem } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';

const kHere = dirname(fileURLToPath(import.meta.url));
const kOut = resolve(kHere, '../../build/peers');

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
  const bundle = await build({
    entryPoints: [join(kHere, 'three_page.js')],
    bundle: true,
    format: 'esm',
    write: false,
    logLevel: 'warning',
  });
  await page.route('**/three-page.js', (route) =>
    route.fulfill({ contentType: 'text/javascript', body: bundle.outputFiles[0].text }),
  );
  await page.addScriptTag({ url: 'three-page.js', type: 'module' });
  await page.waitForFunction(() => window.compare);
  return page.evaluate((options) => window.compare(options), comparison);
}

const least = (swept, kind, error) => swept.reduce((a, b) => (b[kind][error] < a[kind][error] ? b : a));
const named = (knobs) => Object.entries(knobs).map(([name, value]) => `${name} ${value}`).join(', ');
const percent = (share) => `${(100 * share).toFixed(4)} %`;
const milliseconds = ({ median, low, high }) => `${median.toFixed(1)} ms (${low.toFixed(1)} to ${high.toFixed(1)})`;

function ratiosOf({ lucent, ms }) {
  const atMost = (name, value, target) => ({ name, value, target, atLeast: false, met: value <= target });
  return [
    atMost('wrong texels against the smooth field', lucent.exact.wrongShare, 0.001),
    atMost('RMSE of the cosine against the smooth field', lucent.exact.rmse, 0.001),
    atMost('wrong texels against the sampled field', lucent.sampled.wrongShare, 0.00001),
    atMost("time over three.js's", ms.lucent.median / ms.three.median, 0.2),
  ];
}

function report(browser, { n, elevations }, found) {
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
  const [cpu] = cpus();
  return {
    format: 'lucent-bench-1',
    date: new Date().toISOString().slice(0, 10),
    commit: execFileSync('git', ['rev-parse', '--short', 'HEAD'], { cwd: kHere, encoding: 'utf8' }).trim(),
    quick: false,
    machine: {
      cpu: cpu.model,
      cores: cpus().length,
      memoryMB: Math.round(totalmem() / 2 ** 20),
      where: 'browser',
      driver: found.driver,
      version: found.glVersion,
      browser,
    },
    timing: 'finished-frame',
    measurements: [
      measurement('relief', 'hierarchy', {}, found.ms.lucent, found.lucent),
      ...found.three.map((one) =>
        measurement('three.js', 'shadow map', one.knobs, one === timed && found.ms.three, one),
      ),
    ],
    ratios: ratiosOf(found),
  };
}

const kFields = { exact: 'smooth field', sampled: 'sampled field' };
const kErrors = {
  wrongShare: { name: 'wrong texels', text: percent },
  rmse: { name: 'RMSE of the cosine', text: (value) => value.toExponential(2) },
};

function print(driver, found) {
  const say = (line) => console.log(`${driver}: ${line}`);
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
  for (const { name, value, target, met } of ratiosOf(found))
    say(`Lucent: ${name}: ${value.toExponential(2)}, target at most ${target}${met ? '' : ': missed'}`);
}

async function main() {
  const { values: options } = parseArgs({
    options: {
      site: { type: 'string', default: 'build/web/site' },
      driver: { type: 'string' },
      size: { type: 'string', default: String(kComparison.n) },
    },
  });
  process.env.LUCENT_SITE = options.site;
  mkdirSync(kOut, { recursive: true });
  for (const driver of options.driver ? [options.driver] : ['swiftshader', 'llvmpipe']) {
    process.env.LUCENT_DRIVER = driver;
    const { openStage, openPage } = await import(`../../tests/web/support.mjs?driver=${driver}`);
    const stage = await openStage();
    const page = await openPage(stage, 'blank.html');
    const comparison = { ...kComparison, n: Number(options.size) };
    const found = await compare(page, comparison);
    print(driver, found);
    const file = join(kOut, `three-${driver}.json`);
    const browser = `Chromium ${stage.browser.version()}`;
    writeFileSync(file, JSON.stringify(report(browser, comparison, found), null, 1) + '\n');
    console.log(`${driver}: wrote build/peers/three-${driver}.json`);
    await stage.close();
  }
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) await main();
