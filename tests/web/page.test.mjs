/** The product page as a person meets it. */
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { kScenes } from './scenes.mjs';
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
  spread,
  valueOf,
} from './support.mjs';

const kDocs = readdirSync('web/docs').filter((name) => name.endsWith('.html'));
const kGlow = 'objects.relief.material.forwardScatter';

// Those that leave the page as they found it share one.
let stage;
let shared;
before(async () => {
  stage = await openStage();
  shared = await openPage(stage);
  await complete(shared);
});
after(() => stage.close());

test('the page shows its first scene without an error or a breach of its policy', async () => {
  const picture = await pictureOf(shared);
  assert.ok(brightness(picture) > 10, `brightness ${brightness(picture)} of 255`);
  assert.equal(await shared.textContent('#title'), 'A dome');
  assert.equal(await shared.textContent('#caption'), 'A dome, lit from the left.');
  assert.deepEqual(shared.problems, []);
  assert.deepEqual(await shared.violations(), []);
});

test('an idle page draws nothing and asks for no frame', async () => {
  const counts = async () => [await drawsOf(shared), await shared.evaluate(() => window.seen.frames)];
  await quiet(shared); // what saved its picture has shown the panel again
  const earlier = await counts();
  await shared.waitForTimeout(1000);
  assert.deepEqual(await counts(), earlier);
});

test('a link carries what was changed and gives the same picture', async () => {
  await shared.evaluate(([path]) => document.querySelector('lucent-viewer').set(path, 0.75), [kGlow]);
  await shared.waitForFunction(() => location.hash.includes('forwardScatter'));
  await complete(shared);
  const picture = await pictureOf(shared);
  const link = await shared.evaluate(() => location.hash);
  assert.equal(link, `#scene=dome&${kGlow}=0.75`);
  const other = await openPage(stage, 'index.html' + link);
  await complete(other);
  assert.equal(await valueOf(other, kGlow), 0.75);
  assert.deepEqual(difference(await pictureOf(other), picture, 0), { max: 0, mean: 0, share: 0 });
  await shared.click('#reset');
  await other.leave();
});

test('a card of the gallery shows its scene, and the way back leads to the first', async () => {
  await shared.click('#gallery a[data-id=ridge]');
  await shared.waitForFunction(() => document.querySelector('#title').textContent === 'A ridge');
  assert.equal(await shared.evaluate(() => location.hash), '#scene=ridge');
  await shared.goBack();
  await shared.waitForFunction(() => document.querySelector('#title').textContent === 'A dome');
  await complete(shared);
});

test('reset, undo and redo do what they say', async () => {
  const glow = () => valueOf(shared, kGlow);
  await shared.evaluate(([path]) => document.querySelector('lucent-viewer').set(path, 0.75), [kGlow]);
  await shared.click('#undo');
  assert.equal(await glow(), 0);
  await shared.click('#redo');
  assert.equal(await glow(), 0.75);
  await shared.click('#reset');
  assert.equal(await glow(), 0);
});

test('Save picture hands out the picture without the panel at the size of the canvas', async () => {
  await shared.click('#save');
  const [download] = await Promise.all([shared.waitForEvent('download'), shared.click('dialog[open] button:text("Save")')]);
  assert.equal(download.suggestedFilename(), 'dome.png');
  const png = readFileSync(await download.path());
  const { width, height } = await boxOf(shared);
  assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [width, height]); // of the chunk IHDR
  await shared.click('dialog[open] button:text("Close")');
});

test('the frame time is shown on request only', async () => {
  assert.equal(await shared.textContent('#cost'), '');
  await shared.check('#time');
  assert.match(await shared.textContent('#cost'), /^[\d.]+ ms, \d+ passes, \d+ draws, 1 lights, [\d.]+ MB$/);
  await shared.uncheck('#time');
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

/** What reaches beyond the window's right side. */
const wideThings = (page) =>
  page.evaluate(() => {
    const isScrolled = (one) => one && (/auto|scroll|hidden/.test(getComputedStyle(one).overflowX) || isScrolled(one.parentElement));
    return [...document.querySelectorAll('body *')]
      .filter((one) => one.getBoundingClientRect().right > innerWidth + 0.5 && !isScrolled(one.parentElement))
      .map((one) => `${one.tagName} ${one.id || one.className}`);
  });

test('the whole gallery and its modes fit beside and below each other at any width', async () => {
  const page = await openPage(stage, 'index.html', { gallery: 'own' });
  for (const width of [390, 640, 700]) {
    await page.setViewportSize({ width, height: 700 });
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
  }
  assert.ok((await page.locator('.modes button').count()) > 4);
  await page.leave();
});

test('no page scrolls sideways on 390 pixels', async () => {
  for (const path of ['index.html', 'example.html', 'bench.html', ...kDocs.map((name) => `docs/${name}`)]) {
    const page = await openPage(stage, path, { viewport: { width: 390, height: 844 }, hasTouch: true });
    await page.waitForTimeout(300);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390, path);
    assert.deepEqual(await wideThings(page), [], path);
    await page.leave();
  }
});

test('dialogs fit into a window of 390 x 640 pixels', async () => {
  const page = await openPage(stage, 'index.html', { viewport: { width: 390, height: 640 }, visits: 0 });
  const fits = async (selector) => {
    const box = await page.locator(selector).boundingBox();
    assert.ok(box.x >= 0 && box.x + box.width <= 390, `${selector}: x ${box.x}, ${box.width} wide`);
    assert.ok(box.y >= 0 && box.y + box.height <= 640, `${selector}: y ${box.y}, ${box.height} high`);
  };
  await page.waitForSelector('.tour');
  await fits('.tour');
  assert.ok(await page.locator('.tour').evaluate((one) => one.scrollHeight <= one.clientHeight + 1), 'it is one screen');
  await page.click('.tour button');
  await complete(page);
  await page.click('#save');
  await page.waitForSelector('dialog.picture[open]');
  await fits('dialog.picture');
  assert.ok(await page.locator('dialog.picture').evaluate((one) => one.scrollWidth <= one.clientWidth), 'nothing is cut');
  await page.keyboard.press('Escape');
  await page.click('#check');
  await page.waitForSelector('dialog.lucent-check');
  await fits('dialog.lucent-check');
  await page.click('dialog.lucent-check [data-do=close]');
  await page.leave();
});

test('the tour is shown once, and again when asked for', async () => {
  const page = await openPage(stage, 'index.html', { visits: 0 });
  await page.waitForSelector('dialog.tour[open]');
  assert.equal(await page.locator('.tour li').count(), 4);
  await page.keyboard.press('Escape');
  await page.waitForSelector('.tour', { state: 'detached' });
  await page.reload();
  await complete(page);
  assert.equal(await page.locator('.tour').count(), 0);
  await page.click('#tour');
  await page.waitForSelector('dialog.tour[open]');
  await page.click('.tour button');
  await page.waitForSelector('.tour', { state: 'detached' });
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
});

test('a printed page keeps the proportions of its picture', async () => {
  const page = await openPage(stage, 'index.html', { viewport: { width: 1200, height: 500 } });
  await complete(page);
  await page.emulateMedia({ media: 'print' });
  const { fit, hidden } = await page.evaluate(() => {
    const root = document.querySelector('lucent-viewer').shadowRoot;
    const style = (one) => getComputedStyle(one);
    return {
      fit: style(root.querySelector('canvas')).objectFit,
      hidden: ['.toolbar', '#gallery', '.modes'].map((one) => style(document.querySelector(one)).display),
    };
  });
  assert.equal(fit, 'contain');
  assert.deepEqual(hidden, ['none', 'none', 'none']);
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

// Those that pictures.test.mjs holds against the program's pictures are finished there, on both drivers. Here every pass
// is to run, however often it runs: few samples do, of one scene of each kind. A preview is shown of all others.
const kFewSamples = { pixelSamples: 1, directions: 6, lampSamples: 1 };
const kFewDirections = 4; // of an environment whose caustics are drawn
const kNative = process.env.LUCENT_NATIVE;
const kCompared = kNative ? readdirSync(kNative).map((name) => name.replace('.png', '.json')) : [];

test('every scene of the gallery is shown, and one of each kind comes to a finished picture', async () => {
  const page = await openViewers(stage, '<lucent-viewer></lucent-viewer>', { gallery: 'own' });
  const scenes = await page.evaluate(async () => {
    Object.assign(document.querySelector('lucent-viewer').style, { width: '128px', height: '128px' });
    return (await fetch('gallery/index.json')).json();
  });
  assert.ok(scenes.length >= 4, `${scenes.length} scenes`);
  const left = scenes.filter(({ scene }) => !kCompared.includes(scene));
  const isFirst = ({ kind }, at) => left.findIndex((one) => one.kind === kind) === at;
  await page.route('**/gallery/*.json', async (route) => {
    const response = await route.fetch();
    const json = await response.json();
    if (json.lucent) json.technique = { ...json.technique, sampling: { ...json.technique?.sampling, ...kFewSamples } };
    if (json.technique?.caustics?.environmentDirections) json.technique.caustics.environmentDirections = kFewDirections;
    await route.fulfill({ response, json });
  });
  const firsts = left.filter(isFirst);
  for (const { scene } of left) {
    await eventOf(page, 'load', () =>
      page.evaluate((name) => (document.querySelector('lucent-viewer').src = 'gallery/' + name), scene),
    );
    if (!firsts.some((one) => one.scene === scene)) {
      await page.waitForFunction(() => document.querySelector('lucent-viewer').stats().shown);
      continue;
    }
    await complete(page);
    const range = spread(await pictureOf(page));
    assert.ok(range > 40, `${scene}: values spread over ${range} of 255`);
  }
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('what is still being made says so, and comes into the page when it is there', async () => {
  const [dome, ridge] = JSON.parse(kScenes['index.json']);
  const { poster, thumbnail, ...bare } = dome;
  const early = [{ ...ridge, making: ['scene', 'truth'] }, { ...bare, making: ['picture', 'truth'] }];
  let list = early;
  const page = await openPage(stage, 'blank.html');
  await page.route('**/gallery/index.json', (route) => route.fulfill({ body: JSON.stringify(list) }));
  await page.goto(new URL('index.html#scene=ridge', stage.address).href);
  // The first scene that can be shown stands in for the one that cannot yet.
  await page.waitForFunction(() => document.querySelector('#title').textContent === 'A dome');
  assert.equal(await page.textContent('#gallery [data-id=dome] span'), 'Picture being made');
  assert.equal(await page.getAttribute('#gallery [data-id=ridge]', 'aria-disabled'), 'true');
  assert.match(await page.textContent('#making'), /^Being made: 1 scene, 1 picture, 2 exact solutions;/);
  await page.selectOption('#compare', 'truth');
  assert.match(await page.textContent('#making'), /^The exact solution of this scene is being made\. Being made:/);
  list = [ridge, dome];
  await page.waitForSelector('#gallery [data-id=dome] img');
  assert.equal(await page.getAttribute('#gallery [data-id=ridge]', 'aria-disabled'), null);
  assert.equal(await page.textContent('#making'), '');
  await page.leave();
});
