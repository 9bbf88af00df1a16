/**
 * What the page costs a visitor: bytes before it is interactive, and the time from navigation to the first whole
 * picture; and the sweep of `lucent bench` in the page. In Chromium on both software drivers.
 *
 *   node scripts/bench_web.mjs [--site build/web/site] [--runs 5] [--driver NAME] [--sweep quick] [--parts NAMES]
 *
 * --sweep  quick, full, or none: without it only bytes and first pictures
 * --parts  of the sweep, separated by commas: relief, environment, scaling, hard; all of them without
 *
 * The sweep goes to build/bench-web-DRIVER.json, in the same form as the program's.
 *
 * Bytes are those of the files that the page really fetched, compressed with gzip -9; scenes, their images and
 * thumbnails are the visitor's own and are not counted.
 */
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';

const kTargetBytes = 288592; // what model-viewer 4.4.0 ships, gzip -9
const kTargetMs = 1500;
const kSweeps = ['quick', 'full', 'none'];
const kParts = ['relief', 'environment', 'scaling', 'hard'];

const { values: options } = parseArgs({
  options: {
    site: { type: 'string', default: 'build/web/site' },
    runs: { type: 'string', default: '5' },
    driver: { type: 'string' },
    sweep: { type: 'string', default: 'quick' },
    parts: { type: 'string', default: kParts.join() },
  },
});
const wanted = options.parts.split(',');
check('--sweep', [options.sweep], kSweeps);
check('--parts', wanted, kParts);
process.env.LUCENT_SITE = options.site;

function check(option, values, known) {
  const odd = values.find((value) => !known.includes(value));
  if (odd === undefined) return;
  console.error(`bench_web: ${option} is "${odd}"; must be ${known.join(', ')}`);
  process.exit(1);
}

// Runs in the page: notes when the viewer's first picture is whole.
function watchFirstPicture() {
  const look = () => {
    if (document.querySelector('lucent-viewer')?.stats?.().complete) window.firstPicture = performance.now();
    else setTimeout(look, 5);
  };
  addEventListener('DOMContentLoaded', look);
}

async function measure({ openPage }, stage) {
  const times = [];
  let files = [];
  for (let run = 0; run < Number(options.runs); ++run) {
    const page = await openPage(stage, 'index.html', { init: watchFirstPicture, gallery: 'own' });
    await page.waitForFunction(() => window.firstPicture, null, { polling: 50 });
    times.push(await page.evaluate(() => window.firstPicture));
    files = await page.evaluate(() => [
      location.pathname,
      ...performance.getEntriesByType('resource').map(({ name }) => new URL(name).pathname),
    ]);
    await page.leave();
  }
  return { times: times.sort((a, b) => a - b), files };
}

// Works the benchmark page as a person does; a line whenever another part begins.
async function sweep({ openPage }, stage, driver) {
  const page = await openPage(stage, 'bench.html', { gallery: 'own' });
  for (const part of kParts) await page.setChecked(`input[name=${part}]`, wanted.includes(part));
  await page.setChecked('input[name=quick]', options.sweep === 'quick');
  await page.click('#start');
  for (let last = '', ended = false; !ended; ) {
    const line = await page.textContent('#part');
    const part = line.split(':').slice(0, -1).join(':');
    if (part !== last) console.log(`${driver}: ${line}`);
    last = part;
    await new Promise((done) => setTimeout(done, 500));
    ended = await page.isEnabled('#start');
  }
  const found = await page.evaluate(() => window.found);
  if (!found) throw new Error(`bench.html: ${await page.textContent('#part')}`);
  console.log(await page.textContent('#found'));
  await page.leave();
  const file = `build/bench-web-${driver}.json`;
  writeFileSync(file, JSON.stringify(found, null, 1) + '\n');
  console.log(`${driver}: wrote ${file}`);
}

function printFirstPicture(driver, { times, files }) {
  const ms = (value) => `${Math.round(value)} ms`;
  const spread = `${ms(times[0])} to ${ms(times.at(-1))}; target ${kTargetMs} ms`;
  console.log(`${driver}: first whole picture after ${ms(times[times.length >> 1])} (${spread})`);
  if (driver !== 'swiftshader') return;
  let sum = 0;
  for (const file of new Set(files.filter((name) => !name.includes('/gallery/')))) {
    const content = readFileSync(join(options.site, file.endsWith('/') ? 'index.html' : file));
    const bytes = gzipSync(content, { level: 9 }).length;
    console.log(`  ${file}: ${bytes} bytes compressed`);
    sum += bytes;
  }
  console.log(`  fetched before the page is interactive: ${sum} bytes compressed (target ${kTargetBytes})`);
}

for (const driver of options.driver ? [options.driver] : ['swiftshader', 'llvmpipe']) {
  process.env.LUCENT_DRIVER = driver;
  const support = await import(`../tests/web/support.mjs?driver=${driver}`);
  const stage = await support.openStage();
  printFirstPicture(driver, await measure(support, stage));
  if (options.sweep !== 'none') await sweep(support, stage, driver);
  await stage.close();
}
