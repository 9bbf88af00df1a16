/** Drops by mouse, finger, key and call, and the modes of the panel. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { boxOf, complete, openPage, openStage, openViewers, valueOf } from './support.mjs';

const kPond = '<lucent-viewer src="made/pond.json" controls="html" alt="Water over a floor"></lucent-viewer>';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

// A viewer of 240 x 240 CSS pixels over its controls: the pond's water fills the middle half of it.
async function open(options) {
  const page = await openViewers(stage, kPond, options);
  await page.evaluate(() => {
    const viewer = document.querySelector('lucent-viewer');
    Object.assign(viewer.style, { width: '240px', height: '480px' });
  });
  await page.waitForFunction(() => document.querySelector('lucent-viewer').stats?.().complete);
  // The lamp shines straight down: its dot would be gripped where drops are to fall.
  await page.evaluate(() => document.querySelector('lucent-viewer').set('view.lightDot', false));
  return page;
}

const paused = (page) => page.evaluate(() => document.querySelector('lucent-viewer').paused);
const pause = (page) => page.evaluate(() => document.querySelector('lucent-viewer').pause());

async function middleOf(page) {
  const { x, y, width, height } = await boxOf(page);
  return { x: x + width / 2, y: y + height / 2, left: x, top: y };
}

test('a click on water lets a drop fall and time runs; beside it a drag walks around', async () => {
  const page = await open();
  const { x, y, left, top } = await middleOf(page);
  const eye = await valueOf(page, 'camera.eye');
  await page.mouse.click(x, y);
  await page.waitForFunction(() => document.querySelector('lucent-viewer').get('view.time') > 0);
  assert.deepEqual(await valueOf(page, 'camera.eye'), eye);
  await pause(page);
  await complete(page);
  await page.mouse.move(left + 8, top + 8);
  await page.mouse.down();
  await page.mouse.move(left + 30, top + 8, { steps: 3 });
  await page.mouse.up();
  assert.notDeepEqual(await valueOf(page, 'camera.eye'), eye);
  assert.equal(await paused(page), true);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('a tap lets a drop fall', async () => {
  const page = await open({ hasTouch: true });
  const { x, y } = await middleOf(page);
  await page.touchscreen.tap(x, y);
  await page.waitForFunction(() => !document.querySelector('lucent-viewer').paused);
  await page.leave();
});

test('the key D and drop() do the same; drop() says where there is no water', async () => {
  const page = await open();
  const { x, y, left, top } = await middleOf(page);
  const drop = (px, py) =>
    page.evaluate(([a, b]) => document.querySelector('lucent-viewer').drop(a, b), [px - left, py - top]);
  assert.equal(await drop(left + 8, top + 8), false);
  assert.equal(await paused(page), true);
  assert.equal(await drop(x, y), true);
  assert.equal(await paused(page), false);
  await pause(page);
  await page.locator('lucent-viewer canvas').focus();
  await page.keyboard.press('d');
  assert.equal(await paused(page), false);
  await page.leave();
});

test('a mode puts its controls first and names whose they are', async () => {
  const page = await open();
  const rows = () =>
    page.evaluate(() =>
      [...document.querySelector('lucent-viewer').shadowRoot.querySelectorAll('[data-path]')].map((row) => row.dataset.path),
    );
  assert.deepEqual((await rows()).slice(0, 2), ['mode', 'technique.caustics.intersect']);
  await page.evaluate(() => (document.querySelector('lucent-viewer').mode = 'refraction'));
  assert.deepEqual((await rows()).slice(0, 2), ['mode', 'objects.water.material.transmission']);
  assert.equal(await page.getByRole('group', { name: 'Light samples' }).count(), 2); // those of lamps, and of pixels
  await page.leave();
});

test('the page shows a mode of the scene, or the first scene that has it', async () => {
  const page = await openPage(stage, 'blank.html'); // a page that knows another gallery would mend the link
  const entry = (id, kind) => ({ id, title: id, caption: '', kind, scene: `${id}.json`, thumbnail: 'small.png' });
  const gallery = JSON.stringify([entry('dome', 'Relief'), entry('pond', 'Caustics')]);
  await page.route('**/gallery/index.json', (route) => route.fulfill({ body: gallery }));
  await page.goto(new URL('index.html#scene=pond', stage.address).href);
  await page.waitForFunction(() => document.querySelector('lucent-viewer').loaded);
  const pressed = () => page.getByRole('button', { pressed: true }).allTextContents();
  await page.waitForFunction(() => document.querySelector('#modes [aria-pressed=true]'));
  assert.deepEqual(await pressed(), ['Caustics']);
  await page.getByRole('button', { name: 'Relief', exact: true }).click();
  await page.waitForFunction(() => document.querySelector('#title').textContent === 'A dome');
  assert.deepEqual(await pressed(), ['Relief']);
  assert.match(page.url(), /#scene=dome/); // not of the scene before
  await page.leave();
});
