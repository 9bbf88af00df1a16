/** Mode throughput: what a worker precomputes of an object, its parts and its atlas. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { clickOnce, complete, difference, openStage, openViewers, pictureOf, valueOf } from './support.mjs';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

async function open({ init, ...attributes } = {}) {
  const more = Object.entries(attributes).map(([name, value]) => ` ${name}="${value}"`);
  const page = await openViewers(stage, `<lucent-viewer src="made/baked.json" alt="A block"${more.join('')}></lucent-viewer>`, {
    init,
  });
  await page.evaluate(() =>
    Object.assign(document.querySelector('lucent-viewer').style, { width: '160px', height: '160px', maxHeight: 'none' }),
  );
  return page;
}

const bar = (page) => page.locator('lucent-viewer .bar.bake');
const button = (page) => bar(page).locator('button');
const baked = (page) => page.waitForFunction(() => document.querySelector('lucent-viewer').stats().bake === undefined);
const set = (page, path, value) =>
  page.evaluate(([one, to]) => document.querySelector('lucent-viewer').set(one, to), [path, value]);
const picture = async (page) => {
  await complete(page);
  return pictureOf(page);
};

test('a worker precomputes with a bar while the object is drawn without; a picture waits for it', async () => {
  const page = await open();
  await bar(page).waitFor();
  assert.match(await bar(page).textContent(), /Precomputing block/);
  const first = await pictureOf(page); // a person's download has what the scene asks for
  assert.equal(await page.evaluate(() => document.querySelector('lucent-viewer').stats().bake), undefined);
  assert.ok(await bar(page).isHidden());
  await set(page, 'objects.block.material.precomputed', false);
  const splatted = await picture(page);
  assert.ok(difference(first, splatted).share > 0.05);
  await set(page, 'objects.block.material.precomputed', true);
  await complete(page);
  assert.ok(await bar(page).isHidden(), 'it is kept');
  assert.equal(difference(first, await pictureOf(page)).max, 0);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('it can be ended and begun again', async () => {
  const page = await open();
  await clickOnce(page, '.bar.bake', /Precomputing block/);
  assert.match(await bar(page).textContent(), /block is drawn without precomputed light/);
  await complete(page);
  assert.equal(await button(page).textContent(), 'Precompute');
  const without = await pictureOf(page); // which does not wait for what nobody works on
  await button(page).click();
  await baked(page);
  assert.ok(difference(without, await picture(page)).share > 0.05);
  assert.deepEqual(page.problems, []);
  await page.leave();
});

test('a page that may start no worker does the same', async () => {
  const page = await open({
    init: () => {
      self.Worker = class { constructor() { throw new Error('none here'); } };
      self.said = new Set();
      const watch = () => {
        const text = document.querySelector('lucent-viewer')?.shadowRoot?.querySelector('.bar.bake')?.textContent;
        if (text) self.said.add(text);
        setTimeout(watch); // between slices
      };
      watch();
    },
  });
  await bar(page).waitFor();
  await baked(page);
  const shares = await page.evaluate(() => [...self.said].filter((text) => text.includes('precomputing block here: ')));
  assert.ok(shares.length > 5, `a person sees it go on: ${shares}`);
  const own = await picture(page);
  await page.leave();
  const other = await open();
  await baked(other);
  assert.equal(difference(own, await picture(other)).max, 0);
  await other.leave();
});

test('mode throughput shows its parts, its illumination map and its atlas, and splats beside', async () => {
  const page = await open({ controls: 'html' });
  await baked(page);
  await complete(page);
  assert.equal(await valueOf(page, 'mode'), 'throughput');
  const shown = { whole: await pictureOf(page) };
  for (const part of ['local', 'global', 'illumination']) {
    await set(page, 'technique.throughput.part', part);
    shown[part] = await picture(page);
    assert.ok(difference(shown.whole, shown[part]).share > 0.01, part); // local light is where lamps shine
  }
  assert.ok(await set(page, 'view.show', 'atlas'));
  assert.ok(difference(shown.illumination, await picture(page)).share > 0.05);
  await set(page, 'view.show', 'color');
  await set(page, 'technique.throughput.part', 'whole');
  await set(page, 'compare', 'methods');
  await set(page, 'beside.objects.block.material.precomputed', false);
  await complete(page);
  const { left, right } = await page.evaluate(() => document.querySelector('lucent-viewer').comparison());
  assert.equal(left, 'Precomputed true');
  assert.equal(right.name, 'Precomputed false');
  assert.deepEqual(page.problems, []);
  await page.leave();
});
