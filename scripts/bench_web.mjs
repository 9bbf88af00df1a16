/**
 * What the page costs a visitor: bytes before it is interactive, and the time from navigation to the first whole
 * picture, in Chromium on both software drivers.
 *
 *   node scripts/bench_web.mjs [--site build/web/site] [--runs 5]
 *
 * Bytes are those of the files that the page really fetched, compressed with gzip -9; scenes, their images and
 * thumbnails are the visitor's own and are not counted.
 */
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';

const kTargetBytes = 288592; // what model-viewer 4.4.0 ships, gzip -9
const kTargetMs = 1500;

const { values: options } = parseArgs({
  options: { site: { type: 'string', default: 'build/web/site' }, runs: { type: 'string', default: '5' } },
});
process.env.LUCENT_SITE = options.site;

// Runs in the page: notes when the viewer's first picture is whole.
function watchFirstPicture() {
  const look = () => {
    if (document.querySelector('lucent-viewer')?.stats?.().complete) window.firstPicture = performance.now();
    else setTimeout(look, 5);
  };
  addEventListener('DOMContentLoaded', look);
}

async function measure(driver) {
  process.env.LUCENT_DRIVER = driver;
  const { openStage, openPage } = await import(`../tests/web/support.mjs?driver=${driver}`);
  const stage = await openStage();
  const times = [];
  let files = [];
  for (let run = 0; run < Number(options.runs); ++run) {
    const page = await openPage(stage, 'index.html', { init: watchFirstPicture, gallery: 'own' });
    await page.waitForFunction(() => window.firstPicture, null, { polling: 50 });
    times.push(await page.evaluate(() => window.firstPicture));
    files = await page.evaluate(() => [location.pathname, ...performance.getEntriesByType('resource').map(({ name }) => new URL(name).pathname)]);
    await page.leave();
  }
  await stage.close();
  return { times: times.sort((a, b) => a - b), files };
}

for (const driver of ['swiftshader', 'llvmpipe']) {
  const { times, files } = await measure(driver);
  const ms = (value) => `${Math.round(value)} ms`;
  console.log(`${driver}: first whole picture after ${ms(times[times.length >> 1])} (${ms(times[0])} to ${ms(times.at(-1))}; target ${kTargetMs} ms)`);
  if (driver !== 'swiftshader') continue;
  let sum = 0;
  for (const file of new Set(files.filter((name) => !name.includes('/gallery/')))) {
    const bytes = gzipSync(readFileSync(join(options.site, file.endsWith('/') ? 'index.html' : file)), { level: 9 }).length;
    console.log(`  ${file}: ${bytes} bytes compressed`);
    sum += bytes;
  }
  console.log(`  fetched before the page is interactive: ${sum} bytes compressed (target ${kTargetBytes})`);
}
