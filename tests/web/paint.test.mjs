/** Mode paint by real pointers: what changes where, scripts, undo, files, and the twins of its layers and buttons. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { kScenes } from './scenes.mjs';
import {
  boxOf,
  brightness,
  complete,
  difference,
  openPage,
  openStage,
  openViewers,
  pictureOf,
  valueOf,
} from './support.mjs';

const kSide = 150; // CSS pixels; 0.2 mm each, so that the ball of 20 mm is 100 wide

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

const kOpaque = 'paint-unpainted="opaque" paint-brush="translucency"';
const viewerOf = (name, scene, attributes = '') =>
  `<lucent-viewer id="${name}" src="made/${scene}" alt="A ball" ${attributes}></lucent-viewer>`;

async function ready(page, name) {
  await page.evaluate(
    ([id, side]) =>
      Object.assign(document.getElementById(id).style, { width: `${side}px`, height: `${side}px`, maxHeight: 'none' }),
    [name, kSide],
  );
  await complete(page, `#${name}`);
}

/** A page with a marble ball, lit from the left, that becomes opaque, and a brush of 2 mm, 10 pixels. */
async function open(attributes = '', options) {
  const page = await openViewers(stage, viewerOf('hand', 'ball.json', `${kOpaque} ${attributes}`), options);
  await ready(page, 'hand');
  await set(page, 'mode', 'paint');
  await set(page, 'view.lightDot', false); // a lamp's dot is gripped, not painted on
  await set(page, 'paint.radius', 0.002);
  await set(page, 'paint.hardness', 1);
  return page;
}

const call = (page, name, ...values) =>
  page.evaluate(([method, list]) => document.querySelector('lucent-viewer')[method](...list), [name, values]);
const set = (page, path, value) => call(page, 'set', path, value);
const strokesOf = (page) => page.evaluate(() => document.querySelector('lucent-viewer').strokes.strokes);
const finished = async (page, name = 'hand') => (await complete(page, `#${name}`), pictureOf(page, `#${name}`));

/** Leads the mouse, pressed, along places given in pixels from the ball's middle, and then off the picture. */
async function draw(page, ...places) {
  const { x, y } = await boxOf(page, '#hand');
  const to = ([right, down]) => page.mouse.move(x + kSide / 2 + right, y + kSide / 2 + down, { steps: 3 });
  await to(places[0]);
  await page.mouse.down();
  for (const place of places.slice(1)) await to(place);
  await page.mouse.up();
  await page.mouse.move(790, 590); // no ring shows where the brush would paint
}

/** Tells the painted maps of a viewer apart by every bit; null without paint. */
const mapsOf = (page, name = 'hand') =>
  page.evaluate(async (id) => {
    const maps = document.getElementById(id).paintedMaps();
    if (!maps) return null;
    const digest = async (texels) => new Uint8Array(await crypto.subtle.digest('SHA-256', texels)).join();
    return [maps.side, await digest(maps.entering), await digest(maps.leaving)];
  }, name);

/** A square around a place in pixels from the middle, as shares of the picture. */
const around = ([right, down], half = 3) =>
  [right - half, down - half, right + half, down + half].map((pixels) => 0.5 + pixels / kSide);

/** Largest difference of two pictures in such a square, [0, 255]. */
function differenceAt(a, b, place) {
  const [left, top, right, bottom] = around(place).map((share) => Math.round(share * kSide));
  let most = 0;
  for (let y = top; y < bottom; ++y)
    for (let at = 4 * (y * a.width + left); at < 4 * (y * a.width + right); ++at)
      most = Math.max(most, Math.abs(a.pixels[at] - b.pixels[at]));
  return most;
}

test('a drag paints where it goes, and nowhere else', async () => {
  const page = await open();
  assert.equal(await mapsOf(page), null);
  await draw(page, [-25, 30]); // the ball is opaque but for this from now on
  await set(page, 'technique.subsurface.method', 'multires');
  const once = await finished(page);
  await draw(page, [-35, -15], [-5, -15], [10, 0]);
  const twice = await finished(page);
  for (const place of [[-20, -15], [-5, -15], [8, -2]]) assert.ok(differenceAt(once, twice, place) > 8, `${place}`);
  for (const place of [[-30, 10], [0, 15], [25, -25]]) assert.equal(differenceAt(once, twice, place), 0, `${place}`);
  const [start, , drag] = await strokesOf(page);
  assert.deepEqual(start, { brush: 'translucency', value: 0, fill: {} });
  assert.ok(drag.dabs.length > 15, `${drag.dabs.length} dabs a quarter of the radius apart`);
  for (const [x, y, z] of drag.dabs) assert.ok(Math.abs(Math.hypot(x, y, z) - 0.01) < 1e-4 && z > 0);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('what becomes of the rest is asked once, and the first stroke is seen', async () => {
  for (const [answer, strokes] of [['They stay as they are', 1], ['They become opaque', 2]]) {
    const page = await openViewers(stage, viewerOf('hand', 'ball.json', 'mode="paint"'));
    await ready(page, 'hand');
    const question = page.locator('#hand .question');
    assert.equal(await question.getAttribute('role'), 'dialog');
    await question.locator(`button:text("${answer}")`).click();
    await set(page, 'mode', 'subsurface');
    await set(page, 'mode', 'paint');
    assert.equal(await question.count(), 0);
    assert.equal(await valueOf(page, 'paint.radius'), 0.0012); // of a ball of 20 mm
    await set(page, 'technique.subsurface.method', 'multires'); // lambert draws no glow
    const before = await finished(page);
    await draw(page, [-20, -10], [0, -10]);
    const after = await finished(page);
    assert.equal((await strokesOf(page)).length, strokes);
    const seen = differenceAt(before, after, [-10, -10]);
    assert.ok(seen > 20, `${answer}: ${seen}`);
    const elsewhere = differenceAt(before, after, [10, 30]); // light that spreads from the stroke
    assert.ok(strokes === 1 ? elsewhere < 8 : elsewhere > 8, `${answer}: ${elsewhere}`);
    assert.deepEqual(page.problems, []);
    await page.leave();
  }
});

test('nothing is asked of what is painted, nor where the page has said it', async () => {
  const painted = JSON.parse(kScenes['ball.json']);
  painted.objects[0].paint = { strokes: [{ brush: 'glow', value: [1, 0, 0], fill: {} }], side: 64 };
  const page = await openPage(stage, 'blank.html', {
    markup: viewerOf('hand', 'painted.json', 'mode="paint"') + viewerOf('said', 'ball.json', `mode="paint" ${kOpaque}`),
  });
  await page.route('**/made/painted.json', (route) => route.fulfill({ body: JSON.stringify(painted) }));
  await page.reload();
  await ready(page, 'hand');
  await ready(page, 'said');
  assert.equal(await valueOf(page, 'mode', '#hand'), 'paint');
  assert.equal(await page.locator('.question').count(), 0);
  await page.leave();
});

test('a card of the gallery for paint opens in that mode', async () => {
  const entry = { id: 'ball', title: 'A ball', caption: '', kind: 'Paint', scene: 'ball.json' };
  const page = await openPage(stage, 'blank.html');
  await page.route('**/gallery/index.json', (route) => route.fulfill({ body: JSON.stringify([entry]) }));
  await page.goto(new URL('index.html', stage.address).href);
  await page.waitForFunction(() => document.querySelector('lucent-viewer').loaded);
  assert.equal(await valueOf(page, 'mode'), 'paint');
  assert.equal(await page.locator('lucent-viewer .question').isVisible(), true);
  await page.leave();
});

test('what a hand paints comes back from its script, from the saved scene, and from undo and redo, to the bit', async () => {
  const page = await open();
  const [empty, steps] = [await finished(page), []];
  const step = async () => steps.push({ maps: await mapsOf(page), picture: await finished(page) });
  await draw(page, [-30, -20], [0, -20]);
  await step();
  await set(page, 'paint.brush', 'glow');
  await set(page, 'paint.color', [1, 0.2, 0.1]);
  await set(page, 'paint.symmetric', true);
  await draw(page, [-25, -30], [-15, -5]);
  await step();
  await set(page, 'paint.brush', 'translucency');
  await page.locator('#hand canvas').focus();
  await page.keyboard.press('x'); // erase
  await draw(page, [-15, -20]);
  await step();
  const last = steps.at(-1);
  assert.equal(new Set(steps.map(({ maps }) => String(maps))).size, 3, 'every stroke changes the maps');

  const script = await page.evaluate(() => document.querySelector('lucent-viewer').strokes);
  const saved = await page.evaluate(() => document.querySelector('lucent-viewer').sceneJson);
  await page.route('**/made/saved.json', (route) => route.fulfill({ body: saved }));
  await page.evaluate(
    (markup) => document.body.insertAdjacentHTML('beforeend', markup),
    viewerOf('script', 'ball.json') + viewerOf('file', 'saved.json'),
  );
  await ready(page, 'script');
  await page.evaluate((strokes) => document.getElementById('script').paint(strokes), script);
  await ready(page, 'file');
  for (const name of ['script', 'file']) {
    assert.deepEqual(await mapsOf(page, name), last.maps, name);
    assert.equal(difference(await finished(page, name), last.picture).max, 0, name);
  }

  for (const { maps, picture } of [steps[1], steps[0], { maps: null, picture: empty }]) {
    assert.equal(await call(page, 'undo'), true);
    assert.deepEqual(await mapsOf(page), maps);
    assert.equal(difference(await finished(page), picture).max, 0);
  }
  for (const { maps } of steps) {
    assert.equal(await call(page, 'redo'), true);
    assert.deepEqual(await mapsOf(page), maps);
  }
  assert.equal(difference(await finished(page), last.picture).max, 0);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('layers show the maps, both sides of a symmetric stroke, and opaque where it is erased', async () => {
  const page = await open();
  await set(page, 'paint.layer', 'translucency');
  await set(page, 'paint.symmetric', true);
  await draw(page, [20, 10]);
  const shown = async (place) => brightness(await finished(page), around(place));
  assert.equal(await shown([20, 10]), 255);
  assert.equal(await shown([-20, 10]), 255);
  assert.equal(await shown([0, -20]), 0);
  await set(page, 'paint.symmetric', false);
  await set(page, 'paint.erase', true);
  await draw(page, [-20, 10]);
  assert.equal(await shown([-20, 10]), 0);
  assert.equal(await shown([20, 10]), 255);
  await page.leave();
});

test('layers, fill and clear have twins in the order of the panel, which the keyboard works', async () => {
  const page = await open('controls', { viewport: { width: 800, height: 1050 } });
  await page.evaluate(() =>
    Object.assign(document.querySelector('lucent-viewer').style, { width: '700px', height: '1000px' }),
  );
  await complete(page);
  const twins = await page.evaluate(() =>
    [...document.querySelector('lucent-viewer').shadowRoot.querySelectorAll('.twin [data-path]')].map((row) => ({
      path: row.dataset.path,
      name: row.querySelector('input, select')?.ariaLabel ?? row.querySelector('button').textContent,
      group: row.closest('fieldset').querySelector('legend').textContent,
    })),
  );
  const first = twins.filter(({ group }) => group === twins[0].group);
  assert.deepEqual(first.slice(-7).map(({ path }) => path), [
    'paint.unpainted', 'paint.layer', 'paint.fill', 'paint.clearTranslucency', 'paint.clearBlur', 'paint.clearGlow',
    'paint.clearOutgoing',
  ]);
  assert.ok(first.every(({ name }) => name));
  const places = await page.evaluate(() => document.querySelector('lucent-viewer').stats().panel);
  const drawn = first.filter(({ path }) => places[path]);
  assert.equal(drawn.length, first.length, 'all of them stand in the panel');
  drawn.slice(1).forEach(({ path }, index) => {
    const [x, y] = places[path];
    const [left, top] = places[drawn[index].path];
    assert.ok(y > top || (y === top && x > left), `${path} comes after ${drawn[index].path}`);
  });

  const press = async (path, key) => {
    await page.locator(`#hand [data-path="${path}"] :is(select, button)`).first().focus();
    await page.keyboard.press(key);
    await complete(page);
  };
  const middle = async () => brightness(await pictureOf(page), [0.48, 0.48, 0.52, 0.52]);
  await press('paint.fill', 'Enter');
  assert.equal((await strokesOf(page)).length, 2); // opaque, and then all of it translucent
  await press('paint.layer', 't'); // a select goes to what begins so
  assert.equal(await valueOf(page, 'paint.layer'), 'translucency');
  assert.equal(await middle(), 255);
  await press('paint.clearTranslucency', ' ');
  assert.equal(await middle(), 0);
  assert.equal(
    await page.evaluate(() => document.querySelector('lucent-viewer').shadowRoot.activeElement.textContent),
    'Clear translucency',
  );
  const [x, y, width, height] = places['paint.fill']; // of the panel, by a real pointer
  const box = await boxOf(page, '#hand');
  await page.mouse.click(box.x + x + width / 2, box.y + y + height / 2);
  await complete(page);
  assert.equal(await middle(), 255);
  assert.deepEqual(page.problems, []);
  await page.leave();
});
