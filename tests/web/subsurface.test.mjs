/** Mode subsurface: words for subsurface scattering as controls, their numbers for screen readers, the matt comparison. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { brightness, complete, difference, openStage, openViewers, pictureOf, valueOf } from './support.mjs';

const kMaterial = 'objects.ball.material.';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

async function open(controls = 'html') {
  const page = await openViewers(
    stage,
    `<lucent-viewer src="made/marble.json" controls="${controls}" alt="A marble"></lucent-viewer>`,
  );
  await page.evaluate(() =>
    Object.assign(document.querySelector('lucent-viewer').style, { width: '200px', height: '200px', maxHeight: 'none' }),
  );
  await complete(page);
  return page;
}

const input = (page, path, selector = 'input') => page.locator(`lucent-viewer [data-path="${path}"] ${selector}`);
const profile = (page) => page.textContent('lucent-viewer .profile');
const call = (page, name) => page.evaluate((one) => document.querySelector('lucent-viewer')[one](), name);

test('a measured material is chosen by its name, changes the picture, and is undone to the bit', async () => {
  const page = await open();
  assert.equal(await valueOf(page, 'mode'), 'subsurface');
  const select = input(page, kMaterial + 'preset', 'select');
  assert.equal(await select.inputValue(), 'marble');
  const plain = await pictureOf(page);
  await select.selectOption('ketchup');
  await complete(page);
  assert.ok(difference(plain, await pictureOf(page)).share > 0.1);
  assert.equal(await valueOf(page, kMaterial + 'ior'), 1.3);
  assert.ok(await call(page, 'undo'));
  await complete(page);
  assert.equal(await select.inputValue(), 'marble');
  assert.equal(difference(plain, await pictureOf(page)).max, 0);
  assert.equal(await call(page, 'undo'), false);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('blur and glow move the coefficients, and these move them', async () => {
  const page = await open();
  const shown = (id, selector) => input(page, kMaterial + id, selector).inputValue().then(Number);
  const glow = await shown('glow', 'input[type=number]');
  const red = () => shown('scatteringPerMm', 'input >> nth=0');
  const scattering = await red();
  await input(page, kMaterial + 'blur', 'input[type=number]').fill('3.8346'); // ten times marble's 3 / 7.8233
  await page.keyboard.press('Enter');
  assert.ok(Math.abs((await red()) / scattering - 0.1) < 1e-4);
  assert.ok(Math.abs((await shown('glow', 'input[type=number]')) - glow) < 1e-5);
  await input(page, kMaterial + 'absorptionPerMm', 'input >> nth=2').fill('0.5');
  await page.keyboard.press('Enter');
  assert.ok((await shown('glow', 'input[type=number]')) < glow);
  assert.equal(await input(page, kMaterial + 'scatteringPerMm', 'input >> nth=2').getAttribute('aria-label'), 'Scattering blue');
  await input(page, kMaterial + 'preset', 'select').selectOption('marble');
  assert.equal(await red(), scattering);
  await page.leave();
});

test('a screen reader hears how far light goes, as the curves show it', async () => {
  const page = await open('');
  assert.match(await profile(page), /^Subsurface scattering of ball, dipole: red reaches [\d.]+ mm, 83\.0 % leaves again; /);
  const [{ whole, distances, values }] = await call(page, 'profiles');
  assert.ok(Math.abs(whole[2] - 0.753) < 1e-3);
  assert.ok(distances.length === values.length && values[0][0] > values.at(-1)[0]);
  await page.evaluate((path) => document.querySelector('lucent-viewer').set(path, 'skin1'), kMaterial + 'preset');
  assert.doesNotMatch(await profile(page), / 83\.0 %/);
  await page.leave();
});

// Brightness of the ball a little behind where light from the left grazes it: an eighth to two fifths of its radius
// right of its middle, in a picture twice as wide as high. What is seen there went in elsewhere.
const behind = (picture) => brightness(picture, [0.52, 0.45, 0.57, 0.55]);

test('as matt, by space on its twin or M on the picture, the shadow side is dark, and back to the bit', async () => {
  const page = await open();
  const scattered = await pictureOf(page);
  assert.ok(behind(scattered) > 20, `${behind(scattered)}`);
  const twin = input(page, 'matt');
  const canvas = page.locator('lucent-viewer canvas');
  for (const [control, key] of [
    [twin, ' '],
    [canvas, 'm'],
  ]) {
    await control.focus();
    await page.keyboard.press(key);
    await complete(page);
    assert.equal(await twin.isChecked(), true, key);
    const matt = await pictureOf(page);
    assert.ok(behind(matt) < 0.5 * behind(scattered), `${key}: ${behind(matt)} of ${behind(scattered)}`);
    await page.keyboard.press(key);
    await complete(page);
    assert.equal(await twin.isChecked(), false, key);
    assert.equal(difference(scattered, await pictureOf(page)).max, 0, key);
  }
  assert.deepEqual(await page.evaluate(() => document.querySelector('lucent-viewer').changes), {});
  await page.leave();
});
