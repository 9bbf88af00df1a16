/** The product page as a person meets it. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import {
  boxOf,
  brightness,
  complete,
  difference,
  drawsOf,
  eventOf,
  openPage,
  openStage,
  openViewers,
  pictureOf,
  quiet,
  shownBy,
  valueOf,
} from './support.mjs';

const kGlow = 'objects.relief.material.forwardScatter';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

test('the page shows its first scene without an error or a breach of its policy', async () => {
  const page = await openPage(stage);
  await complete(page);
  const picture = await pictureOf(page);
  assert.ok(brightness(picture) > 10, `brightness ${brightness(picture)} of 255`);
  assert.equal(await page.textContent('#title'), 'A dome');
  assert.equal(await page.textContent('#caption'), 'A dome, lit from the left.');
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
});

test('an idle page draws nothing and asks for no frame', async () => {
  const page = await openPage(stage);
  await complete(page);
  const counts = async () => [await drawsOf(page), await page.evaluate(() => window.seen.frames)];
  const earlier = await counts();
  await page.waitForTimeout(1000);
  assert.deepEqual(await counts(), earlier);
  await page.leave();
});

test('a link carries what was changed and gives the same picture', async () => {
  const page = await openPage(stage);
  await complete(page);
  await page.evaluate(([path]) => document.querySelector('lucent-viewer').set(path, 0.75), [kGlow]);
  await page.waitForFunction(() => location.hash.includes('forwardScatter'));
  await complete(page);
  const picture = await pictureOf(page);
  const link = await page.evaluate(() => location.hash);
  assert.equal(link, `#scene=dome&${kGlow}=0.75`);
  const other = await openPage(stage, 'index.html' + link);
  await complete(other);
  assert.equal(await valueOf(other, kGlow), 0.75);
  assert.deepEqual(difference(await pictureOf(other), picture, 0), { max: 0, mean: 0, share: 0 });
  await page.leave();
  await other.leave();
});

test('a card of the gallery shows its scene, and the way back leads to the first', async () => {
  const page = await openPage(stage);
  await complete(page);
  await page.click('#gallery a[data-id=ridge]');
  await page.waitForFunction(() => document.querySelector('#title').textContent === 'A ridge');
  assert.equal(await page.evaluate(() => location.hash), '#scene=ridge');
  await page.goBack();
  await page.waitForFunction(() => document.querySelector('#title').textContent === 'A dome');
  await page.leave();
});

test('reset, undo and redo do what they say', async () => {
  const page = await openPage(stage);
  await complete(page);
  const glow = () => valueOf(page, kGlow);
  await page.evaluate(([path]) => document.querySelector('lucent-viewer').set(path, 0.75), [kGlow]);
  await page.click('#undo');
  assert.equal(await glow(), 0);
  await page.click('#redo');
  assert.equal(await glow(), 0.75);
  await page.click('#reset');
  assert.equal(await glow(), 0);
  await page.leave();
});

test('Save PNG hands out the picture without the panel at the size of the canvas', async () => {
  const page = await openPage(stage);
  await complete(page);
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#save')]);
  assert.equal(download.suggestedFilename(), 'dome.png');
  const png = readFileSync(await download.path());
  const { width, height } = await boxOf(page);
  assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [width, height]); // of the chunk IHDR
  await page.leave();
});

test('the frame time is shown on request only', async () => {
  const page = await openPage(stage);
  await complete(page);
  assert.equal(await page.textContent('#cost'), '');
  await page.check('#time');
  assert.match(await page.textContent('#cost'), /^[\d.]+ ms, \d+ passes, \d+ draws, 1 lights, [\d.]+ MB$/);
  await page.leave();
});

test('a phone sees the whole width and can scroll to the gallery', async () => {
  const page = await openPage(stage, 'index.html', {
    viewport: { width: 390, height: 844 },
    deviceScaleFactor: 2,
    hasTouch: true,
  });
  await complete(page);
  const [width, height] = await page.evaluate(() => [
    document.documentElement.scrollWidth,
    document.documentElement.scrollHeight,
  ]);
  assert.equal(width, 390);
  assert.ok(height > 844, `page height ${height}`);
  await page.leave();
});

test('dark pages get a dark panel', async () => {
  const corner = { light: 0, dark: 0 };
  for (const colorScheme of ['light', 'dark']) {
    const page = await openPage(stage, 'index.html', { colorScheme });
    await complete(page);
    await quiet(page);
    corner[colorScheme] = brightness(await shownBy(page), [0.85, 0.1, 0.95, 0.9]); // the panel is docked at the right
    await page.leave();
  }
  assert.ok(corner.light > corner.dark + 80, `light ${corner.light}, dark ${corner.dark}`);
});

test('the page of examples shows two scenes of the gallery with one context', async () => {
  const page = await openPage(stage, 'example.html', { gallery: 'own', viewport: { width: 900, height: 2400 } });
  await complete(page, '#first');
  await complete(page, '#second');
  assert.equal(await page.evaluate(() => window.seen.contexts.length), 1);
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
});

test('every scene of the gallery comes to a finished picture', async () => {
  const page = await openViewers(stage, '<lucent-viewer></lucent-viewer>', { gallery: 'own' });
  const scenes = await page.evaluate(async () => {
    Object.assign(document.querySelector('lucent-viewer').style, { width: '128px', height: '128px' });
    return (await (await fetch('gallery/index.json')).json()).map(({ scene }) => scene);
  });
  assert.ok(scenes.length >= 4, `${scenes.length} scenes`);
  for (const scene of scenes) {
    await eventOf(page, 'load', () =>
      page.evaluate((name) => (document.querySelector('lucent-viewer').src = 'gallery/' + name), scene),
    );
    await complete(page);
    const range = spread(await pictureOf(page));
    assert.ok(range > 40, `${scene}: values spread over ${range} of 255`);
  }
  assert.deepEqual(page.problems, []);
  await page.leave();
});

// Difference between the darkest and the brightest value of a picture: an empty one has none.
function spread({ pixels }) {
  let low = 255;
  let high = 0;
  for (let at = 0; at < pixels.length; at += 4) {
    low = Math.min(low, pixels[at + 1]);
    high = Math.max(high, pixels[at + 1]);
  }
  return high - low;
}
