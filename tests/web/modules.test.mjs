/** A page fetches the module that its scenes need: that of reliefs, the whole one, or first the one and then the other. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { kScenes } from './scenes.mjs';
import { complete, difference, eventOf, openStage, openViewers, pictureOf } from './support.mjs';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

/** A page with a viewer that shows a scene. */
async function open(src) {
  const page = await openViewers(stage, `<lucent-viewer src="${src}"></lucent-viewer>`);
  await page.evaluate(() =>
    Object.assign(document.querySelector('lucent-viewer').style, { width: '300px', height: '200px' }),
  );
  await complete(page);
  return page;
}
/** Modules that a page has fetched, in order. */
const modulesOf = (page) =>
  page.evaluate(() =>
    performance
      .getEntriesByType('resource')
      .map(({ name }) => name.split('/').pop())
      .filter((name) => name.endsWith('.wasm')),
  );
const load = (page, src) => page.evaluate((address) => (document.querySelector('lucent-viewer').src = address), src);
const titleOf = (page) => page.evaluate(() => document.querySelector('lucent-viewer').sceneTitle);

test('a relief fetches the module that draws reliefs alone', async () => {
  const page = await open('made/dome.json');
  assert.deepEqual(await modulesOf(page), ['lucent-relief.wasm']);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('glass fetches the whole module alone', async () => {
  const page = await open('made/bead.json');
  assert.deepEqual(await modulesOf(page), ['lucent.wasm']);
  await page.leave();
});

test('a relief makes way for glass, and the whole module draws it to the bit alike', async () => {
  const page = await open('made/ridge.json');
  const ridge = await pictureOf(page);
  await eventOf(page, 'load', () => load(page, 'made/bead.json'));
  assert.deepEqual(await modulesOf(page), ['lucent-relief.wasm', 'lucent.wasm']);
  await complete(page);
  await eventOf(page, 'load', () => load(page, 'made/ridge.json'));
  await complete(page);
  assert.deepEqual(difference(ridge, await pictureOf(page)), { max: 0, mean: 0, share: 0 });
  assert.deepEqual(await modulesOf(page), ['lucent-relief.wasm', 'lucent.wasm']);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('a wrong scene of the other module leaves the relief with what was changed', async () => {
  const page = await open('made/ridge.json');
  await page.evaluate(() => document.querySelector('lucent-viewer').set('lights.0.intensity', 0.5));
  await complete(page);
  const changed = await pictureOf(page);
  const wrong = JSON.parse(kScenes['bead.json']);
  wrong.objects[0].shape.type = 'tesseract';
  await page.route('**/made/wrong.json', (route) => route.fulfill({ body: JSON.stringify(wrong) }));
  const { code } = await eventOf(page, 'error', () => load(page, 'made/wrong.json'));
  assert.equal(code, 'scene');
  assert.equal(await titleOf(page), 'A ridge');
  assert.equal(await page.evaluate(() => document.querySelector('lucent-viewer').get('lights.0.intensity')), 0.5);
  await page.evaluate(() => document.querySelector('lucent-viewer').set('lights.0.intensity', 0.25));
  await page.evaluate(() => document.querySelector('lucent-viewer').set('lights.0.intensity', 0.5));
  await complete(page);
  assert.deepEqual(difference(changed, await pictureOf(page)), { max: 0, mean: 0, share: 0 });
  await page.leave();
});

test('a relief that is made glass goes on in the whole module, with what was changed', async () => {
  const page = await open('made/ridge.json');
  const kind = 'objects.relief.material.kind';
  const set = (path, value) =>
    page.evaluate((pair) => document.querySelector('lucent-viewer').set(...pair), [path, value]);
  await set('view.exposure', 1.5);
  await eventOf(page, 'load', () => set(kind, 'clear'));
  await complete(page);
  assert.ok((await modulesOf(page)).includes('lucent.wasm'));
  const changes = await page.evaluate(() => document.querySelector('lucent-viewer').changes);
  assert.equal(changes[kind], 'clear');
  assert.equal(changes['view.exposure'], '1.5');
  const glass = await pictureOf(page);
  const relief = await open('made/ridge.json');
  await relief.evaluate(() => document.querySelector('lucent-viewer').set('view.exposure', 1.5));
  await complete(relief);
  assert.ok(difference(glass, await pictureOf(relief), 8).share > 0.2);
  await page.evaluate(() => document.querySelector('lucent-viewer').undo());
  await complete(page);
  await page.leave();
  await relief.leave();
});

test('a mesh that is dropped on a relief brings the whole module', async () => {
  const page = await open('made/dome.json');
  const triangle = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n';
  await eventOf(page, 'load', () =>
    page.evaluate((text) => document.querySelector('lucent-viewer').openFile(new File([text], 'one.obj')), triangle),
  );
  await complete(page);
  assert.ok((await modulesOf(page)).includes('lucent.wasm'));
  assert.deepEqual(page.problems, []);
  await page.leave();
});
