/** A lost WebGL context comes back by itself, with every picture. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { complete, difference, openStage, openViewers, pictureOf, shownBy } from './support.mjs';

const kPair =
  '<lucent-viewer id="one" controls src="made/dome.json"></lucent-viewer>' +
  '<lucent-viewer id="two" src="made/sky.json"></lucent-viewer>';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

async function open() {
  const page = await openViewers(stage, kPair, { viewport: { width: 1000, height: 800 } });
  await page.evaluate(() => {
    for (const viewer of document.querySelectorAll('lucent-viewer'))
      Object.assign(viewer.style, { width: '700px', height: '300px' });
    window.events = [];
    for (const viewer of document.querySelectorAll('lucent-viewer'))
      for (const type of ['contextlost', 'contextrestored', 'error'])
        viewer.addEventListener(type, () => window.events.push(`${viewer.id} ${type}`));
    window.loser = () => (window.losing ??= window.seen.contexts[0].getExtension('WEBGL_lose_context'));
  });
  await complete(page, '#one');
  await complete(page, '#two');
  return page;
}

async function lose(page) {
  await page.evaluate(() => window.loser().loseContext());
  await page.waitForFunction(() => window.events.filter((event) => event.endsWith('contextlost')).length === 2);
}

async function restore(page) {
  await page.evaluate(() => {
    window.events.length = 0;
    window.loser().restoreContext();
  });
  await page.waitForFunction(() => window.events.length >= 2);
}

test('after a loss every viewer shows the same picture and panel as before', async () => {
  const page = await open();
  const before = [await shownBy(page, '#one'), await pictureOf(page, '#one'), await pictureOf(page, '#two')];
  await complete(page, '#one');
  await lose(page);
  assert.match(await page.textContent('#one .status'), /Waiting/);
  await restore(page);
  const told = await page.evaluate(() => [...window.events].sort()); // they may have begun in any order
  assert.deepEqual(told, ['one contextrestored', 'two contextrestored']);
  await complete(page, '#one');
  await complete(page, '#two');
  const after = [await shownBy(page, '#one'), await pictureOf(page, '#one'), await pictureOf(page, '#two')];
  for (const index of [0, 1, 2])
    assert.deepEqual(difference(before[index], after[index]), { max: 0, mean: 0, share: 0 });
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('what is set while the context is lost shows once it is back', async () => {
  const page = await open();
  const before = await pictureOf(page, '#one');
  await lose(page);
  await page.evaluate(() => document.querySelector('#one').set('lights.0.intensity', 0.5));
  await restore(page);
  await complete(page, '#one');
  assert.ok(difference(before, await pictureOf(page, '#one'), 8).share > 0.2);
  await page.leave();
});

test('a second loss is survived like the first', async () => {
  const page = await open();
  const before = await pictureOf(page, '#two');
  for (let round = 0; round < 2; ++round) {
    await lose(page);
    await restore(page);
  }
  await complete(page, '#two');
  assert.deepEqual(difference(before, await pictureOf(page, '#two')), { max: 0, mean: 0, share: 0 });
  await page.leave();
});
