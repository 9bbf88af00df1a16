/** Pictures at sizes of their own, and sequences, while the page shows what it showed. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { complete, decodePng, difference, openPage, openStage, openViewers, pictureOf, shownBy, spread } from './support.mjs';

const kSame = { max: 0, mean: 0, share: 0 };

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

/** A page with one viewer of a size. */
async function open(scene, width = 120, height = 90, attributes = '') {
  const page = await openViewers(stage, `<lucent-viewer src="made/${scene}" ${attributes}></lucent-viewer>`);
  await page.evaluate(
    ([w, h]) => Object.assign(document.querySelector('lucent-viewer').style, { width: `${w}px`, height: `${h}px`, maxHeight: 'none' }),
    [width, height],
  );
  await complete(page);
  return page;
}

/** What a method of the viewer gives, as bytes. */
async function bytesOf(page, method, options) {
  const base64 = await page.evaluate(
    async ([name, given]) => {
      const bytes = new Uint8Array(await (await document.querySelector('lucent-viewer')[name](given)).arrayBuffer());
      let text = '';
      for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
      return btoa(text);
    },
    [method, options],
  );
  return Buffer.from(base64, 'base64');
}
const pictureAt = async (page, width, height) => decodePng(page, await bytesOf(page, 'toBlob', { width, height }));

/** Names and contents of a zip archive whose files are stored. */
function filesOf(zip) {
  const files = new Map();
  for (let at = zip.indexOf('PK\x01\x02', 0, 'latin1'); zip.readUInt32LE(at) === 0x02014b50; ) {
    const [size, name, extra, comment] = [zip.readUInt32LE(at + 20), ...[28, 30, 32].map((place) => zip.readUInt16LE(at + place))];
    const local = zip.readUInt32LE(at + 42);
    const start = local + 30 + zip.readUInt16LE(local + 26) + zip.readUInt16LE(local + 28);
    files.set(zip.toString('utf8', at + 46, at + 46 + name), zip.subarray(start, start + size));
    at += 46 + name + extra + comment;
  }
  return files;
}

test('a picture of another size is what a viewer of that size shows, and the page keeps its own', async () => {
  for (const scene of ['dome.json', 'marble.json']) {
    const small = await open(scene);
    await small.evaluate(() => document.querySelector('lucent-viewer').set('view.exposure', 0.5));
    await complete(small);
    const shown = await shownBy(small);
    const large = await open(scene, 240, 160);
    await large.evaluate(() => document.querySelector('lucent-viewer').set('view.exposure', 0.5));
    await complete(large);
    assert.deepEqual(difference(await pictureAt(small, 240, 160), await pictureOf(large), 0), kSame, scene);
    assert.deepEqual(difference(await shownBy(small), shown, 0), kSame);
    assert.deepEqual([...small.problems, ...large.problems], []);
    await small.leave();
    await large.leave();
  }
});

test('light dots and what else lies over the picture are not in it', async () => {
  const page = await open('dome.json', 200, 200);
  const set = (path, value) =>
    page.evaluate((pair) => document.querySelector('lucent-viewer').set(...pair), [path, value]);
  await set('lights.0.position', [0.1, 0.1, 0.6]);
  await complete(page);
  const [withDot, saved, other] = [await shownBy(page), await pictureOf(page), await pictureAt(page, 100, 100)];
  await set('view.lightDot', false);
  await complete(page);
  assert.ok(difference(withDot, await shownBy(page)).max > 40, 'the dot is seen on the page');
  assert.deepEqual(difference(saved, await shownBy(page), 0), kSame);
  assert.deepEqual(difference(other, await pictureAt(page, 100, 100), 0), kSame);
  await page.leave();
});

test('sizes that the device cannot draw are refused', async () => {
  const page = await open('dome.json');
  const most = await page.evaluate(() => document.querySelector('lucent-viewer').largestSide);
  assert.ok(most >= 2048, `${most}`);
  const refusal = (width, height) =>
    page.evaluate(
      (size) => document.querySelector('lucent-viewer').toBlob(size).then(() => 'drawn', ({ message }) => message),
      { width, height },
    );
  for (const [width, height] of [[most + 1, 10], [0, 10], [10, 1.5]])
    assert.equal(
      await refusal(width, height),
      `size: is ${width} x ${height}; must be whole pixels, each from 1 to ${most} on this device`,
    );
  await page.leave();
});

test('an EXR file holds the linear values, which a viewer reads back', async () => {
  const page = await open('bead.json', 60, 60);
  const exr = await bytesOf(page, 'toBlob', { type: 'image/x-exr', width: 64, height: 32 });
  assert.equal(exr.readUInt32LE(0), 20000630, 'the first four bytes of OpenEXR');
  // As an environment of its own the picture comes back: brighter than PNG can hold or not, without a curve.
  const isOpen = await page.evaluate(
    (base64) =>
      document
        .querySelector('lucent-viewer')
        .openFile(new File([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], 'a.exr'), 'environment'),
    exr.toString('base64'),
  );
  assert.equal(isOpen, true);
  await page.leave();
});

test('a turntable is numbered pictures that begin with the one shown, and all differ', async () => {
  const page = await open('bead.json', 60, 60);
  const shares = await page.evaluate(() => (window.shares = []));
  assert.deepEqual(shares, []);
  const options = { path: 'camera', frames: 4, width: 48, height: 48, name: 'bead' };
  const files = filesOf(await bytesOf(page, 'toSequence', options));
  assert.deepEqual([...files.keys()], ['bead-0001.png', 'bead-0002.png', 'bead-0003.png', 'bead-0004.png']);
  const pictures = [];
  for (const png of files.values()) pictures.push(await decodePng(page, png));
  assert.deepEqual(difference(pictures[0], await pictureAt(page, 48, 48), 0), kSame);
  for (const [at, picture] of pictures.entries()) {
    assert.deepEqual([picture.width, picture.height], [48, 48]);
    assert.ok(difference(picture, pictures[(at + 1) % 4]).share > 0.02, `frame ${at + 1}`);
  }
  await page.leave();
});

// Its second and third are the same, to the right and back: nothing is to be drawn for the third.
test('a relief, which swings to and fro, has a turntable of any number of pictures', async () => {
  const page = await open('dome.json', 60, 60);
  const files = filesOf(await bytesOf(page, 'toSequence', { path: 'camera', frames: 6, width: 48, height: 48 }));
  const pictures = [];
  for (const png of files.values()) pictures.push(await decodePng(page, png));
  assert.equal(pictures.length, 6);
  assert.deepEqual(difference(pictures[1], pictures[2], 1).share, 0);
  assert.ok(difference(pictures[2], pictures[3]).share > 0.02);
  await page.leave();
});

// The lamp stands left of the dome, and half way round on its right.
test('a lamp sweep leads the lamp around', async () => {
  const page = await open('dome.json', 60, 60);
  const options = { path: 'lamp', frames: 2, width: 60, height: 60 };
  const [left, right] = [...filesOf(await bytesOf(page, 'toSequence', options)).values()];
  const [a, b] = [await decodePng(page, left), await decodePng(page, right)];
  const side = ({ width, height, pixels }, from, to) => {
    let sum = 0;
    for (let y = 0; y < height; ++y) for (let x = from * width; x < to * width; ++x) sum += pixels[4 * (y * width + x)];
    return sum;
  };
  assert.ok(side(a, 0, 0.5) > 1.1 * side(a, 0.5, 1), 'lit from the left');
  assert.ok(side(b, 0.5, 1) > 1.1 * side(b, 0, 0.5), 'lit from the right');
  await page.leave();
});

test('a sequence ends when it is cancelled, and tells how far it is', async () => {
  const page = await open('dome.json', 60, 60);
  const { name, shares } = await page.evaluate(async () => {
    const stop = new AbortController();
    const shares = [];
    const progress = (share) => (shares.push(share), shares.length === 2 && stop.abort());
    const options = { path: 'lamp', frames: 100, width: 40, height: 40, signal: stop.signal, progress };
    const failed = await document.querySelector('lucent-viewer').toSequence(options).catch((error) => error);
    return { name: failed.name, shares };
  });
  assert.equal(name, 'AbortError');
  assert.deepEqual(shares, [0.01, 0.02]);
  await page.leave();
});

test('a video plays at its size', async () => {
  const page = await open('dome.json', 60, 60);
  const { width, height, type, size } = await page.evaluate(async () => {
    const options = { path: 'lamp', frames: 6, fps: 12, width: 64, height: 48, type: 'video/webm' };
    const blob = await document.querySelector('lucent-viewer').toSequence(options);
    window.blob = blob;
    const bytes = new Uint8Array(await blob.arrayBuffer());
    // Pixel sizes of the track: elements B0 and BA of Matroska beside each other, each with its length in bytes.
    const numberAt = (at) => bytes.slice(at + 1, at + 1 + (bytes[at] & 15)).reduce((sum, byte) => 256 * sum + byte, 0);
    const next = (at) => at + 2 + (bytes[at + 1] & 15);
    const track = bytes.findIndex((byte, at) => byte === 0xb0 && bytes[at + 1] >> 4 === 8 && bytes[next(at)] === 0xba);
    return { width: numberAt(track + 1), height: numberAt(next(track) + 1), type: blob.type, size: blob.size };
  });
  assert.deepEqual([type, width, height], ['video/webm', 64, 48]);
  assert.ok(size > 500, `${size} bytes`);
  await page.leave();
});

test('the dialog saves at the size that was typed, named after the scene, and Escape leaves it', async () => {
  const page = await openPage(stage);
  await complete(page);
  await page.click('#save');
  await page.waitForSelector('dialog[open]');
  const [width, height] = await page.evaluate(() => [...document.querySelectorAll('dialog[open] .size input')].map(({ value }) => Number(value)));
  await page.fill('#picture-width', '64');
  const wanted = Math.max(1, Math.round(64 / (width / height)));
  assert.equal(await page.inputValue('dialog[open] .size input >> nth=1'), String(wanted), 'the shape is kept');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('dialog[open] button:text("Save")')]);
  assert.equal(download.suggestedFilename(), 'dome.png');
  const png = readFileSync(await download.path());
  assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [64, wanted]);
  assert.ok(spread(await decodePng(page, png)) > 40);
  await page.selectOption('#picture-what', 'lamp');
  await page.fill('#picture-frames', '3');
  const [zip] = await Promise.all([page.waitForEvent('download'), page.click('dialog[open] button:text("Save")')]);
  assert.equal(zip.suggestedFilename(), 'dome.zip');
  assert.deepEqual([...filesOf(readFileSync(await zip.path())).keys()], ['dome-0001.png', 'dome-0002.png', 'dome-0003.png']);
  await page.keyboard.press('Escape');
  await page.waitForSelector('dialog[open]', { state: 'detached' });
  assert.equal(await page.evaluate(() => document.activeElement.id), 'save');
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
});
