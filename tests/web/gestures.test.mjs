/** Real pointers, wheels, fingers and keys on a viewer, and the page's right to scroll. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { kScenes } from './scenes.mjs';
import {
  boxOf,
  brightness,
  complete,
  difference,
  openStage,
  openViewers,
  pictureOf,
  quiet,
  valueOf,
} from './support.mjs';

const kViewer = '<lucent-viewer src="made/dome.json" alt="A dome"></lucent-viewer><div id="tail"></div>';
const kPanelViewer = kViewer.replace('alt', 'controls alt');
const kLight = 'lights.0.position';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

// A viewer of 400 x 300 CSS pixels at the top of a page that is long enough to scroll.
async function open(markup = kViewer, { width = 400, height = 300, ...options } = {}) {
  const page = await openViewers(stage, markup, options);
  await page.evaluate(
    ([wide, high]) => {
      Object.assign(document.querySelector('lucent-viewer').style, { width: `${wide}px`, height: `${high}px` });
      document.querySelector('#tail').style.height = '3000px';
    },
    [width, height],
  );
  await complete(page);
  return page;
}

const scrollOf = (page) => page.evaluate(() => scrollY);
const leftBrightness = async (page) => brightness(await pictureOf(page), [0.2, 0.2, 0.45, 0.8]);
const rightBrightness = async (page) => brightness(await pictureOf(page), [0.55, 0.2, 0.8, 0.8]);

test('a wheel over a viewer scrolls the page and changes nothing', async () => {
  const page = await open();
  const before = await valueOf(page, kLight);
  await page.mouse.move(200, 100);
  await page.mouse.wheel(0, 100);
  await page.waitForFunction(() => scrollY === 100);
  assert.deepEqual(await valueOf(page, kLight), before);
  assert.match(await page.textContent('lucent-viewer .hint'), /Click to interact/);
  await page.leave();
});

test('after a click the wheel lifts the light and the page stays', async () => {
  const page = await open();
  const [, , before] = await valueOf(page, kLight);
  await page.mouse.click(200, 150);
  await page.mouse.wheel(0, -200);
  await page.waitForFunction(([path, z]) => document.querySelector('lucent-viewer').get(path)[2] > z, [kLight, before]);
  await quiet(page);
  assert.equal(await scrollOf(page), 0);
  await page.leave();
});

test('escape gives the wheel back to the page', async () => {
  const page = await open();
  await page.mouse.click(200, 150);
  await page.keyboard.press('Escape');
  const before = await valueOf(page, kLight);
  await page.mouse.wheel(0, 200);
  await page.waitForFunction(() => scrollY === 200);
  assert.deepEqual(await valueOf(page, kLight), before);
  await page.leave();
});

test('a wheel over the panel scrolls the panel, without a click, and at its end the page', async () => {
  const page = await open(kPanelViewer, { width: 790, height: 400 });
  const widgets = () => page.evaluate(() => document.querySelector('lucent-viewer').stats().panel);
  const [path, before] = Object.entries(await widgets()).at(-1);
  await page.mouse.move(600, 100);
  await page.mouse.move(640, 200);
  await page.mouse.wheel(0, 40);
  await page.waitForFunction(
    ([one, top]) => {
      const place = document.querySelector('lucent-viewer').stats().panel[one];
      return place && Math.abs(place[1] - (top - 40)) < 2;
    },
    [path, before[1]],
  );
  assert.equal(await scrollOf(page), 0);
  await page.mouse.wheel(0, 5000); // to its end
  await quiet(page);
  assert.equal(await scrollOf(page), 0);
  await page.mouse.wheel(0, 100);
  await page.waitForFunction(() => scrollY === 100);
  await page.leave();
});

test('a lamp outside the picture comes to the hand by its arrow, one behind the camera moves by it', async () => {
  const page = await open();
  const lamp = () => page.evaluate(() => document.querySelector('lucent-viewer').stats().lamps[0]);
  const pull = async (from, to) => {
    await page.mouse.move(...from);
    await page.mouse.down();
    await page.mouse.move(...to, { steps: 4 });
    await page.mouse.up();
    await complete(page);
  };
  await page.evaluate((path) => document.querySelector('lucent-viewer').set(path, [5, 0.1, 0.6]), kLight);
  const { place, outside } = await lamp();
  assert.equal(outside, true);
  assert.ok(place[0] > 350 && place[0] < 400, `arrow at ${place}`);
  await pull(place, [260, 120]);
  const moved = await lamp();
  assert.equal(moved.outside, false);
  assert.ok(Math.hypot(moved.place[0] - 260, moved.place[1] - 120) < 1, `dot at ${moved.place}`);
  assert.equal((await valueOf(page, kLight))[2], 0.6); // it keeps its height
  await page.leave();
});

test('every lamp of a scene without a relief can be moved by its dot or arrow, in front, outside, behind, far away', async () => {
  const banner = JSON.parse(kScenes['banner.json']);
  banner.camera = { type: 'perspective', eye: [0, 0, 2], fov: 60 };
  banner.lights = [
    { type: 'point', position: [0.4, 0.3, 0] },
    { type: 'point', position: [-9, 0, 0] },
    { type: 'spot', position: [0, 4, 5], direction: [0, -1, -1] },
    { type: 'area', corner: [0.3, -6, 0], edgeU: [0.1, 0, 0], edgeV: [0, 0.1, 0] },
    { type: 'distant', direction: [0.5, -0.2, -1] },
  ];
  const page = await openViewers(stage, '<div id="tail"></div>');
  await page.route('**/made/lamps.json', (route) => route.fulfill({ body: JSON.stringify(banner) }));
  await page.evaluate(() => {
    document.body.insertAdjacentHTML('afterbegin', '<lucent-viewer src="made/lamps.json"></lucent-viewer>');
    Object.assign(document.querySelector('lucent-viewer').style, { width: '400px', height: '300px' });
  });
  await complete(page);
  const lampsOf = () => page.evaluate(() => document.querySelector('lucent-viewer').stats().lamps);
  assert.deepEqual((await lampsOf()).map(({ outside }) => outside), [false, true, true, true, false]);
  const paths = ['position', 'position', 'position', 'corner', 'direction'].map((name, at) => `lights.${at}.${name}`);
  for (const [index, path] of paths.entries()) {
    const before = await valueOf(page, path);
    const { x, y } = await boxOf(page);
    const [left, top] = (await lampsOf())[index].place;
    await page.mouse.move(x + left, y + top);
    await page.mouse.down();
    await page.mouse.move(x + left + (left > 200 ? -30 : 30), y + top + (top > 150 ? -20 : 20), { steps: 3 });
    await page.mouse.up();
    assert.notDeepEqual(await valueOf(page, path), before, path);
  }
  assert.deepEqual(await valueOf(page, 'camera.eye'), [0, 0, 2]);
  await page.leave();
});

test('dragging the light across moves the bright side of the picture', async () => {
  const page = await open();
  assert.ok((await leftBrightness(page)) > (await rightBrightness(page)) + 20, 'lit from the left');
  await page.mouse.move(60, 150);
  await page.mouse.down();
  await page.mouse.move(300, 150, { steps: 4 });
  await page.mouse.move(540, 150, { steps: 4 }); // 480 pixels of 300 a metre: 1.6 m
  await page.mouse.up();
  await complete(page);
  const [x] = await valueOf(page, kLight);
  assert.ok(Math.abs(x - 0.8) < 0.01, `light at x = ${x}`);
  assert.ok((await rightBrightness(page)) > (await leftBrightness(page)) + 20, 'lit from the right');
  await page.leave();
});

test('a drag fires change with path and value, and one undo takes it back', async () => {
  const page = await open();
  const before = await valueOf(page, kLight);
  await page.evaluate(() => {
    window.changes = [];
    document.querySelector('lucent-viewer').addEventListener('change', ({ detail }) => window.changes.push(detail));
  });
  await page.mouse.move(100, 150);
  await page.mouse.down();
  await page.mouse.move(160, 150, { steps: 6 });
  await page.mouse.up();
  await complete(page);
  const last = await page.evaluate(() => window.changes.at(-1));
  assert.deepEqual(last, { path: kLight, value: await valueOf(page, kLight) });
  await page.evaluate(() => document.querySelector('lucent-viewer').undo());
  assert.deepEqual(await valueOf(page, kLight), before);
  await page.leave();
});

test('arrow keys move the light, tab moves on', async () => {
  const page = await open(kViewer + '<button id="next">next</button>');
  const [before] = await valueOf(page, kLight);
  await page.keyboard.press('Tab');
  await page.keyboard.press('ArrowRight');
  assert.ok((await valueOf(page, kLight))[0] > before);
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'next');
  await page.leave();
});

test('in an environment a drag turns the map and the picture with it', async () => {
  const page = await open(kViewer.replace('dome', 'sky'));
  const before = await pictureOf(page);
  await page.mouse.move(100, 150);
  await page.mouse.down();
  await page.mouse.move(250, 150, { steps: 4 }); // half of the shorter side: 90 degrees about y
  await page.mouse.up();
  await complete(page);
  const [x, y, z] = await valueOf(page, 'environment.rotation');
  assert.ok(Math.abs(Math.abs(y) - 90) < 1 && x === 0 && z === 0, `rotation ${x} ${y} ${z}`);
  assert.ok(difference(before, await pictureOf(page)).share > 0.2);
  await page.leave();
});

test('without a relief a drag orbits the camera and the wheel zooms, once the picture was clicked', async () => {
  const page = await open(kViewer.replace('dome', 'banner'));
  await page.mouse.move(200, 280);
  await page.mouse.wheel(0, 100);
  await page.waitForFunction(() => scrollY === 100);
  assert.equal(await valueOf(page, 'camera.height'), 2);
  await page.evaluate(() => scrollTo(0, 0));
  await page.mouse.down();
  await page.mouse.move(350, 280, { steps: 4 }); // half of the shorter side: 90 degrees about y
  await page.mouse.up();
  const [x, y, z] = await valueOf(page, 'camera.eye');
  assert.ok(Math.hypot(x + 2, y, z) < 0.05, `eye ${x} ${y} ${z}`);
  await page.mouse.wheel(0, -100);
  await page.waitForFunction(() => document.querySelector('lucent-viewer').get('camera.height') < 2);
  assert.equal(await scrollOf(page), 0);
  await page.leave();
});

test('a slider of the panel follows a real pointer', async () => {
  const page = await open(kPanelViewer, { width: 900, height: 1200, viewport: { width: 1000, height: 1260 } });
  const path = 'objects.relief.material.specularity';
  const [x, y, width, height] = await page.evaluate(
    (name) => document.querySelector('lucent-viewer').stats().panel[name],
    path,
  );
  const before = await pictureOf(page);
  const box = await boxOf(page);
  const middle = box.y + y + height / 2;
  await page.mouse.move(box.x + x + 0.1 * width, middle);
  await page.mouse.down();
  await page.mouse.move(box.x + x + 0.8 * width, middle, { steps: 6 });
  await page.mouse.up();
  await complete(page);
  const value = await valueOf(page, path);
  assert.ok(Math.abs(value - 0.8) < 0.05, `specularity ${value}`); // its slider goes from 0 to 1
  assert.ok(difference(before, await pictureOf(page)).share > 0.1);
  await page.leave();
});

// ---- fingers

const kPhone = { viewport: { width: 400, height: 700 }, hasTouch: true };

async function touch(page, type, ...points) {
  const session = (page.session ??= await page.context().newCDPSession(page));
  await session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
}

async function swipe(page, from, to) {
  await touch(page, 'touchStart', from);
  for (let step = 1; step <= 8; ++step) {
    await touch(
      page,
      'touchMove',
      [0, 1].map((axis) => from[axis] + ((to[axis] - from[axis]) * step) / 8),
    );
    await page.waitForTimeout(20);
  }
  await touch(page, 'touchEnd');
}

test('one finger scrolls the page', async () => {
  const page = await open(kViewer, kPhone);
  const before = await valueOf(page, kLight);
  await swipe(page, [200, 250], [200, 60]);
  await page.waitForFunction(() => scrollY > 100);
  assert.deepEqual(await valueOf(page, kLight), before);
  await page.leave();
});

test('after a tap one finger moves the light and the page stays', async () => {
  const page = await open(kViewer, kPhone);
  await page.touchscreen.tap(200, 150);
  const [, before] = await valueOf(page, kLight);
  await swipe(page, [200, 250], [200, 100]); // upwards: half of the picture's metre
  const [, y] = await valueOf(page, kLight);
  assert.ok(Math.abs(y - before - 0.5) < 0.02, `light at y = ${y}, was ${before}`);
  assert.equal(await scrollOf(page), 0);
  await page.leave();
});

test('two fingers zoom at once and the page stays', async () => {
  const page = await open(kViewer, kPhone);
  const before = await valueOf(page, 'camera.height');
  await touch(page, 'touchStart', [180, 150], [220, 150]);
  for (let step = 1; step <= 5; ++step) {
    await touch(page, 'touchMove', [180 - 8 * step, 150], [220 + 8 * step, 150]);
    await page.waitForTimeout(20);
  }
  await touch(page, 'touchEnd');
  const after = await valueOf(page, 'camera.height');
  assert.ok(Math.abs(after - before / 3) < 0.03 * before, `height ${after}, was ${before}`); // 40 to 120 pixels apart
  assert.equal(await scrollOf(page), 0);
  await page.leave();
});
