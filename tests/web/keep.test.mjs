/** Saved scenes, work that comes back, and questions before it goes. */
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { greyPng, glassTriangle, kScenes } from './scenes.mjs';
import { boxOf, complete, decodePng, difference, eventOf, openPage, openStage, openViewers, pictureOf, quiet, valueOf } from './support.mjs';

const kProgram = process.env.LUCENT_PROGRAM; // none: what it makes of a saved scene is not compared
const kSame = { max: 0, mean: 0, share: 0 };

let stage;
let folder;
before(async () => {
  stage = await openStage();
  folder = mkdtempSync(join(tmpdir(), 'lucent-keep-'));
});
after(async () => {
  await stage.close();
  rmSync(folder, { recursive: true });
});

/** The page over a gallery with the ball, which can be painted, the dome and the bead. */
async function open({ hash = '#scene=ball', ...options } = {}) {
  const page = await openPage(stage, 'blank.html', options);
  await page.route('**/gallery/index.json', (route) => route.fulfill({ body: JSON.stringify(kGallery) }));
  await page.goto(new URL('index.html' + hash, stage.address).href);
  await complete(page);
  return page;
}
const kGallery = ['ball', 'dome', 'bead'].map((id, at) => ({
  id,
  title: JSON.parse(kScenes[`${id}.json`]).title,
  caption: '',
  scene: `${id}.json`,
  kind: ['Subsurface', 'Relief', 'Refraction'][at],
}));

const titleOf = (page) => page.evaluate(() => document.querySelector('lucent-viewer').sceneTitle);
const strokesOf = (page) => page.evaluate(() => document.querySelector('lucent-viewer').strokes.strokes);
const call = (page, name, ...values) =>
  page.evaluate(([method, list]) => document.querySelector('lucent-viewer')[method](...list), [name, values]);
const finished = async (page) => (await complete(page), pictureOf(page));
const told = (page) => page.textContent('#kept');
const waitTold = (page, text) => page.waitForFunction((part) => document.querySelector('#kept').textContent.includes(part), text);
const waitTitle = (page, title) => page.waitForFunction((one) => document.querySelector('lucent-viewer').sceneTitle === one, title);

/** Paints `count` strokes by hand, beside each other. */
async function paint(page, count, from = 0) {
  await call(page, 'set', 'mode', 'paint');
  await call(page, 'set', 'paint.radius', 0.001);
  await page.evaluate(() => scrollTo(0, 0)); // a click below has led away from the picture
  const { x, y, width, height } = await boxOf(page);
  for (let at = from; at < from + count; ++at) {
    const place = [x + width * 0.3, y + height * (0.4 + 0.04 * at)];
    await page.mouse.move(...place);
    await page.mouse.down();
    await page.mouse.move(place[0] + 20, place[1], { steps: 2 });
    await page.mouse.up();
    const answer = page.locator('lucent-viewer .question button').first(); // "They stay as they are"
    if (await answer.count()) await answer.click();
  }
}

/** Environments by few directions, pixels by one sample: enough to tell pictures apart. */
async function drawQuickly(page) {
  await call(page, 'set', 'technique.sampling.directions', 8);
  await call(page, 'set', 'technique.sampling.pixelSamples', 1);
}

/** A model with its part, as a person opens them. */
function pane() {
  const { model, data } = glassTriangle();
  return [{ name: 'pane.gltf', mimeType: '', buffer: model }, { name: 'pane.bin', mimeType: '', buffer: data }];
}

/** What the page hands out while `act` runs. @return {Promise<{name: string, path: string}>} */
async function downloadOf(page, act) {
  const [download] = await Promise.all([page.waitForEvent('download'), act()]);
  const path = join(folder, `${Math.random().toString(36).slice(2)}-${download.suggestedFilename()}`);
  await download.saveAs(path);
  return { name: download.suggestedFilename(), path };
}
const saveScene = (page) => downloadOf(page, () => page.click('#save-scene'));

/** Opens files by the dialog of scenes. */
async function openScene(page, ...files) {
  await page.click('#open-scene');
  await page.setInputFiles('dialog[open] input[type=file]', files);
}

test('a reload brings five strokes back, the last one too, and says so with a way back', async () => {
  const page = await open();
  await paint(page, 5);
  const strokes = await strokesOf(page);
  assert.equal(strokes.length, 5);
  await page.reload(); // at once
  await waitTold(page, 'Your work is back');
  assert.deepEqual(await strokesOf(page), strokes);
  assert.equal(await valueOf(page, 'mode'), 'paint');
  await page.click('#kept button:text("Start from the gallery instead")');
  await waitTitle(page, 'A ball');
  await page.waitForFunction(() => document.querySelector('lucent-viewer').strokes.strokes.length === 0);
  assert.match(await told(page), /still kept/);
  await page.click('#kept button:text("Open it")');
  await page.waitForFunction(() => document.querySelector('lucent-viewer').strokes.strokes.length === 5);
  await waitTold(page, 'Your work is back'); // it is this tab's still, and no copy
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('what one tab shows no other takes away: it gets a copy', async () => {
  const page = await open();
  await paint(page, 1);
  await quiet(page, 600);
  const other = await open({ hash: '', beside: page });
  assert.equal((await strokesOf(other)).length, 0); // it is not brought back where it is shown
  assert.equal(await told(other), '');
  const id = await page.evaluate(() => history.state.work);
  await other.evaluate((work) => history.replaceState({ work }, ''), id); // as a tab that is duplicated
  await other.reload();
  await waitTold(other, 'Another tab shows this work');
  await paint(other, 1, 3);
  await quiet(other, 600);
  await call(page, 'set', 'view.exposure', 0.5);
  await quiet(page, 600);
  await page.reload();
  await waitTold(page, 'Your work is back');
  assert.equal((await strokesOf(page)).length, 1);
  assert.equal(await valueOf(page, 'view.exposure'), 0.5);
  await other.reload();
  await waitTold(other, 'Your work is back');
  assert.equal((await strokesOf(other)).length, 2);
  await page.leave();
});

test('what comes back looks as it did, to the bit, and later strokes are kept as well', async () => {
  const page = await open();
  await paint(page, 1);
  await call(page, 'set', 'view.exposure', 0.5);
  await quiet(page, 600);
  await page.reload();
  await waitTold(page, 'Your work is back');
  assert.equal(await valueOf(page, 'view.exposure'), 0.5);
  await paint(page, 1, 3);
  const picture = await finished(page);
  await page.reload();
  await waitTold(page, 'Your work is back');
  assert.equal((await strokesOf(page)).length, 2);
  assert.deepEqual(difference(await finished(page), picture, 0), kSame);
  await page.leave();
});

test('the bare address brings the newest work back, and a link to a scene offers it', async () => {
  const page = await open();
  await paint(page, 1);
  await quiet(page, 600);
  await page.goto('about:blank');
  await page.goto(new URL('index.html', stage.address).href);
  await waitTold(page, 'Your work is back');
  assert.equal((await strokesOf(page)).length, 1);
  await page.goto('about:blank');
  await page.goto(new URL('index.html#scene=dome', stage.address).href);
  await waitTold(page, '“A ball” is still kept');
  assert.equal(await titleOf(page), 'A dome');
  await page.click('#kept button:text("Open it")');
  await waitTitle(page, 'A ball');
  assert.equal((await strokesOf(page)).length, 1);
  await page.leave();
});

test('paint that is taken back is not there after a reload', async () => {
  const page = await open();
  await paint(page, 1);
  await page.click('#undo');
  await quiet(page, 600);
  await page.reload();
  await complete(page);
  assert.equal((await strokesOf(page)).length, 0);
  assert.equal(await told(page), '');
  await page.leave();
});

test('a painted scene that is saved opens again with the same strokes and the same picture to the bit', async () => {
  const page = await open();
  await paint(page, 2);
  await call(page, 'set', 'camera.height', 0.026);
  const picture = await finished(page);
  const strokes = await strokesOf(page);
  const saved = await saveScene(page);
  assert.equal(saved.name, 'ball.lucent.zip');
  const other = await open({ hash: '#scene=dome' });
  await openScene(other, saved.path);
  await waitTitle(other, 'A ball');
  assert.deepEqual(await strokesOf(other), strokes);
  assert.deepEqual(difference(await finished(other), picture, 0), kSame);
  assert.equal(await other.evaluate(() => location.hash), '', 'the address names no scene of the gallery');
  assert.deepEqual([...page.problems, ...other.problems], []);
  await other.leave();
  await page.leave();
});

test('own heights, an environment and a model with its parts are in the file', async () => {
  const page = await open({ hash: '#scene=dome' });
  const png = (name, value) => ({ name, mimeType: 'image/png', buffer: greyPng(64, 48, value) });
  await eventOf(page, 'load', () => page.setInputFiles('#maps-file', png('slope_height.png', (x, y) => (x * y) & 255)));
  await eventOf(page, 'load', () => page.setInputFiles('#environment-file', png('slope_height.png', (x) => 4 * x)));
  await drawQuickly(page);
  const picture = await finished(page);
  const saved = await saveScene(page);
  const other = await open();
  await openScene(other, saved.path);
  await other.waitForFunction(() => document.querySelector('lucent-viewer').get('environment.enabled') === true);
  assert.deepEqual(difference(await finished(other), picture, 0), kSame);

  await eventOf(other, 'load', () => other.setInputFiles('#mesh-file', pane()));
  await drawQuickly(other);
  const shown = await finished(other);
  const archive = await saveScene(other);
  await eventOf(page, 'load', () => openScene(page, archive.path)); // what was there is saved: nothing is asked
  assert.deepEqual(difference(await finished(page), shown, 0), kSame);
  assert.deepEqual([...page.problems, ...other.problems], []);
  await other.leave();
  await page.leave();
});

test('a scene file opens with the files that it names, and says which is missing', async () => {
  const page = await open();
  const files = ['dome.json', 'dome.pfm'].map((name) => ({ name, mimeType: '', buffer: Buffer.from(kScenes[name]) }));
  const { message } = await eventOf(page, 'error', () => openScene(page, files[0]));
  assert.equal(message, 'dome.json: names dome.pfm, which was not opened with it; must be opened together with all that it names');
  await page.click('#open-scene');
  await page.setInputFiles('dialog[open] input[type=file]', files);
  await waitTitle(page, 'A dome');
  await page.leave();
});

test('a saved scene is a source of the element', async () => {
  const page = await open({ hash: '#scene=dome' });
  const picture = await finished(page);
  const saved = readFileSync((await saveScene(page)).path);
  const { width, height } = picture;
  const other = await openViewers(stage, '');
  await other.route('**/made/dome.lucent.zip', (route) => route.fulfill({ body: saved }));
  await other.evaluate(
    ([w, h]) => {
      document.body.innerHTML = `<lucent-viewer src="made/dome.lucent.zip"></lucent-viewer>`;
      Object.assign(document.querySelector('lucent-viewer').style, { width: `${w}px`, height: `${h}px`, maxHeight: 'none' });
    },
    [width, height],
  );
  assert.deepEqual(difference(await finished(other), picture, 0), kSame);
  await other.leave();
  await page.leave();
});

test('the program renders a saved scene like its files, and as the page shows it', { skip: !kProgram }, async () => {
  const page = await open();
  await paint(page, 2);
  await call(page, 'set', 'view.lightDot', false);
  await complete(page);
  const saved = await saveScene(page);
  const base64 = await page.evaluate(async () => {
    const blob = await document.querySelector('lucent-viewer').toBlob({ width: 160, height: 120 });
    return btoa(String.fromCharCode(...new Uint8Array(await blob.arrayBuffer())));
  });
  const json = await page.evaluate(() => document.querySelector('lucent-viewer').sceneJson);
  writeFileSync(join(folder, 'plain.json'), json);
  const render = (scene, out) => {
    execFileSync(kProgram, ['render', scene, '-o', join(folder, out), '--size', '160x120']);
    return readFileSync(join(folder, out));
  };
  const [fromZip, fromFiles] = [render(saved.path, 'zip.png'), render(join(folder, 'plain.json'), 'plain.png')];
  assert.ok(fromZip.equals(fromFiles));
  const shown = await decodePng(page, Buffer.from(base64, 'base64'));
  const { max, share } = difference(await decodePng(page, fromZip), shown);
  assert.ok(share <= 0.001, `max ${max}/255, ${100 * share} % above 1/255`);
  await page.leave();
});

test('another scene waits for an answer where work would be lost', async () => {
  const page = await open();
  await paint(page, 1);
  const question = 'dialog[open] h2:text("Save your scene first?")';
  await page.click('#gallery a[data-id=dome]');
  await page.waitForSelector(question);
  assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Save scene');
  await page.keyboard.press('Escape');
  await page.waitForSelector(question, { state: 'detached' });
  assert.equal(await titleOf(page), 'A ball');
  await page.waitForFunction(() => location.hash.startsWith('#scene=ball')); // the way back takes a moment
  assert.equal((await strokesOf(page)).length, 1);

  await page.click('#gallery a[data-id=dome]');
  const saved = await downloadOf(page, () => page.click('dialog[open] button:text("Save scene")'));
  assert.equal(saved.name, 'ball.lucent.zip');
  await waitTitle(page, 'A dome');
  await page.goBack(); // the work is kept all the same
  await waitTitle(page, 'A ball');
  assert.equal((await strokesOf(page)).length, 1);
  await page.click('#gallery a[data-id=dome]'); // which was saved: nothing is asked
  await waitTitle(page, 'A dome');

  await page.click('#gallery a[data-id=ball]');
  await waitTitle(page, 'A ball');
  await paint(page, 1);
  await page.click('#gallery a[data-id=ball]'); // its own card, as it was
  await page.click('dialog[open] button:text("Replace it")');
  await page.waitForFunction(() => document.querySelector('lucent-viewer').strokes.strokes.length === 0);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('changed parameters alone are no reason to ask: the way back leads to them', async () => {
  const page = await open({ hash: '#scene=dome' });
  await call(page, 'set', 'view.exposure', 1);
  await page.waitForFunction(() => location.hash.includes('exposure'));
  await page.click('#gallery a[data-id=ball]');
  await waitTitle(page, 'A ball');
  await page.goBack();
  await waitTitle(page, 'A dome');
  await page.waitForFunction(() => document.querySelector('lucent-viewer').get('view.exposure') === 1);
  await page.leave();
});

test('a mode button leaves a scene of the person', async () => {
  const page = await open();
  await paint(page, 1);
  await page.click('#modes button:text("Relief")');
  assert.equal(await titleOf(page), 'A ball');
  assert.match(await page.textContent('#note'), /^Relief: nothing in your scene is for this mode/);
  await page.leave();
});

test('where the browser keeps nothing the page says so once there is work, and asks before it closes', async () => {
  const init = () => {
    IDBFactory.prototype.open = () => {
      throw new Error('no storage here');
    };
  };
  const page = await open({ init });
  assert.equal(await told(page), '');
  await paint(page, 1);
  await waitTold(page, 'This browser does not keep your work (no storage here)');
  const asked = [];
  page.on('dialog', (dialog) => (asked.push(dialog.type()), dialog.accept()));
  await page.reload();
  await complete(page);
  assert.deepEqual(asked, ['beforeunload']);
  assert.equal((await strokesOf(page)).length, 0);
  await page.reload(); // nothing to lose
  assert.deepEqual(asked, ['beforeunload']);
  await page.leave();
});

test('a copied link keeps what it can and says what it cannot', async () => {
  const init = () => {
    navigator.clipboard.writeText = async (text) => void (window.copied = text);
  };
  const page = await open({ init });
  await call(page, 'set', 'view.exposure', 1);
  await page.click('#copy');
  await page.waitForFunction(() => window.copied?.includes('#scene=ball&view.exposure=1'));
  assert.equal(await told(page), '');
  await paint(page, 1);
  await quiet(page, 600); // the stroke is kept by then
  await page.click('#copy');
  await waitTold(page, 'The link keeps all but what you painted');
  await page.reload(); // what came back has the same link
  await waitTold(page, 'Your work is back');
  await page.evaluate(() => (window.copied = ''));
  await page.click('#copy');
  await page.waitForFunction(() => window.copied);
  assert.match(await page.evaluate(() => window.copied), /#scene=ball&.*view\.exposure=1/);
  const name = 'evening.png'; // opened into what came back
  await eventOf(page, 'load', () =>
    page.setInputFiles('#environment-file', { name, mimeType: 'image/png', buffer: greyPng(64, 32, () => 60) }),
  );
  await page.click('#copy');
  await waitTold(page, 'The link keeps all but the files that you opened and what you painted');
  await eventOf(page, 'load', async () => {
    await page.setInputFiles('#mesh-file', pane());
    await page.click('dialog[open] button:text("Replace it")');
  });
  await page.evaluate(() => (window.copied = ''));
  await page.click('#copy');
  await waitTold(page, 'No link can hold a scene of your own');
  assert.equal(await page.evaluate(() => window.copied), '');
  await downloadOf(page, () => page.click('#kept button:text("Save scene")'));
  await page.leave();
});

test('a link that is pasted opens its scene', async () => {
  const page = await open();
  const paste = async (text) => {
    await page.click('#open-scene');
    await page.fill('dialog[open] input[type=text]', text);
    await page.click('dialog[open] button:text("Open link")');
  };
  await paste(new URL('index.html#scene=dome&view.exposure=1', stage.address).href);
  await waitTitle(page, 'A dome');
  await page.waitForFunction(() => document.querySelector('lucent-viewer').get('view.exposure') === 1);
  await paste(new URL('made/ridge.json', stage.address).href);
  await waitTitle(page, 'A ridge');
  await page.reload();
  await waitTitle(page, 'A ridge');
  const address = page.url();
  const missing = await eventOf(page, 'error', () => paste(new URL('made/gone.json', stage.address).href));
  assert.equal(missing.code, 'fetch');
  assert.equal(page.url(), address); // it leads to what is shown
  await page.goto(new URL('index.html#src=made/gone.json', stage.address).href.replace('#', '?again#'));
  await page.click('#kept button:text("Start from the gallery")');
  await waitTitle(page, 'A ball');
  await page.leave();
});

/** A zip archive of stored files (APPNOTE 6.3.9); `size` is what it says of each. */
function zipOf(files) {
  const parts = [];
  const list = [];
  let at = 0;
  for (const { name, content = '', size = content.length, crc = 0 } of files) {
    const head = Buffer.alloc(26);
    head.writeUInt16LE(20, 0);
    head.writeUInt32LE(crc, 10);
    head.writeUInt32LE(content.length, 14);
    head.writeUInt32LE(size, 18);
    head.writeUInt16LE(name.length, 22);
    const local = Buffer.concat([Buffer.from('PK\x03\x04', 'latin1'), head, Buffer.from(name + content)]);
    const tail = Buffer.alloc(14);
    tail.writeUInt32LE(at, 10);
    list.push(Buffer.concat([Buffer.from('PK\x01\x02\x14\0', 'latin1'), head, tail, Buffer.from(name)]));
    parts.push(local);
    at += local.length;
  }
  const listed = Buffer.concat(list);
  const end = Buffer.alloc(18);
  end.writeUInt16LE(files.length, 4);
  end.writeUInt16LE(files.length, 6);
  end.writeUInt32LE(listed.length, 8);
  end.writeUInt32LE(at, 12);
  return Buffer.concat([...parts, listed, Buffer.from('PK\x05\x06', 'latin1'), end]);
}

test('archives that were made to do harm are refused by name, and the scene stays', async () => {
  const page = await open({ hash: '#scene=dome' });
  const refused = {
    'a.zip: has a file "../a", which leads outside; must lie in it': [{ name: '../a' }],
    'a.zip: has a file "/a", which leads outside; must lie in it': [{ name: '/a' }],
    'a.zip: has two files "a"; must have one of a name': [{ name: 'a' }, { name: 'a' }],
    'a.zip: unpacks to more than 1 GiB with "b"; must be at most that': [{ name: 'a', size: 2 ** 30 }, { name: 'b', size: 1 }],
    'a.zip: has 1001 files; must have at most 1000': Array.from({ length: 1001 }, (_, at) => ({ name: `${at}` })),
    'a.zip: has no scene; must have scene.json, or one .json file': [{ name: 'a' }],
  };
  const openZip = (buffer) => eventOf(page, 'error', () => openScene(page, { name: 'a.zip', mimeType: '', buffer }));
  for (const [message, files] of Object.entries(refused)) assert.equal((await openZip(zipOf(files))).message, message);
  assert.match((await openZip(Buffer.from('hello'))).message, /^a\.zip: cannot be read \(.*\); must be a zip archive$/);
  const wrongSum = [{ name: 'scene.json', content: '{}', crc: 1 }];
  assert.match((await openZip(zipOf(wrongSum))).message, /^a\.zip\/scene\.json: cannot be read \(.*\); must be undamaged$/);
  assert.equal(await titleOf(page), 'A dome');
  await page.leave();
});
