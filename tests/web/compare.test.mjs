/** The picture beside its exact truth: computed live in a worker, from a file, and what is said about both. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { boxOf, brightness, complete, eventOf, openPage, openStage, openViewers, quiet, shownBy } from './support.mjs';

const kDome = '<lucent-viewer src="made/dome.json" alt="A dome"></lucent-viewer>';
const kDepth = 'objects.relief.material.depth';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

const comparison = (page) => page.evaluate(() => document.querySelector('lucent-viewer').comparison());
const set = (page, path, value) =>
  page.evaluate(([name, to]) => document.querySelector('lucent-viewer').set(name, to), [path, value]);

async function open(markup = kDome, options) {
  const page = await openViewers(stage, markup, options);
  await page.evaluate(() => {
    for (const one of document.querySelectorAll('lucent-viewer'))
      Object.assign(one.style, { width: '400px', height: '300px' });
  });
  await complete(page);
  return page;
}

/** Waits until the numbers of a comparison are there. */
async function numbers(page) {
  await page.waitForFunction(() => 'rmse' in document.querySelector('lucent-viewer').comparison(), null, {
    polling: 50,
  });
  return comparison(page);
}

const compute = (page) => page.click('lucent-viewer .truth button:text-matches("Compute")');

test('a truth computed in a worker is what the picture is, under the strict policy', async () => {
  const page = await open();
  await set(page, 'compare', 'error');
  assert.equal((await comparison(page)).truth, 'none');
  const [worker] = await Promise.all([page.waitForEvent('worker'), compute(page)]);
  assert.match(worker.url(), /lucent-truth\.js$/);
  const found = await numbers(page);
  assert.deepEqual(found.size, [256, 256]);
  assert.equal(found.noise, 0); // one lamp of no size: nothing is sampled
  assert.ok(found.relRmse <= 1e-5, `relative RMSE ${found.relRmse}`);
  assert.ok(found.rmse > 0 && found.max >= found.rmse, `RMSE ${found.rmse}, max ${found.max}`); // floats round
  assert.ok(found.milliseconds > 0 && found.passes > 0);
  assert.equal(await page.textContent('lucent-viewer .truth button:visible'), 'Compute a finer truth, 300 pixels');
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
});

test('after a change the truth is stale, nothing is compared, and it can be computed again', async () => {
  const page = await open();
  await set(page, 'compare', 'truth');
  await compute(page);
  await numbers(page);
  await set(page, kDepth, 0.2);
  await complete(page);
  const stale = await comparison(page);
  assert.equal(stale.truth, 'stale');
  assert.equal('rmse' in stale, false);
  assert.equal(await page.textContent('lucent-viewer .truth button:visible'), 'Compute the truth again');
  await compute(page);
  assert.ok((await numbers(page)).relRmse <= 1e-5);
  await page.evaluate(() => document.querySelector('lucent-viewer').undo());
  assert.equal((await comparison(page)).truth, 'stale');
  await page.leave();
});

/** The largest difference of what is shown in a part of the canvas, given in CSS pixels. */
function largest(a, b, [left, top, right, bottom]) {
  let most = 0;
  for (let y = top; y < bottom; ++y)
    for (let at = 4 * (y * a.width + left); at < 4 * (y * a.width + right); ++at)
      most = Math.max(most, Math.abs(a.pixels[at] - b.pixels[at]));
  return most;
}

test('the picture keeps its pixels beside a coarser truth', async () => {
  const page = await open();
  const before = await shownBy(page);
  await page.evaluate(() => (document.querySelector('lucent-viewer').truth = 'made/black.pfm'));
  await set(page, 'compare', 'truth');
  const { size, place } = await numbers(page);
  await quiet(page);
  assert.deepEqual(size, [48, 48]);
  assert.deepEqual(place, [50, 0, 300, 300]);
  const after = await shownBy(page);
  assert.equal(largest(before, after, [60, 90, 170, 210]), 0); // left of the divider's handle, above the numbers
  assert.ok(largest(before, after, [230, 90, 340, 210]) > 20); // the dome's unlit side against black
  await page.leave();
});

test('a finer truth is computed on request, up to the pixels of the picture', async () => {
  const page = await open();
  await set(page, 'compare', 'truth');
  await compute(page);
  assert.deepEqual((await numbers(page)).size, [256, 256]);
  const finer = page.locator('lucent-viewer .truth button:text("Compute a finer truth, 300 pixels")');
  await finer.click();
  await page.waitForFunction(() => document.querySelector('lucent-viewer').comparison().size[0] === 300);
  assert.ok((await numbers(page)).relRmse <= 1e-5);
  await quiet(page);
  assert.equal(await page.locator('lucent-viewer .truth').isVisible(), false); // finer is not seen
  await page.leave();
});

test('two methods stand side by side with their errors after four actions', async () => {
  const page = await openPage(stage, 'index.html', { viewport: { width: 1000, height: 900 } });
  await complete(page);
  await page.selectOption('#compare', 'methods'); // 1
  const path = 'beside.technique.relief.method';
  const option = async (index) => {
    const [x, y, width] = await page.evaluate((one) => document.querySelector('lucent-viewer').stats().panel[one], path);
    const box = await boxOf(page);
    return page.mouse.click(box.x + x + (index + 0.5) * 0.28 * width, box.y + y + 14);
  };
  await quiet(page);
  await option(1); // 2: the second of its choices, on the panel
  assert.equal(await page.evaluate((one) => document.querySelector('lucent-viewer').get(one), path), 'march');
  await compute(page); // 3
  await page.waitForFunction(() => 'rmse' in (document.querySelector('lucent-viewer').comparison().right ?? {}));
  const found = await comparison(page);
  assert.equal(found.left, 'Method hierarchy');
  assert.equal(found.right.name, 'Method march');
  assert.ok(found.rmse < 1e-4 && found.flip < 1e-3, `RMSE ${found.rmse}, FLIP ${found.flip} of what is exact`);
  assert.ok(found.right.rmse > 10 * found.rmse && found.right.flip > found.flip, JSON.stringify(found.right));
  await page.focus('lucent-viewer #divider'); // 4: what stands where
  await page.keyboard.press('Home');
  assert.equal((await comparison(page)).divider, 0);
  assert.match(await page.evaluate(() => location.hash), /compare=methods/);
  const other = await openPage(stage, 'index.html' + (await page.evaluate(() => location.hash)));
  await complete(other);
  await other.waitForFunction(() => document.querySelector('lucent-viewer').comparison().right);
  assert.equal((await comparison(other)).right.name, 'Method march');
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
  await other.leave();
});

test('two materials stand side by side, and a link carries both', async () => {
  const page = await openPage(stage, 'index.html#scene=made/dome.json', { viewport: { width: 1000, height: 900 } });
  await complete(page);
  await page.selectOption('#compare', 'materials');
  assert.equal((await comparison(page)).right.name, 'the same materials');
  await set(page, 'beside.objects.relief.material.diffuse', '#203060');
  await quiet(page);
  const found = await comparison(page);
  assert.match(found.right.name, /^Diffuse/);
  assert.notEqual(found.left, found.right.name);
  await page.waitForFunction(() => /compare=materials/.test(location.hash) && /beside/.test(location.hash)); // it lags
  const hash = await page.evaluate(() => location.hash);
  const other = await openPage(stage, 'index.html' + hash);
  await complete(other);
  assert.equal((await comparison(other)).right.name, found.right.name);
  const figure = await open(kDome.replace('alt', 'compare="materials" beside-material-diffuse="#203060" alt'));
  assert.equal((await comparison(figure)).right.name, found.right.name);
  await figure.leave();
  assert.deepEqual(page.problems, []);
  await page.leave();
  await other.leave();
});

test('the work shows its progress and ends when it is cancelled', async () => {
  const page = await open(kDome.replace('dome.json', 'sky.json'));
  await set(page, 'compare', 'truth');
  await compute(page);
  await page.waitForFunction(() =>
    /\d+ s left/.test(document.querySelector('lucent-viewer').shadowRoot.querySelector('.truth').textContent),
  );
  assert.ok((await page.locator('lucent-viewer .truth progress').evaluate((one) => one.value)) > 0);
  assert.equal(page.workers().length, 1);
  const ended = new Promise((done) => page.workers()[0].on('close', done));
  await page.click('lucent-viewer .truth button:text("Cancel")');
  await ended;
  assert.equal(await page.locator('lucent-viewer .truth progress').isVisible(), false);
  assert.equal((await comparison(page)).truth, 'none');
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('glass is compared with rays through every interface, but for its outline', async () => {
  const page = await open(kDome.replace('dome.json', 'bead.json'));
  await set(page, 'compare', 'error');
  await compute(page);
  const found = await numbers(page);
  assert.deepEqual(found.size, [128, 128]);
  assert.equal(found.noise, 0); // one ray a pixel, and a board that shines by itself
  // Colours of the environment are half floats on the GPU; along the outline one step of the rays is a leap.
  assert.ok(found.p99 < 4.9e-4, `99 % of the pixels are within ${found.p99}`);
  console.log(`# ${process.env.LUCENT_DRIVER}: bead: 99 % of the pixels are within ${found.p99.toExponential(2)}`);
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
});

test('what lies beside glass is sampled, with its standard error', async () => {
  const page = await openViewers(stage, '');
  const { pixels, noise } = await page.evaluate(async () => {
    const scene = await (await fetch('made/bead.json')).json();
    const [board, bead] = scene.objects;
    board.material.diffuse = [0.4, 0.4, 0.4];
    Object.assign(bead, { shape: { type: 'sphere', radius: 0.01 }, transform: { translate: [-2, 0, 0] } });
    scene.environment = { source: 'uniform' };
    scene.camera = { type: 'orthographic', eye: [1, 0, 3], target: [1, 0, 0], height: 0.4 };
    const files = new Map([['scene.json', new TextEncoder().encode(JSON.stringify(scene))]]);
    const { work: computeTruth } = await import('./lucent-truth.js');
    return computeTruth({ files, width: 8, height: 8, samples: 64 }, () => true);
  });
  const red = Object.values(pixels).filter((_, index) => index % 4 === 0);
  const mean = red.reduce((sum, value) => sum + value) / 64;
  const spread = Math.sqrt(red.reduce((sum, value) => sum + (value - mean) ** 2, 0) / 63);
  // A sky of 1 all around lights the board with pi: 0.5 + 0.4. The spread of 64 values is known to 1 / sqrt(126).
  assert.ok(Math.abs(mean - 0.9) < (4 * noise) / 8, `mean ${mean}, standard error ${noise}`);
  assert.ok(noise > 0 && Math.abs(spread / noise - 1) < 4 / Math.sqrt(126), `spread ${spread}, standard error ${noise}`);
  await page.leave();
});

test('what only the program solves is said by name', async () => {
  const page = await open(kDome.replace('dome.json', 'pond.json'));
  await set(page, 'compare', 'error');
  const caustics = await eventOf(page, 'error', () => compute(page));
  assert.deepEqual(caustics, {
    code: 'scene',
    message:
      'truth: object "water" casts a caustic on "floor", which the page does not solve; must be solved by the ' +
      'program (lucent truth)',
  });
  await set(page, 'view.show', 'irradiance');
  assert.match((await eventOf(page, 'error', () => compute(page))).message, /^truth: shown is the AOV irradiance, which/);
  await set(page, 'view.show', 'direction'); // which no lamp changes
  await compute(page);
  assert.ok((await numbers(page)).p99 < 1e-4);
  await page.evaluate(() => (document.querySelector('lucent-viewer').src = 'made/marble.json'));
  await complete(page);
  await set(page, 'compare', 'error');
  const inside = await eventOf(page, 'error', () => compute(page));
  assert.match(inside.message, /^truth: object "ball" has subsurface scattering, which the page does not solve;/);
  await page.leave();
});

test('without workers the page computes the same truth itself and says so', async () => {
  const page = await open(kDome, { init: () => delete window.Worker });
  await set(page, 'compare', 'error');
  await compute(page);
  await page.waitForSelector('lucent-viewer .truth :text("no worker")');
  assert.ok((await numbers(page)).relRmse <= 1e-5);
  await page.leave();
});

test('the divider moves by keyboard and by drag', async () => {
  const page = await open(
    kDome.replace('alt', 'compare="truth" divider="0.25" truth="made/black.pfm" truth-noise="0.5" alt'),
  );
  const found = await numbers(page);
  assert.equal(found.divider, 0.25);
  assert.equal(found.noise, 0.5);
  assert.deepEqual(found.size, [48, 48]);
  const [left, , width] = found.place;
  await page.focus('lucent-viewer #divider');
  for (let i = 0; i < 5; ++i) await page.keyboard.press('ArrowRight');
  assert.ok(Math.abs((await comparison(page)).divider - 0.3) < 1e-6);
  const box = await boxOf(page);
  const at = (share) => [box.x + left + share * width, box.y + 200];
  await page.mouse.move(...at(0.3));
  await page.mouse.down();
  await page.mouse.move(...at(0.6));
  await page.mouse.up();
  await quiet(page);
  assert.ok(Math.abs((await comparison(page)).divider - 0.6) < 0.01);
  const shown = await shownBy(page);
  const share = (place) => (left + place * width) / shown.width;
  assert.ok(brightness(shown, [share(0.4), 0.4, share(0.58), 0.6]) > 30, 'the picture lies left of it');
  assert.ok(brightness(shown, [share(0.66), 0.4, share(0.9), 0.6]) < 1, 'the black truth right of it');
  await page.leave();
});

test('the file of a truth is fetched when compare is on, and belongs to the untouched scene', async () => {
  const page = await open(kDome.replace('alt', 'truth="made/black.pfm" alt'));
  const fetched = [];
  page.on('request', (request) => fetched.push(request.url().split('/').pop()));
  await set(page, kDepth, 0.2);
  await set(page, 'compare', 'error');
  await page.waitForFunction(() => document.querySelector('lucent-viewer').comparison().truth === 'stale');
  assert.deepEqual(fetched, ['black.pfm']);
  await page.evaluate(() => document.querySelector('lucent-viewer').reset());
  await set(page, 'compare', 'error');
  assert.ok((await numbers(page)).rmse > 0.1);
  assert.equal('noise' in (await comparison(page)), false);
  assert.deepEqual(fetched, ['black.pfm']);
  await page.leave();
});

test('a truth that is not there says so', async () => {
  const page = await open(kDome.replace('alt', 'truth="made/nowhere.pfm" alt'));
  const error = await eventOf(page, 'error', () => set(page, 'compare', 'error'));
  assert.deepEqual(error, { code: 'fetch', message: 'nowhere.pfm: the server answers 404; must be there' });
  assert.equal((await comparison(page)).truth, 'none');
  await page.leave();
});

test('compare is an attribute, a property, a control and part of the link', async () => {
  const page = await openPage(stage);
  await complete(page);
  await page.evaluate(() => (document.querySelector('lucent-viewer').compare = 'error'));
  assert.equal(await page.locator('lucent-viewer select[aria-label=Compare]').inputValue(), 'error');
  await page.waitForFunction(() => location.hash.includes('compare=error'));
  const other = await openPage(stage, 'index.html' + (await page.evaluate(() => location.hash)));
  await complete(other);
  assert.equal(await other.evaluate(() => document.querySelector('lucent-viewer').compare), 'error');
  await page.leave();
  await other.leave();
});

test('the page computes the truth that the program computed', async () => {
  const page = await openViewers(stage, '', { gallery: 'own' });
  const names = ['elevation.json', 'elevation.png', 'elevation-color.png'];
  const largest = await page.evaluate(async (files) => {
    const bytes = async (name) => new Uint8Array(await (await fetch('gallery/' + name)).arrayBuffer());
    const request = { files: new Map(), samples: 1 };
    for (const name of files) request.files.set(name.replace('elevation.json', 'scene.json'), await bytes(name));
    const file = await bytes('elevation-truth.pfm');
    const header = new TextDecoder().decode(file.subarray(0, 40)).split('\n', 3);
    [request.width, request.height] = header[1].split(' ').map(Number);
    const native = new Float32Array(file.slice(header.join('\n').length + 1).buffer);
    const { work: computeTruth } = await import('./lucent-truth.js');
    const { pixels } = await computeTruth(request, () => true);
    let most = 0;
    for (let y = 0; y < request.height; ++y)
      for (let x = 0; x < request.width; ++x)
        for (let channel = 0; channel < 3; ++channel) {
          const row = request.height - 1 - y; // PFM starts at the bottom
          const difference = native[3 * (row * request.width + x) + channel] - pixels[4 * (y * request.width + x) + channel];
          most = Math.max(most, Math.abs(difference));
        }
    return most;
  }, names);
  // Both count in doubles and store floats below 2: one rounding to the other side.
  assert.ok(largest <= 2 ** -23, `largest difference ${largest}`);
  console.log(`# ${process.env.LUCENT_DRIVER}: largest difference from the program's truth ${largest}`);
  await page.leave();
});

test("truths of the gallery's reliefs agree with its pictures at the middles of pixels", async () => {
  const page = await openViewers(stage, '<lucent-viewer></lucent-viewer>', { gallery: 'own' });
  const scenes = await page.evaluate(async () => {
    Object.assign(document.querySelector('lucent-viewer').style, { width: '192px', height: '192px' });
    return await (await fetch('gallery/index.json')).json();
  });
  for (const { scene, truth, kind } of scenes) {
    // Light from all around takes software drivers minutes, other truths are light traced with noise, and those of
    // several reliefs do not look through their holes.
    if (kind !== 'Relief' || truth?.directions !== 1) continue;
    await eventOf(page, 'load', () =>
      page.evaluate((name) => (document.querySelector('lucent-viewer').src = 'gallery/' + name), scene),
    );
    await set(page, 'technique.sampling.pixelSamples', 1); // means over other places differ at edges
    await complete(page);
    await set(page, 'compare', 'error');
    await compute(page);
    const found = await numbers(page);
    // Colour maps are half floats on the GPU, 2^-11 relative at most for each value.
    assert.ok(found.relRmse < 4.9e-4, `${scene}: relative RMSE ${found.relRmse}`);
    console.log(`# ${process.env.LUCENT_DRIVER}: ${scene}: relative RMSE ${found.relRmse.toExponential(2)}`);
  }
  assert.deepEqual(page.problems, []);
  await page.leave();
});
