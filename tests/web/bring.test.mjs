/** Files that a person drops or opens: each becomes a scene of its own, with its own name everywhere. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { colorPng, glassTriangle, greyPng } from './scenes.mjs';
import {
  brightness,
  clickOnce,
  complete,
  difference,
  eventOf,
  openPage,
  openStage,
  openViewers,
  pictureOf,
  spread,
  valueOf,
} from './support.mjs';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

async function open(width = 400, height = 300) {
  const page = await openViewers(stage, '<lucent-viewer src="made/dome.json" alt="A dome"></lucent-viewer>');
  await page.evaluate(
    ([w, h]) => Object.assign(document.querySelector('lucent-viewer').style, { width: `${w}px`, height: `${h}px` }),
    [width, height],
  );
  await complete(page);
  return page;
}

const kLeft = 0.25; // of the viewer's width: where a new scene is dropped,
const kRight = 0.75; // and an environment

// Drops files by name at a place of the viewer, as a person does: first over it, then let go.
async function drop(page, files, share = kLeft) {
  await page.evaluate(
    ([contents, part]) => {
      const viewer = document.querySelector('lucent-viewer');
      const transfer = new DataTransfer();
      for (const [name, text] of contents)
        transfer.items.add(new File([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], name));
      const box = viewer.getBoundingClientRect();
      const place = {
        clientX: box.left + part * box.width,
        clientY: box.top + 50,
        dataTransfer: transfer,
        bubbles: true,
        cancelable: true,
      };
      viewer.dispatchEvent(new DragEvent('dragover', place));
      window.zones = [...viewer.shadowRoot.querySelectorAll('.zones.shown > *')].map((zone) => [
        zone.textContent,
        zone.className,
      ]);
      viewer.dispatchEvent(new DragEvent('drop', place));
    },
    [Object.entries(files).map(([name, bytes]) => [name, Buffer.from(bytes).toString('base64')]), share],
  );
  return page.evaluate(() => window.zones);
}
const dropAndLoad = (page, files, share) => eventOf(page, 'load', () => drop(page, files, share));

const stateOf = (page) =>
  page.evaluate(() => {
    const viewer = document.querySelector('lucent-viewer');
    const { path, files } = viewer.ownScene ?? {};
    const { alt, caption, sceneTitle } = viewer;
    return { alt, caption, title: sceneTitle, truth: viewer.truth, path, files: files && [...files.keys()].sort() };
  });

const kSlope = greyPng(64, 64, (x) => 4 * x); // rises to the right: away from the lamp at the upper left
/** Waves as normals, n = 2 c - 1. */
const kNormals = colorPng(32, 32, (x, y, channel) => {
  const slope = 0.5 * Math.sin(x * 0.6);
  return Math.round(127.5 + (127.5 * [-slope, 0, 1][channel]) / Math.hypot(slope, 1));
});

/** A file of the MERL database in which every direction has the same value, dropped as a person does. */
const dropTable = (page) =>
  page.evaluate((share) => {
    const viewer = document.querySelector('lucent-viewer');
    const transfer = new DataTransfer();
    const values = new Float64Array(3 * 90 * 90 * 180).fill(300);
    transfer.items.add(new File([new Int32Array([90, 90, 180]), values], 'gold.binary'));
    const box = viewer.getBoundingClientRect();
    const place = { clientX: box.left + share * box.width, clientY: box.top + 50 };
    for (const type of ['dragover', 'drop'])
      viewer.dispatchEvent(new DragEvent(type, { ...place, dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, kLeft);

/** Share of the pixels that something covers and that are white in one colour. */
function clippedShare({ pixels }) {
  let clipped = 0;
  let covered = 0;
  for (let at = 0; at < pixels.length; at += 4) {
    if (pixels[at + 3] < 128) continue;
    ++covered;
    if (Math.max(pixels[at], pixels[at + 1], pixels[at + 2]) === 255) ++clipped;
  }
  return clipped / covered;
}

// ---- one file

test('a height map becomes a scene of its own: all of it in the frame, neither clipped nor dark', async () => {
  for (const [width, height] of [[400, 300], [240, 400]]) {
    const page = await open(width, height);
    const zones = await drop(page, { 'slope.png': kSlope });
    assert.deepEqual(zones, [['New scene', 'aimed'], ['Environment', '']]);
    await page.waitForFunction(() => document.querySelector('lucent-viewer').sceneTitle === 'slope');
    await complete(page);
    const picture = await pictureOf(page);
    assert.equal(clippedShare(picture), 0);
    const columns = [0.35, 0.45, 0.55].map((left) => brightness(picture, [left, 0.4, left + 0.1, 0.6]));
    assert.ok(columns[0] > columns[1] && columns[1] > columns[2], `brightness from left to right: ${columns}`);
    assert.ok(columns[1] > 60, `brightness in the middle: ${columns[1]}`);
    const corner = picture.pixels[3];
    assert.equal(corner, 0, 'the relief reaches the corner of the frame');
    await page.leave();
  }
});

test('an own scene has its own name, and its files can be taken', async () => {
  const page = await open();
  await page.evaluate(() => (document.querySelector('lucent-viewer').truth = 'made/none.pfm'));
  await dropAndLoad(page, { 'coin_height.png': kSlope, 'coin_albedo.png': colorPng(8, 8, () => 128) });
  assert.deepEqual(await stateOf(page), {
    alt: 'coin',
    caption: '',
    title: 'coin',
    truth: '',
    path: 'coin.json',
    files: ['coin.json', 'coin_albedo.png', 'coin_height.png'],
  });
  const scene = await page.evaluate(() => {
    const viewer = document.querySelector('lucent-viewer');
    viewer.set('view.exposure', 0.125);
    return JSON.parse(new TextDecoder().decode(viewer.ownScene.files.get('coin.json')));
  });
  assert.equal(scene.view.exposure, 0.125);
  assert.equal(scene.objects[0].material.diffuseMap, 'coin_albedo.png');
  await eventOf(page, 'load', () =>
    page.evaluate(() => (document.querySelector('lucent-viewer').src = 'made/ridge.json')),
  );
  assert.equal((await stateOf(page)).path, undefined);
  await page.leave();
});

test('the page speaks of the own scene alone, and the way back leads to the gallery', async () => {
  const page = await openPage(stage);
  await complete(page);
  await dropAndLoad(page, { 'my coin.png': kSlope });
  await complete(page);
  assert.equal(await page.textContent('#title'), 'my coin');
  assert.equal(await page.textContent('#caption'), '');
  assert.equal(await page.title(), 'my coin – Lucent');
  assert.equal(await page.evaluate(() => location.hash), '');
  assert.equal(await page.locator('#gallery [aria-current]').count(), 0);
  await page.evaluate(() => document.querySelector('lucent-viewer').set('view.exposure', 0.5));
  await page.waitForTimeout(500);
  assert.equal(await page.evaluate(() => location.hash), '');
  await page.click('#save');
  const saved = page.waitForEvent('download');
  const [download] = await Promise.all([saved, page.click('dialog[open] button:text("Save")')]);
  await page.click('dialog[open] button:text("Close")');
  assert.equal(download.suggestedFilename(), 'my coin.png');
  await page.click('#copy');
  assert.match(await page.textContent('#kept'), /^No link can hold a scene of your own/);
  await page.goBack();
  await page.click('dialog[open] button:text("Replace it")');
  await page.waitForFunction(() => document.querySelector('#title').textContent === 'A dome');
  assert.equal(await page.title(), 'A dome – Lucent');
  assert.equal((await stateOf(page)).path, undefined);
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
});

test('a picture dropped on the right half replaces the environment and nothing else', async () => {
  const page = await open();
  const before = await pictureOf(page);
  await dropAndLoad(page, { 'evening.png': greyPng(64, 32, (x, y) => 255 - 8 * y) }, kRight);
  await complete(page);
  assert.equal(await valueOf(page, 'environment.enabled'), true);
  const { title, path, alt } = await stateOf(page);
  assert.deepEqual({ title, path, alt }, { title: 'A dome', path: undefined, alt: 'A dome' });
  assert.ok(difference(before, await pictureOf(page)).share > 0.2);
  await dropAndLoad(page, { 'slope.png': kSlope });
  await dropAndLoad(page, { 'night.png': greyPng(64, 32, () => 60) }, kRight);
  assert.deepEqual((await stateOf(page)).files, ['night.png', 'slope.json', 'slope.png']);
  await page.leave();
});

test('a normal map is known by what it holds and becomes heights', async () => {
  const page = await open();
  await dropAndLoad(page, { 'bricks.png': kNormals });
  await complete(page);
  assert.deepEqual((await stateOf(page)).files, ['bricks.json', 'bricks_height.pfm']);
  assert.ok(spread(await pictureOf(page)) > 40);
  await page.leave();
});

// ---- sets

test('pictures whose names do not say what they are for are asked about', async () => {
  const page = await open();
  await drop(page, { 'a.png': kSlope, 'b.png': colorPng(8, 8, (x, y, channel) => [200, 100, 50][channel]) });
  const dialog = page.locator('lucent-viewer dialog');
  await dialog.waitFor();
  assert.equal(await dialog.getByRole('heading').textContent(), 'What is each picture for?');
  assert.equal(await dialog.locator('canvas:not(.unknown)').count(), 2);
  const focused = () => page.evaluate(() => document.querySelector('lucent-viewer').shadowRoot.activeElement?.tagName);
  assert.equal(await focused(), 'SELECT');
  const proposed = await dialog.locator('select').evaluateAll((list) => list.map(({ value }) => value));
  assert.deepEqual(proposed, ['height', 'albedo']); // grey, and coloured
  await dialog.getByLabel('a.png').selectOption('albedo');
  await dialog.getByLabel('b.png').selectOption('albedo');
  await dialog.getByRole('button', { name: 'Open' }).click();
  assert.match(await dialog.getByRole('alert').textContent(), /^One picture must be the heights or the normals/);
  await dialog.getByLabel('a.png').selectOption('height');
  await eventOf(page, 'load', () => dialog.getByRole('button', { name: 'Open' }).click());
  const { title, files } = await stateOf(page);
  assert.deepEqual({ title, files }, { title: 'a', files: ['a.json', 'a.png', 'b.png'] });
  assert.equal(await page.locator('lucent-viewer dialog').count(), 0);

  await drop(page, { 'photo.png': colorPng(8, 8, (x, y, channel) => [200, 100, 50][channel]) });
  await dialog.waitFor();
  assert.equal(await dialog.getByRole('heading').textContent(), 'What is this picture for?');
  assert.equal(await dialog.getByLabel('photo.png').inputValue(), 'height');
  await page.keyboard.press('Escape');
  await dialog.waitFor({ state: 'detached' });
  assert.equal((await stateOf(page)).title, 'a');

  await drop(page, { 'c.png': kSlope, 'd.png': kSlope });
  await page.locator('lucent-viewer dialog').waitFor();
  await page.keyboard.press('Escape');
  await page.locator('lucent-viewer dialog').waitFor({ state: 'detached' });
  assert.equal((await stateOf(page)).title, 'a');
  assert.equal(await page.textContent('lucent-viewer .status'), '');
  await page.leave();
});

// ---- models

test('a model stands on a ground with its own materials, and a damaged one changes nothing', async () => {
  const page = await open();
  const { model, data } = glassTriangle();
  await dropAndLoad(page, { 'pane.bin': data, 'pane.gltf': model });
  await complete(page);
  const { title, files } = await stateOf(page);
  assert.deepEqual({ title, files }, { title: 'pane', files: ['pane.json', 'pane.mesh'] });
  assert.equal(await valueOf(page, 'objects.pane/glass.material.transmission'), 1);
  assert.equal(await valueOf(page, 'objects.ground.material.kind'), 'matt');
  assert.equal(await valueOf(page, 'camera.type'), 'perspective');
  const before = await pictureOf(page);
  assert.equal(clippedShare(before), 0);
  const alone = await eventOf(page, 'error', () => drop(page, { 'pane.gltf': model }));
  assert.match(alone.message, /^pane\.gltf: .*pane\.bin.*;/);
  const damaged = await eventOf(page, 'error', () => drop(page, { 'half.glb': Buffer.from('glTF') }, kRight));
  assert.match(damaged.message, /^half\.glb: .*;/);
  assert.equal((await stateOf(page)).title, 'pane');
  assert.deepEqual(difference(before, await pictureOf(page)), { max: 0, mean: 0, share: 0 });
  await page.leave();
});

test('a model that is dropped with a light probe stands in its light, and what is left out is named', async () => {
  const page = await open();
  const { model, data } = glassTriangle();
  const probe = await page.evaluate(async () => {
    const head = '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n';
    return [...new TextEncoder().encode(head), ...Array.from({ length: 32 }, () => [200, 180, 160, 131]).flat()];
  });
  await drop(page, { 'pane.gltf': model, 'pane.bin': data, 'room.hdr': Buffer.from(probe), 'other.obj': Buffer.from('v 0 0 0') });
  await page.waitForFunction(() => document.querySelector('lucent-viewer').get('environment.intensity') !== undefined);
  await page.waitForFunction(() => document.querySelector('lucent-viewer').sceneJson.includes('room.hdr'));
  await complete(page);
  assert.ok(clippedShare(await pictureOf(page)) < 0.01); // a probe of about 6 in units of its own
  const { title } = await stateOf(page);
  assert.equal(title, 'pane');
  assert.match(await page.textContent('lucent-viewer .unseen[role=status]'), /left out: other\.obj, as one model is opened/);
  await page.leave();
});

test('a file of a kind that cannot be opened is named with all that can be', async () => {
  const page = await open();
  const { code, message } = await eventOf(page, 'error', () => drop(page, { 'notes.txt': Buffer.from('hello') }));
  assert.equal(code, 'file');
  assert.match(message, /^notes\.txt: files ending in \.txt cannot be opened; must be .*TIFF.*glTF.*\.lp.*\.zip/);
  await page.leave();
});

test('an OBJ without its materials is a scene all the same', async () => {
  const page = await open();
  const text = 'mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paper\nf 1 2 3\n';
  await dropAndLoad(page, { 'sheet.obj': Buffer.from(text) });
  assert.deepEqual(await valueOf(page, 'camera.target'), [0.5, 0.5, 0]);
  await page.leave();
});

test('the pictures that a model names lie on it, and can be switched off', async () => {
  const page = await open();
  const text = ['mtllib sheet.mtl', 'v 0 0 0', 'v 1 0 0', 'v 1 1 0', 'v 0 1 0', 'vt 0 0', 'vt 1 0', 'vt 1 1', 'vt 0 1'];
  await dropAndLoad(page, {
    'sheet.obj': Buffer.from([...text, 'usemtl flag', 'f 1/1 2/2 3/3 4/4'].join('\n')),
    'sheet.mtl': Buffer.from('newmtl flag\nKd 1 1 1\nmap_Kd flag.png\n'),
    'flag.png': colorPng(16, 16, (x, y, channel) => (channel === (x < 8 ? 0 : 2) ? 255 : 0)),
  });
  await complete(page);
  // Mean of red and of blue left and right of the picture's middle, on the sheet.
  const colors = async () => {
    const { width, height, pixels } = await pictureOf(page);
    return [0.42, 0.58].map((share) => {
      const at = 4 * (width * Math.round(0.45 * height) + Math.round(share * width));
      return [pixels[at], pixels[at + 2]];
    });
  };
  const [left, right] = await colors();
  assert.ok(left[0] > 100 && left[1] < 20 && right[0] < 20 && right[1] > 100, `red and blue: ${left}; ${right}`);
  await page.evaluate(() => document.querySelector('lucent-viewer').set('objects.sheet/flag.shape.textured', false));
  await complete(page);
  for (const [red, blue] of await colors()) assert.ok(Math.min(red, blue) > 100, `red and blue: ${red}, ${blue}`);
  await page.leave();
});

// ---- photographs

/** A bump under a lamp, as a matt surface shows it. */
const photo = ([x, y, z], side = 24) =>
  colorPng(side, side, (u, v, channel) => {
    const slope = [-0.8 * Math.sin((2 * Math.PI * (u + 0.5)) / side), 0];
    const shade = Math.max((-slope[0] * x - slope[1] * y + z) / Math.hypot(...slope, 1) / Math.hypot(x, y, z), 0);
    const linear = [0.8, 0.6, 0.4][channel] * shade;
    return Math.round(255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055));
  });
function dome(side) {
  const lights = [0, 1, 2, 3, 4, 5].map((k) => [Math.cos(k), Math.sin(k), 1 + 0.3 * (k % 2)]);
  const lines = lights.map((light, k) => `C:\\photos\\photo ${k}.png ${light.join(' ')}`);
  const photos = lights.map((light, k) => [`photo ${k}.png`, photo(light, side)]);
  return { 'tablet.lp': Buffer.from([lights.length, ...lines].join('\n')), ...Object.fromEntries(photos) };
}

test('photographs with their lights become normals and colours, and the residual is shown', async () => {
  const page = await open();
  await dropAndLoad(page, dome());
  await complete(page);
  const { title, files } = await stateOf(page);
  assert.equal(title, 'tablet');
  assert.deepEqual(
    files,
    ['_albedo.png', '_height.pfm', '_normal.png', '_residual.png', '.json'].map((end) => `tablet${end}`).sort(),
  );
  const figure = page.locator('lucent-viewer figure');
  assert.match(await figure.locator('figcaption').textContent(), /^residual 0?\.?\d.* % of the albedo .* left out as shadows/);
  assert.match(await figure.locator('canvas').getAttribute('aria-label'), /^Residual: /);
  await figure.getByRole('button', { name: 'Close' }).click();
  assert.equal(await figure.isVisible(), false);
  assert.ok(spread(await pictureOf(page)) > 40);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('photographs that are being solved can be given up, and the scene before stays', async () => {
  const page = await open();
  const cancelled = clickOnce(page, '.photos', /Solving photographs: \d+ %/);
  await drop(page, dome(1024));
  await cancelled;
  await page.locator('lucent-viewer .photos > button').waitFor({ state: 'hidden' });
  assert.equal((await stateOf(page)).title, await page.evaluate(() => document.querySelector('lucent-viewer').sceneTitle));
  assert.equal((await stateOf(page)).path, undefined);
  await page.leave();
});

test('a photograph that a light file names and nobody brought is named', async () => {
  const page = await open();
  const { 'photo 3.png': gone, ...rest } = dome();
  const { message } = await eventOf(page, 'error', () => drop(page, rest));
  assert.equal(message, 'C:/photos/photo 3.png: is named by the light file; must be opened together with it');
  await page.leave();
});

// ---- other kinds and mistakes

/** A TIFF of one uncompressed strip of 16-bit grey, little-endian. */
function tiff16(width, height, value) {
  const entries = [
    [256, 3, width],
    [257, 3, height],
    [258, 3, 16],
    [259, 3, 1],
    [262, 3, 1],
    [273, 4, 8],
    [277, 3, 1],
    [278, 3, height],
    [279, 4, 2 * width * height],
  ];
  const samples = Buffer.alloc(2 * width * height);
  for (let at = 0; at < width * height; ++at) samples.writeUInt16LE(value(at % width, Math.floor(at / width)), 2 * at);
  const head = Buffer.alloc(8);
  head.write('II*\0', 'latin1');
  head.writeUInt32LE(8 + samples.length, 4);
  const list = Buffer.alloc(2 + 12 * entries.length + 4);
  list.writeUInt16LE(entries.length, 0);
  for (const [at, [tag, type, number]] of entries.entries()) {
    list.writeUInt16LE(tag, 2 + 12 * at);
    list.writeUInt16LE(type, 4 + 12 * at);
    list.writeUInt32LE(1, 6 + 12 * at);
    type === 3 ? list.writeUInt16LE(number, 10 + 12 * at) : list.writeUInt32LE(number, 10 + 12 * at);
  }
  return Buffer.concat([head, samples, list]);
}

test('a 16-bit TIFF is a height map like any other', async () => {
  const page = await open();
  await dropAndLoad(page, { 'scan.tif': tiff16(64, 64, (x) => 1000 * x) });
  await complete(page);
  assert.deepEqual((await stateOf(page)).files, ['scan.json', 'scan.png']);
  assert.ok(spread(await pictureOf(page)) > 40);
  const damaged = await eventOf(page, 'error', () =>
    drop(page, { 'half.tif': tiff16(64, 64, (x) => x).subarray(0, 100) }),
  );
  assert.match(damaged.message, /^half\.tif: .*; must be a whole TIFF file$/);
  await page.leave();
});

test('a scene file that is none is refused with the reason, a damaged picture too, and the old picture stays', async () => {
  const page = await open();
  const before = await pictureOf(page);
  const scene = await eventOf(page, 'error', () => drop(page, { 'coin.json': Buffer.from('{}') }));
  assert.equal(scene.code, 'scene');
  assert.match(scene.message, /^coin\.json:1: .*lucent is missing; must be 1$/);
  const damaged = await eventOf(page, 'error', () => drop(page, { 'half.png': kSlope.subarray(0, 60) }));
  assert.equal(damaged.code, 'file');
  assert.match(damaged.message, /^half\.png: .*;/);
  assert.equal((await stateOf(page)).alt, 'A dome');
  assert.deepEqual(difference(before, await pictureOf(page)), { max: 0, mean: 0, share: 0 });
  await page.leave();
});

test('a measured material is shown on a ball, with its lobe', async () => {
  const page = await open(160, 120);
  await eventOf(page, 'load', () => dropTable(page));
  const { title, files } = await stateOf(page);
  assert.equal(title, 'gold');
  assert.deepEqual(files, ['gold.binary', 'gold.json']);
  await complete(page);
  const [{ text }] = await page.evaluate(() => document.querySelector('lucent-viewer').profiles());
  assert.match(text, /^Reflectance of gold, measured: of even light from all around /);
  await page.leave();
});
