/** Scenes in which something moves: what starts them, what stops them, and that nothing runs unseen. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { complete, drawsOf, openStage, openViewers, quiet, valueOf } from './support.mjs';

const kBanner = '<lucent-viewer src="made/banner.json" controls="html" alt="A banner"></lucent-viewer>';
const kAutoplay = kBanner.replace('controls', 'autoplay controls');

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

// A viewer of 240 x 320 CSS pixels; pictures are small, since many are drawn.
async function open(markup = kBanner, options) {
  const page = await openViewers(stage, markup, options);
  await page.evaluate(() =>
    Object.assign(document.querySelector('lucent-viewer').style, { width: '240px', height: '320px' }),
  );
  await page.waitForFunction(() => document.querySelector('lucent-viewer').stats?.().complete);
  return page;
}

const timeOf = (page) => valueOf(page, 'view.time');
const paused = (page) => page.evaluate(() => document.querySelector('lucent-viewer').paused);
test('without autoplay it stands still until its button is pressed, and again after', async () => {
  const page = await open();
  await quiet(page);
  assert.equal(await timeOf(page), 0);
  const button = page.getByRole('button', { name: 'Play', exact: true });
  await button.click();
  await page.waitForFunction(() => document.querySelector('lucent-viewer').get('view.time') > 0.1);
  await page.getByRole('button', { name: 'Pause', exact: true }).click();
  await complete(page);
  const time = await timeOf(page);
  const draws = await drawsOf(page);
  await page.waitForTimeout(300);
  assert.equal(await timeOf(page), time);
  assert.equal(await drawsOf(page), draws);
  await page.leave();
});

test('space plays and pauses while the picture has the focus', async () => {
  const page = await open();
  await page.locator('lucent-viewer canvas').focus();
  await page.keyboard.press('Space');
  await page.waitForFunction(() => document.querySelector('lucent-viewer').get('view.time') > 0);
  assert.equal(await page.evaluate(() => scrollY), 0);
  await page.keyboard.press('Space');
  assert.equal(await paused(page), true);
  await page.leave();
});

test('autoplay starts it and fires change with the time', async () => {
  const page = await open(kAutoplay);
  const path = await page.evaluate(
    () =>
      new Promise((done) =>
        document.querySelector('lucent-viewer').addEventListener('change', ({ detail }) => done(detail.path)),
      ),
  );
  assert.equal(path, 'view.time');
  assert.equal(await paused(page), false);
  await page.leave();
});

test('who prefers reduced motion must ask for it', async () => {
  const page = await open(kAutoplay, { reducedMotion: 'reduce' });
  await quiet(page);
  assert.equal(await timeOf(page), 0);
  await page.evaluate(() => document.querySelector('lucent-viewer').play());
  await page.waitForFunction(() => document.querySelector('lucent-viewer').get('view.time') > 0);
  await page.leave();
});

test('nothing plays off the screen, and it goes on where it was', async () => {
  const page = await open(kAutoplay + '<div id="space"></div>');
  await page.evaluate(() => (document.querySelector('#space').style.height = '2000px'));
  await page.evaluate(() => scrollTo(0, 400)); // out of sight, but near
  await quiet(page, 1000); // a picture that was begun may take a slow machine longer than a frame's usual rest
  const draws = await drawsOf(page);
  const time = await timeOf(page);
  const left = await page.evaluate(() => performance.now());
  await page.waitForTimeout(3000);
  assert.equal(await drawsOf(page), draws);
  const back = await page.evaluate(() => (scrollTo(0, 0), performance.now()));
  const first = await page.waitForFunction(
    ([before, begin]) => {
      const played = document.querySelector('lucent-viewer').get('view.time') - before;
      return played > 0 && { played, passed: (performance.now() - begin) / 1000 };
    },
    [time, back],
  );
  const { played, passed } = await first.jsonValue();
  assert.ok(played < passed + (back - left) / 2000, `${played} s played in ${passed} s on the screen`);
  await page.leave();
});

test('a picture can be taken while it plays, which goes on', async () => {
  const page = await open(kAutoplay);
  const size = await page.evaluate(async () => (await document.querySelector('lucent-viewer').toBlob()).size);
  assert.ok(size > 100);
  assert.equal(await paused(page), false);
  await page.leave();
});

test('a wave that is dragged flat keeps its controls, and the time is reset as others are', async () => {
  const page = await open();
  const row = (path) => page.locator(`lucent-viewer [data-path="${path}"]`);
  await page.evaluate(() => document.querySelector('lucent-viewer').set('objects.banner.wave.amplitude', [0, 0, 0]));
  assert.equal(await row('objects.banner.wave.period').count(), 1);
  await page.evaluate(() => document.querySelector('lucent-viewer').set('view.time', 2));
  await row('view.time').getByRole('button').click();
  assert.equal(await timeOf(page), 0);
  await page.leave();
});

test('a still scene has no button and nothing to play', async () => {
  const page = await open(kAutoplay.replace('banner', 'dome'));
  assert.equal(await page.locator('lucent-viewer .play').isVisible(), false);
  assert.equal(await page.evaluate(() => document.querySelector('lucent-viewer').play()), false);
  await page.leave();
});
