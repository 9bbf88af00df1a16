/**
 * How long the page does not answer: for each scene of the gallery when its first preview and its finished picture are
 * there, the longest tasks (ms) while it loads and while its light or camera is dragged for four seconds, and how many
 * pictures a second are drawn and shown then: those that are reprojected are shown, not drawn. First what the machine
 * itself needs: the tasks of a page with an empty viewer. In Chromium, as the tests run it.
 *
 *   node scripts/long_tasks.mjs [--site build/web/site] [--driver swiftshader|llvmpipe] [--size 640x480] [SCENE...]
 */
import { parseArgs } from 'node:util';

const kTarget = 100; // ms
const kDragMs = 4000;
const kPatience = 180000; // ms

const { values: options, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    site: { type: 'string', default: 'build/web/site' },
    driver: { type: 'string', default: 'llvmpipe' },
    size: { type: 'string', default: '640x480' },
  },
});
const size = options.size.match(/^(\d+)x(\d+)$/)?.slice(1).map(Number);
if (!size) throw new Error(`--size is "${options.size}"; must be WIDTHxHEIGHT`);
Object.assign(process.env, { LUCENT_SITE: options.site, LUCENT_DRIVER: options.driver });
const { openStage, openViewers } = await import('../tests/web/support.mjs');

// Runs in the page: notes tasks over 50 ms, which is what browsers tell of.
function noteTasks() {
  window.tasks = [];
  new PerformanceObserver((list) => window.tasks.push(...list.getEntries().map(({ duration }) => Math.round(duration)))).observe(
    { entryTypes: ['longtask'] },
  );
}

// Runs in the page. @return ms from the request to the first preview and to the finished picture
async function load([source, [width, height], patience]) {
  const viewer = document.querySelector('lucent-viewer');
  Object.assign(viewer.style, { width: `${width}px`, height: `${height}px` });
  const start = performance.now();
  const past = () => Math.round(performance.now() - start);
  let first;
  viewer.addEventListener('frame', () => (first ??= viewer.stats().shown ? past() : undefined));
  viewer.src = source;
  while (!viewer.stats().finished && past() < patience) await new Promise((done) => setTimeout(done, 50));
  return { first, finished: viewer.stats().finished ? past() : Infinity };
}

async function drag(page) {
  const { x, y, width, height } = await page.locator('lucent-viewer').boundingBox();
  const [left, middle] = [x + width / 2 - 60, y + height / 2];
  await page.mouse.move(left, middle);
  await page.mouse.down();
  const start = Date.now();
  for (let step = 0; Date.now() - start < kDragMs; ++step) {
    await page.mouse.move(left + (step % 120), middle + 10 * Math.sin(step / 9));
    await page.waitForTimeout(30);
  }
  await page.mouse.up();
}

const openEmpty = (stage) =>
  openViewers(stage, '<lucent-viewer></lucent-viewer>', { gallery: 'own', init: noteTasks });
const takeTasks = (page) => page.evaluate(() => window.tasks.splice(0).sort((a, b) => b - a));
const longest = (tasks) => tasks.slice(0, 4).join(' ') || 'none';

async function measureEmpty(stage) {
  const page = await openEmpty(stage);
  await page.waitForTimeout(1000);
  const found = await takeTasks(page);
  await page.leave();
  return found;
}

async function measure(stage, scene) {
  const page = await openEmpty(stage);
  page.setDefaultTimeout(2 * kPatience);
  await page.waitForTimeout(1000);
  await takeTasks(page); // those of the empty viewer
  const times = await page.evaluate(load, [`gallery/${scene}`, size, kPatience]);
  const loading = await takeTasks(page);
  await page.evaluate(() => {
    const viewer = document.querySelector('lucent-viewer');
    let last = viewer.stats().milliseconds; // that a picture took
    window.drawn = 0;
    window.before = viewer.stats().pictures;
    viewer.addEventListener('frame', () => {
      const { milliseconds } = viewer.stats();
      if (milliseconds !== last) ++window.drawn;
      last = milliseconds;
    });
  });
  await drag(page);
  const [shown, drawn] = await page.evaluate(() => [
    document.querySelector('lucent-viewer').stats().pictures - window.before,
    window.drawn,
  ]);
  const rates = [shown, drawn].map((pictures) => pictures / (kDragMs / 1000));
  const found = { ...times, loading, dragging: await takeTasks(page), rates };
  await page.leave();
  return found;
}

const stage = await openStage();
const list = await (await fetch(new URL('gallery/index.json', stage.address))).json();
const scenes = positionals.length ? positionals.map((name) => `${name}.json`) : list.map(({ scene }) => scene);
console.log(`${options.driver}, ${options.size}; tasks in ms, target ${kTarget}`);
let met = 0;
const report = (name, tasks, line) => {
  const isMet = Math.max(0, ...tasks) <= kTarget;
  met += isMet;
  console.log(`${name.padEnd(24)} ${line}${isMet ? '' : '  MISSED'}`);
};
const empty = await measureEmpty(stage);
report('an empty viewer', empty, longest(empty));
for (const scene of scenes) {
  const { first, finished, loading, dragging, rates } = await measure(stage, scene);
  report(
    scene.replace('.json', ''),
    [...loading, ...dragging],
    `first ${first}, finished ${finished}; loading ${longest(loading)}; ` +
      `dragging ${longest(dragging)}, ${rates[0].toFixed(1)} pictures/s, ${rates[1].toFixed(1)} drawn`,
  );
}
console.log(`${met} of ${scenes.length + 1} pages keep the target`);
await stage.close();
