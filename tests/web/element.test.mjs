/** <lucent-viewer> as a page uses it: attributes, properties, events, files, sizes and places. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { kScenes } from './scenes.mjs';
import {
  brightness,
  complete,
  decodePng,
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

const kDome = '<lucent-viewer src="made/dome.json" alt="A dome"></lucent-viewer>';
const kDepth = 'objects.relief.material.depth';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

async function open(markup = kDome, options) {
  const page = await openViewers(stage, markup, options);
  await resize(page, 400, 300);
  await complete(page);
  return page;
}

async function resize(page, width, height) {
  await page.evaluate(
    ([w, h]) => {
      for (const viewer of document.querySelectorAll('lucent-viewer'))
        Object.assign(viewer.style, { width: `${w}px`, height: `${h}px` });
    },
    [width, height],
  );
}

test('attributes and properties mirror the parameters', async () => {
  const page = await open(kDome.replace('alt', 'material-depth="0.2" light="0.5 0 0.4" view-light-dot="false" alt'));
  const values = () =>
    page.evaluate(() => {
      const viewer = document.querySelector('lucent-viewer');
      return [viewer.materialDepth, viewer.light, viewer.viewLightDot];
    });
  assert.deepEqual(await values(), [0.2, [0.5, 0, 0.4], false]);
  await page.evaluate(() => document.querySelector('lucent-viewer').setAttribute('material-depth', '0.3'));
  assert.equal(await valueOf(page, kDepth), 0.3);
  const attribute = await page.evaluate(() => {
    const viewer = document.querySelector('lucent-viewer');
    viewer.light = [0.1, 0.2, 0.7];
    return viewer.getAttribute('light');
  });
  assert.equal(attribute, '0.1 0.2 0.7');
  assert.deepEqual(await values(), [0.3, [0.1, 0.2, 0.7], false]);
  await page.evaluate(() => document.querySelector('lucent-viewer').removeAttribute('material-depth'));
  assert.equal(await valueOf(page, kDepth), 0.01); // as the scene has it
  await page.leave();
});

test('a wrong attribute fires error with the text of the loader and changes nothing', async () => {
  const page = await open();
  const detail = await eventOf(page, 'error', () =>
    page.evaluate(() => document.querySelector('lucent-viewer').setAttribute('material-depth', '-1')),
  );
  assert.deepEqual(detail, { code: 'value', message: `${kDepth} is -1; must be in (0, 1000]` });
  assert.equal(await valueOf(page, kDepth), 0.01);
  await page.leave();
});

test('two viewers share one context and keep out of each other', async () => {
  const page = await open(
    kDome.replace('<lucent-viewer', '<lucent-viewer id="one"') +
      '<lucent-viewer id="two" src="made/ridge.json"></lucent-viewer>',
  );
  await complete(page, '#two');
  const [one, two] = [await pictureOf(page, '#one'), await pictureOf(page, '#two')];
  assert.ok(difference(one, two).share > 0.2, 'both show the same');
  await page.evaluate((path) => document.querySelector('#two').set(path, 0.3), kDepth);
  await complete(page, '#two');
  assert.deepEqual(difference(one, await pictureOf(page, '#one')), { max: 0, mean: 0, share: 0 });
  assert.equal(await page.evaluate(() => window.seen.contexts.length), 1);
  await page.leave();
});

test('a scene with an error fires error, says so on the canvas and keeps the old picture', async () => {
  const page = await open();
  const [picture, shown] = [await pictureOf(page), await shownBy(page)];
  const detail = await eventOf(page, 'error', () =>
    page.evaluate(() => (document.querySelector('lucent-viewer').src = 'made/broken.json')),
  );
  assert.equal(detail.code, 'scene');
  assert.match(detail.message, /^broken\.json:\d+: objects\.relief\.shape\.heightScale is .*tall.*; must be a number$/);
  await quiet(page);
  const changed = difference(shown, await shownBy(page), 8).share;
  assert.ok(changed > 0.02 && changed < 0.6, `the message covers ${changed}`);
  assert.equal(await page.textContent('lucent-viewer [role=status]'), detail.message);
  assert.deepEqual(difference(picture, await pictureOf(page)), { max: 0, mean: 0, share: 0 });
  await page.leave();
});

test('a file that is not there is named with the answer of the server', async () => {
  const page = await open();
  const detail = await eventOf(page, 'error', () =>
    page.evaluate(() => (document.querySelector('lucent-viewer').src = 'made/missing.json')),
  );
  assert.deepEqual(detail, { code: 'fetch', message: 'nowhere.pfm: the server answers 404; must be there' });
  await page.leave();
});

test('a new scene takes the place of the old one and fires load', async () => {
  const page = await open();
  const before = await pictureOf(page);
  await eventOf(page, 'load', () =>
    page.evaluate(() => (document.querySelector('lucent-viewer').src = 'made/ridge.json')),
  );
  await complete(page);
  assert.equal(await page.evaluate(() => document.querySelector('lucent-viewer').sceneTitle), 'A ridge');
  assert.ok(difference(before, await pictureOf(page)).share > 0.2);
  await page.leave();
});

test('toBlob gives a PNG of the size of the canvas, which follows size and pixel ratio', async () => {
  for (const ratio of [1, 2]) {
    const page = await open(kDome, { deviceScaleFactor: ratio });
    let { width, height } = await pictureOf(page);
    assert.deepEqual([width, height], [400 * ratio, 300 * ratio]);
    await resize(page, 321, 217);
    await quiet(page);
    ({ width, height } = await pictureOf(page));
    assert.deepEqual([width, height], [321 * ratio, 217 * ratio]);
    await page.leave();
  }
});

test('pixels are never finer than two a CSS pixel', async () => {
  const page = await open(kDome, { deviceScaleFactor: 3 });
  const { width, height } = await pictureOf(page);
  assert.deepEqual([width, height], [800, 600]);
  await page.leave();
});

// Runs in the page: a file that comes in drops, and stops coming when that is asked for.
function fetchSlowly() {
  const fetchAll = window.fetch;
  window.fetch = (address, options) => {
    if (!String(address).endsWith('slow.pfm')) return fetchAll(address, options);
    const body = new ReadableStream({
      start(controller) {
        const timer = setInterval(() => controller.enqueue(new Uint8Array(5)), 300);
        options.signal.addEventListener('abort', () => {
          clearInterval(timer);
          controller.error(options.signal.reason);
        });
      },
    });
    return Promise.resolve(new Response(body, { headers: { 'Content-Length': '1000' } }));
  };
}

test('a load that takes long tells the time left, and cancel keeps what was shown', async () => {
  const page = await open(kDome, { init: fetchSlowly });
  const slow = kScenes['dome.json'].replace('dome.pfm', 'slow.pfm');
  await page.route('**/made/slow.json', (route) => route.fulfill({ body: slow }));
  await page.evaluate(() => (document.querySelector('lucent-viewer').src = 'made/slow.json'));
  const bar = page.locator('lucent-viewer .loading');
  await bar.waitFor();
  assert.match(await bar.textContent(), /^Loading: \d+ s left/);
  await bar.locator('button').click();
  await bar.waitFor({ state: 'hidden' });
  assert.equal(await page.evaluate(() => document.querySelector('lucent-viewer').sceneTitle), 'A dome');
  await eventOf(page, 'load', () =>
    page.evaluate(() => (document.querySelector('lucent-viewer').src = 'made/ridge.json')),
  );
  assert.equal(await page.evaluate(() => document.querySelector('lucent-viewer').sceneTitle), 'A ridge');
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('work that takes long tells the time left, and stops when asked', async () => {
  const page = await open(kDome.replace('alt', 'sampling-pixel-samples="1" alt'));
  assert.equal(await page.locator('lucent-viewer .drawing').isVisible(), false);
  assert.equal(await page.evaluate(() => document.querySelector('lucent-viewer').stop()), false);
  await page.evaluate(() => document.querySelector('lucent-viewer').setAttribute('sampling-pixel-samples', '256'));
  await page.locator('lucent-viewer .drawing', { hasText: /^Antialiasing: [1-9]\d* s left/ }).waitFor();
  await page.click('lucent-viewer .drawing button');
  await page.locator('lucent-viewer .drawing').waitFor({ state: 'hidden' });
  await complete(page);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('where the processor draws, a picture keeps 3 % unless it is to be whole', async () => {
  const sky = kDome.replace('dome.json', 'sky.json').replace('alt', 'sampling-directions="300" alt');
  const settings = async (more) => {
    const page = await open(sky.replace('alt', `${more} alt`));
    const { settings, lights } = await page.evaluate(() => document.querySelector('lucent-viewer').stats());
    assert.deepEqual(page.problems, []);
    await page.leave();
    return { settings, lights };
  };
  const [automatic, full] = [await settings(''), await settings('accuracy="full"')];
  assert.match(automatic.settings, /error about [\d.]+ %$/);
  assert.equal(full.settings, '');
  assert.ok(automatic.lights < full.lights, `${automatic.lights} lights, ${full.lights} in full`);
});

test('the poster is shown until the first preview, and the text goes with it', async () => {
  const page = await openViewers(stage, kDome.replace('src="made/dome.json"', 'poster="made/small.png"'));
  await resize(page, 400, 300);
  assert.equal(await page.locator('lucent-viewer .poster').isVisible(), true);
  await page.evaluate(() => (document.querySelector('lucent-viewer').src = 'made/dome.json'));
  await complete(page);
  assert.equal(await page.locator('lucent-viewer .poster').isVisible(), false);
  assert.equal(await page.textContent('lucent-viewer .status'), '');
  await page.leave();
});

test('a lazy viewer loads when it comes near', async () => {
  const page = await openViewers(stage, '<br>'.repeat(200) + kDome.replace('alt', 'loading="lazy" alt'));
  await resize(page, 400, 300);
  await page.waitForTimeout(500);
  assert.equal(await page.evaluate(() => document.querySelector('lucent-viewer').loaded), false);
  await page.evaluate(() => document.querySelector('lucent-viewer').scrollIntoView());
  await complete(page);
  await page.leave();
});

test('a viewer off screen draws nothing, gives its memory back and comes back with the same picture', async () => {
  const page = await open(kDome + '<div id="space"></div>');
  const before = await pictureOf(page);
  await page.evaluate(() => (document.querySelector('#space').style.height = '4000px'));
  await page.evaluate(() => scrollTo(0, 4000));
  await quiet(page);
  const draws = await drawsOf(page);
  await page.evaluate((path) => document.querySelector('lucent-viewer').set(path, 0.3), kDepth);
  await page.waitForFunction(() => document.querySelector('lucent-viewer').stats().bytes === 0);
  assert.equal(await drawsOf(page), draws);
  await page.evaluate((path) => document.querySelector('lucent-viewer').reset(path), kDepth);
  await page.evaluate(() => scrollTo(0, 0));
  await complete(page);
  assert.deepEqual(difference(before, await pictureOf(page)), { max: 0, mean: 0, share: 0 });
  await page.leave();
});

test('an element that moves within the page keeps its scene and its settings', async () => {
  const page = await open(kDome + '<section></section>');
  await page.evaluate((path) => {
    const viewer = document.querySelector('lucent-viewer');
    viewer.set(path, 0.3);
    document.querySelector('section').append(viewer);
  }, kDepth);
  await quiet(page);
  assert.equal(await valueOf(page, kDepth), 0.3);
  await page.leave();
});

test('without OffscreenCanvas the picture is the same', async () => {
  const page = await open();
  const plain = await pictureOf(page);
  const old = await open(kDome, { init: () => delete window.OffscreenCanvas });
  assert.deepEqual(difference(plain, await pictureOf(old)), { max: 0, mean: 0, share: 0 });
  await page.leave();
  await old.leave();
});

test('without WebGL2 the reason stands over the poster', async () => {
  const init = () => {
    for (const kind of [OffscreenCanvas, HTMLCanvasElement]) {
      const getContext = kind.prototype.getContext;
      kind.prototype.getContext = function (type, ...rest) {
        return type === 'webgl2' ? null : getContext.call(this, type, ...rest);
      };
    }
  };
  const page = await openViewers(stage, kDome, { init });
  await page.waitForFunction(() =>
    document.querySelector('lucent-viewer').shadowRoot.querySelector('.status').textContent.includes('WebGL2'),
  );
  assert.match(await page.textContent('lucent-viewer [role=status]'), /WebGL2 is not available/);
  await page.leave();
});

test('it works in a sandboxed frame without an origin', async () => {
  const page = await openPage(stage, 'blank.html', {
    markup: '<iframe sandbox="allow-scripts" width="400" height="300"></iframe>',
  });
  const frameMarkup = kDome.replace('src="made/dome.json"', 'src="gallery/dome.json"');
  await page.route('**/inner.html', (route) =>
    route.fulfill({
      contentType: 'text/html',
      body: `<script type="module" src="lucent-viewer.js"></script>${frameMarkup}`,
    }),
  );
  await page.evaluate(() => (document.querySelector('iframe').src = 'inner.html'));
  const frame = await (await page.waitForSelector('iframe')).contentFrame();
  await frame.waitForFunction(() => document.querySelector('lucent-viewer')?.stats?.().complete);
  await page.leave();
});

test('a saved picture decodes to what toBlob drew', async () => {
  const page = await open();
  const bytes = Buffer.from(
    await page.evaluate(async () => {
      const blob = await document.querySelector('lucent-viewer').toBlob();
      const text = String.fromCharCode(...new Uint8Array(await blob.arrayBuffer()));
      return btoa(text);
    }),
    'base64',
  );
  assert.deepEqual(difference(await decodePng(page, bytes), await pictureOf(page)), { max: 0, mean: 0, share: 0 });
  await page.leave();
});

test('large pictures of a mesh are decoded apart from it, be they beside its file or in it', async () => {
  const pictures = [];
  for (const name of ['square.gltf', 'square.glb']) {
    const page = await open(`<lucent-viewer src="made/${name}.json" alt="A square"></lucent-viewer>`);
    const reading = page.workers().filter((worker) => worker.url().includes('lucent-reading'));
    assert.equal(reading.length, 2); // each decodes one of the two
    pictures.push(await pictureOf(page));
    assert.deepEqual(page.problems, []);
    await page.leave();
  }
  const [beside, inside] = pictures;
  assert.equal(difference(beside, inside).max, 0);
  const { width, pixels } = beside;
  const sumOf = (onLeft, channel) =>
    pixels.reduce((sum, value, at) => {
      const isLeft = (at >> 2) % width < width / 2;
      return isLeft === onLeft && at % 4 === channel ? sum + value : sum;
    }, 0);
  for (const [onLeft, bright, dark] of [[true, 0, 1], [false, 1, 0]])
    for (const channel of [bright, 2]) assert.ok(sumOf(onLeft, channel) > 4 * sumOf(onLeft, dark), `${onLeft} ${channel}`);
  // Of such a mesh a relief takes the shape alone.
  const relief = await open('<lucent-viewer src="made/square-relief.json" alt="A square"></lucent-viewer>');
  assert.deepEqual(relief.problems, []);
  await relief.leave();
});

test('a mistyped attribute is named with the one that was meant, attributes of HTML are not', async () => {
  const attributes =
    'material-specularty="0.3" lihgt="0 0 1" zzz="1" class="a" id="b" lang="en" data-x="1" aria-busy="false" ' +
    'tabindex="0" view-exposure="0.5" truth-noise="0" alt';
  const page = await openPage(stage, 'blank.html', { markup: kDome.replace('src="made/dome.json" alt', attributes) });
  const warnings = [];
  page.on('console', (message) => message.type() === 'warning' && warnings.push(message.text()));
  await eventOf(page, 'load', () =>
    page.evaluate(() => (document.querySelector('lucent-viewer').src = 'made/dome.json')),
  );
  assert.deepEqual(
    warnings.filter((text) => text.includes('lucent-viewer')),
    [
      '<lucent-viewer>: attribute material-specularty does nothing here; did you mean material-specularity?',
      '<lucent-viewer>: attribute lihgt does nothing here; did you mean light?',
      '<lucent-viewer>: attribute zzz does nothing here; must be a parameter of the scene',
    ],
  );
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('a policy that forbids WebAssembly is named, with what it must contain', async () => {
  const page = await openPage(stage, 'blank.html');
  await page.route('**/strict.html', (route) =>
    route.fulfill({
      contentType: 'text/html',
      headers: { 'Content-Security-Policy': "default-src 'self'; style-src 'self'; img-src data:" },
      body: `<!doctype html><link rel="icon" href="data:,"><script type="module" src="lucent-viewer.js"></script>${kDome}`,
    }),
  );
  await page.goto(new URL('strict.html', stage.address).href);
  const message =
    "lucent-relief.wasm: the page's Content-Security-Policy forbids WebAssembly; its script-src must contain " +
    "'wasm-unsafe-eval'";
  await page.waitForFunction(
    (text) => document.querySelector('lucent-viewer').shadowRoot.querySelector('.status').textContent === text,
    message,
  );
  assert.equal(await page.textContent('lucent-viewer [role=status]'), message);
  await page.leave();
});
