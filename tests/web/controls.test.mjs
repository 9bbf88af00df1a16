/** The panel's twin in HTML: the same controls for keyboards and screen readers. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import {
  brightness,
  complete,
  difference,
  eventOf,
  openPage,
  openStage,
  openViewers,
  pictureOf,
  shownBy,
  valueOf,
} from './support.mjs';

const kShine = 'objects.relief.material.specularity';
const kLevel = 'lights.0.intensity';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

async function open(controls = '', options) {
  const page = await openViewers(
    stage,
    `<lucent-viewer src="made/dome.json" controls="${controls}" alt="A dome"></lucent-viewer>`,
    options,
  );
  await page.evaluate(() =>
    Object.assign(document.querySelector('lucent-viewer').style, { width: '900px', height: '400px' }),
  );
  await complete(page);
  return page;
}

const input = (page, path, selector = 'input') => page.locator(`lucent-viewer [data-path="${path}"] ${selector}`);

test('every control of the panel has a labelled twin with a reset, in the order of the panel', async () => {
  const page = await open();
  const twins = await page.evaluate(() =>
    [...document.querySelector('lucent-viewer').shadowRoot.querySelectorAll('.row')].map((row) => ({
      path: row.dataset.path,
      labels: [...row.querySelectorAll('input, select')].map((one) => one.ariaLabel),
      reset: row.querySelector('button').ariaLabel,
      group: row.closest('fieldset').querySelector('legend').textContent,
    })),
  );
  const groups = [...new Set(twins.map(({ group }) => group))];
  const order = ['Light', 'Material', 'Falloff', 'Refraction', 'Environment', 'Height field', 'View'];
  assert.deepEqual(
    groups,
    order.filter((name) => groups.includes(name)),
  );
  for (const { path, labels, reset } of twins) {
    assert.ok(labels.length > 0 && labels.every(Boolean), `${path}: labels ${labels}`);
    assert.match(reset, /^Reset ./);
  }
  const drawn = await page.evaluate(() => Object.keys(document.querySelector('lucent-viewer').stats().panel));
  const paths = twins.map(({ path }) => path);
  assert.ok(drawn.length > 0 && drawn.every((path) => paths.includes(path)), `drawn ${drawn}`);
  await page.leave();
});

test('what is not drawn is listed beside the controls, and only where there is something', async () => {
  const page = await open();
  const notice = page.locator('lucent-viewer .undrawn');
  assert.equal(await notice.isVisible(), false);
  await eventOf(page, 'load', () =>
    page.evaluate(() => (document.querySelector('lucent-viewer').src = 'made/bead.json')),
  );
  const { notDrawn } = await page.evaluate(() => document.querySelector('lucent-viewer').stats());
  assert.ok(notDrawn.length > 0);
  assert.equal(await notice.locator('summary').textContent(), `Not drawn (${notDrawn.length})`);
  assert.equal(await notice.locator('li').first().isVisible(), false);
  await notice.locator('summary').press('Enter');
  assert.ok(await notice.locator('li').first().isVisible());
  assert.deepEqual(await notice.locator('li').allTextContents(), notDrawn);
  await page.evaluate(() => document.querySelector('lucent-viewer').removeAttribute('controls'));
  assert.equal(await notice.isVisible(), false);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('the twin of a drawn panel is not seen but takes the keyboard and changes the picture', async () => {
  const page = await open();
  const before = await pictureOf(page);
  const slider = input(page, kShine, 'input[type=range]');
  const { width } = await page.locator('lucent-viewer .twin').boundingBox();
  assert.equal(width, 1);
  await slider.focus();
  for (let press = 0; press < 20; ++press) await page.keyboard.press('ArrowRight');
  assert.equal(await valueOf(page, kShine), 0.1); // 20 steps of 200
  assert.equal(await slider.getAttribute('aria-valuetext'), '0.1');
  assert.equal(await input(page, kShine, 'input[type=number]').inputValue(), '0.1');
  await complete(page);
  assert.ok(difference(before, await pictureOf(page)).share > 0.05);
  await page.leave();
});

test('a twin with the keyboard focus marks its control in the panel, and the panel shows its value', async () => {
  const page = await open();
  const plain = await shownBy(page);
  await input(page, kShine, 'input[type=range]').focus();
  await complete(page);
  const marked = await shownBy(page);
  assert.ok(difference(plain, marked, 8).max > 8, 'the panel looks the same');
  await page.keyboard.press('End');
  await complete(page);
  const [x, y, w, h] = await page.evaluate(
    (path) => document.querySelector('lucent-viewer').stats().panel[path],
    kShine,
  );
  const row = [x / 900, y / 400, (x + w) / 900, (y + h) / 400];
  const change = Math.abs(brightness(marked, row) - brightness(await shownBy(page), row));
  assert.ok(change > 2, `the slider in the panel changed by ${change}`);
  await page.leave();
});

test('a value set by another road shows in the twin', async () => {
  const page = await open();
  await page.evaluate((path) => document.querySelector('lucent-viewer').set(path, 2.5), kLevel);
  assert.equal(await input(page, kLevel, 'input[type=number]').inputValue(), '2.5');
  await input(page, kLevel, 'button').dispatchEvent('click');
  assert.equal(await valueOf(page, kLevel), 1);
  await page.leave();
});

test('colours convert between sRGB and linear light', async () => {
  const page = await open('html');
  const color = input(page, 'lights.0.color');
  assert.equal(await color.inputValue(), '#ffffff');
  await color.fill('#bc0000'); // 188: ((188 / 255 + 0.055) / 1.055) ^ 2.4 = 0.5029
  const [red, green, blue] = await valueOf(page, 'lights.0.color');
  assert.ok(Math.abs(red - 0.5029) < 1e-4 && green === 0 && blue === 0, `${red} ${green} ${blue}`);
  await page.leave();
});

test('vectors are set number by number, ranges end by end', async () => {
  const page = await open('html');
  await input(page, 'lights.0.position', 'input >> nth=1').fill('0.25');
  await page.keyboard.press('Enter');
  assert.deepEqual(await valueOf(page, 'lights.0.position'), [-0.8, 0.25, 0.6]);
  await input(page, 'objects.relief.material.scatterFalloff', 'input[type=number] >> nth=1').fill('0.5');
  await page.keyboard.press('Enter');
  assert.deepEqual(await valueOf(page, 'objects.relief.material.scatterFalloff'), [0, 0.5]);
  await page.leave();
});

test('a value out of range is refused with a message and the old one comes back', async () => {
  const page = await open('html');
  await page.evaluate(() =>
    document.querySelector('lucent-viewer').addEventListener('error', ({ detail }) => (window.refused = detail)),
  );
  await input(page, kShine, 'input[type=number]').fill('7');
  await page.keyboard.press('Enter');
  assert.deepEqual(await page.evaluate(() => window.refused), {
    code: 'value',
    message: `${kShine} is 7; must be in [0, 1]`,
  });
  assert.equal(await input(page, kShine, 'input[type=number]').inputValue(), '0');
  assert.equal(await page.textContent('lucent-viewer [role=status]'), `${kShine} is 7; must be in [0, 1]`);
  await page.leave();
});

test('controls="html" shows the twin and no panel', async () => {
  const page = await open('html');
  assert.ok((await page.locator('lucent-viewer .twin').boundingBox()).width > 500);
  assert.deepEqual(await page.evaluate(() => document.querySelector('lucent-viewer').stats().panel), {});
  await page.leave();
});

test('tab goes from the picture group by group to the rest of the page, arrow keys within a group', async () => {
  const page = await open();
  await page.evaluate(() => document.body.insertAdjacentHTML('beforeend', '<button id="next">next</button>'));
  await page.locator('lucent-viewer canvas').focus();
  const focused = () =>
    page.evaluate(() => document.activeElement.shadowRoot?.activeElement?.ariaLabel ?? document.activeElement.id);
  await page.keyboard.press('Tab');
  assert.equal(await focused(), 'Light position x');
  await page.keyboard.press('ArrowDown');
  assert.equal(await focused(), 'Light position y');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('ArrowUp'); // there is nothing above
  assert.equal(await focused(), 'Light position x');
  const walk = await page.evaluate(
    () => document.querySelector('lucent-viewer').shadowRoot.querySelectorAll('fieldset')[0].querySelectorAll('input, select, button').length,
  );
  const met = new Set([await focused()]);
  for (let step = 1; step < walk; ++step) met.add((await page.keyboard.press('ArrowDown'), await focused()));
  assert.equal(met.size, new Set(met).size);
  const last = await focused();
  await page.keyboard.press('Tab');
  await page.keyboard.press('Shift+Tab');
  assert.equal(await focused(), last); // it comes back to where it was
  const groups = await page.locator('lucent-viewer fieldset').count();
  for (let press = 0; press < groups; ++press) await page.keyboard.press('Tab');
  assert.equal(await focused(), 'next');
  await page.leave();
});

test('at most 20 stops of the tab key lie between the picture and the toolbar', async () => {
  const page = await openPage(stage);
  for (const scene of ['dome', 'pond']) {
    await eventOf(page, 'load', () =>
      page.evaluate((name) => (document.querySelector('lucent-viewer').src = `made/${name}.json`), scene),
    );
    await page.evaluate(() => document.querySelector('lucent-viewer').set('compare', 'methods'));
    await page.locator('lucent-viewer canvas').focus();
    let stops = -1;
    do {
      await page.keyboard.press('Tab');
      ++stops;
    } while (stops < 40 && (await page.evaluate(() => document.activeElement.id)) !== 'undo');
    assert.ok(stops > 3 && stops <= 20, `${scene}: ${stops} stops`);
    console.log(`# ${process.env.LUCENT_DRIVER}: ${scene}: ${stops} stops of the tab key between picture and toolbar`);
  }
  await page.leave();
});

test('the picture has a name and tells its keys', async () => {
  const page = await open();
  const canvas = page.locator('lucent-viewer canvas');
  assert.equal(await canvas.getAttribute('role'), 'img');
  assert.equal(await canvas.getAttribute('aria-label'), 'A dome');
  assert.match(await page.textContent('lucent-viewer #keys'), /Arrow keys/);
  await page.leave();
});
