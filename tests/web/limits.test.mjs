/** What no scene can do to a page: end its viewers, reach beyond its folder, stay after its element is gone. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { kScenes } from './scenes.mjs';
import { complete, difference, eventOf, openStage, openViewers, pictureOf } from './support.mjs';

const kTwo = '<lucent-viewer id="one" src="made/dome.json"></lucent-viewer><lucent-viewer id="two"></lucent-viewer>';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

async function open(markup, options) {
  const page = await openViewers(stage, markup, { viewport: { width: 900, height: 700 }, ...options });
  await page.evaluate(() => {
    for (const viewer of document.querySelectorAll('lucent-viewer'))
      Object.assign(viewer.style, { width: '300px', height: '200px' });
  });
  return page;
}

/** Serves a scene as made/own.json, and a dome's heights at any address beneath elsewhere/. */
async function offer(page, scene) {
  await page.route('**/made/own.json', (route) => route.fulfill({ body: JSON.stringify(scene) }));
  await page.route('**/elsewhere/**', (route) => route.fulfill({ body: kScenes['dome.pfm'] }));
}

const load = (page, src, selector = '#two') =>
  page.evaluate(([one, address]) => (document.querySelector(one).src = address), [selector, src]);

const reliefOf = (heights) => {
  const scene = JSON.parse(kScenes['dome.json']);
  scene.objects[0].shape.heights = heights;
  return scene;
};
const seaOf = (cells) => ({ lucent: 1, objects: [{ name: 'sea', shape: { type: 'water', cells } }] });

test('water that does not fit into memory is refused by name, and no other viewer notices', async () => {
  const page = await open(kTwo);
  await complete(page, '#one');
  const picture = await pictureOf(page, '#one');
  await offer(page, seaOf(4096));
  const detail = await eventOf(page, 'error', () => load(page, 'made/own.json'), '#two');
  assert.deepEqual(detail, {
    code: 'scene',
    message:
      'own.json:1: objects.sea.shape.cells is 4096: with it all objects take about 3.8 GiB of memory; must take at ' +
      'most 1 GiB',
  });
  await load(page, 'made/pond.json');
  await complete(page, '#two');
  const set = await eventOf(
    page,
    'error',
    () => page.evaluate(() => document.querySelector('#two').set('objects.water.shape.cells', 4096)),
    '#two',
  );
  assert.equal(set.code, 'value');
  assert.match(set.message, /^objects\.water\.shape\.cells is 4096: with it/);
  assert.deepEqual(difference(picture, await pictureOf(page, '#one')), { max: 0, mean: 0, share: 0 });
  await page.leave();
});

test('the most cells that are not refused are drawn', async () => {
  const page = await open(kTwo);
  await complete(page, '#one');
  await offer(page, seaOf(2047));
  await load(page, 'made/own.json');
  await complete(page, '#two');
  assert.deepEqual(page.problems, []);
  await page.leave();
});

// Runs in the page first: while window.full is true, the module that wants more memory gets none, then and later.
function refuseMemory() {
  const { grow } = WebAssembly.Memory.prototype;
  const refused = new WeakSet();
  WebAssembly.Memory.prototype.grow = function (pages) {
    if (window.full) refused.add(this);
    window.full = false;
    if (refused.has(this)) throw new RangeError('no memory is left');
    return grow.call(this, pages);
  };
}

test('a module that ends says so to all viewers and begins anew', async () => {
  const page = await open(kTwo.replace('dome', 'bead'), { init: refuseMemory });
  await complete(page, '#one');
  const picture = await pictureOf(page, '#one');
  await offer(page, seaOf(1024));
  await page.evaluate(() => {
    window.errors = [];
    for (const viewer of document.querySelectorAll('lucent-viewer'))
      viewer.addEventListener('error', ({ detail }) => window.errors.push([viewer.id, detail.code]));
    window.full = true;
  });
  const loaded = eventOf(page, 'load', () => load(page, 'made/own.json'), '#one'); // again, by itself
  await loaded;
  assert.deepEqual(await page.evaluate(() => window.errors.sort()), [
    ['one', 'abort'],
    ['two', 'abort'],
  ]);
  await complete(page, '#one');
  assert.deepEqual(difference(picture, await pictureOf(page, '#one')), { max: 0, mean: 0, share: 0 });
  assert.equal(await page.evaluate(() => document.querySelector('#two').loaded), false);
  await load(page, 'made/ridge.json');
  await complete(page, '#two');
  assert.equal(await page.evaluate(() => document.querySelector('#two').sceneTitle), 'A ridge');
  await page.leave();
});

test('a scene names nothing outside its folder', async () => {
  const page = await open(kTwo);
  const asked = [];
  page.on('request', (request) => asked.push(request.url()));
  for (const heights of [
    '../elsewhere/dome.pfm',
    '%2e%2e/elsewhere/dome.pfm',
    '..%2felsewhere/dome.pfm',
    '..\\elsewhere\\dome.pfm',
    '/elsewhere/dome.pfm',
    'https://elsewhere.test/dome.pfm',
    '//elsewhere.test/dome.pfm',
  ]) {
    await offer(page, reliefOf(heights));
    const detail = await eventOf(page, 'error', () => load(page, 'made/own.json'), '#two');
    assert.equal(detail.code, 'scene', heights);
    const folder = new URL('made/', stage.address).href;
    assert.equal(
      detail.message,
      `${heights}: lies outside ${folder}; must lie beneath it, or beneath an address that allow names`,
    );
    await page.unroute('**/made/own.json');
  }
  assert.deepEqual(
    asked.filter((url) => url.includes('elsewhere')),
    [],
  );
  await page.leave();
});

test('the attribute allow adds folders', async () => {
  const page = await open(kTwo);
  await offer(page, reliefOf('../elsewhere/dome.pfm'));
  await page.evaluate(() => (document.querySelector('#two').allow = 'https://models.test/ elsewhere/'));
  await load(page, 'made/own.json');
  await complete(page, '#two');
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('an element that is removed while it loads is forgotten', async () => {
  const page = await open(kTwo);
  await complete(page, '#one');
  let answer;
  const asked = new Promise((done) => {
    page.route('**/made/own.json', (route) => {
      answer = () => route.fulfill({ body: kScenes['dome.json'] });
      done();
    });
  });
  await page.evaluate(() => {
    window.gone = document.querySelector('#two');
    window.heard = [];
    for (const type of ['load', 'error', 'contextlost']) window.gone.addEventListener(type, () => window.heard.push(type));
    window.gone.src = 'made/own.json';
  });
  await asked;
  await page.evaluate(() => window.gone.remove());
  await answer();
  await new Promise((done) => setTimeout(done, 500));
  const lost = eventOf(
    page,
    'contextlost',
    () => page.evaluate(() => window.seen.contexts[0].getExtension('WEBGL_lose_context').loseContext()),
    '#one',
  );
  await lost;
  assert.deepEqual(await page.evaluate(() => window.heard), []);
  await page.leave();
});
