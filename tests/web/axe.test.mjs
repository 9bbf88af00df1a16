/** What axe finds in the pages: names, roles, contrast, order of headings, within the viewers too. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';
import { complete, openPage, openStage } from './support.mjs';

const kAxe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

/** Rules that a page breaks, each with what breaks it. */
async function violations(page) {
  await page.evaluate(kAxe);
  const found = await page.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
  return found.violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.flat().join(' ')).join('; ')}`);
}

for (const colorScheme of ['light', 'dark'])
  test(`axe finds nothing in the page of examples, ${colorScheme}`, async () => {
    const page = await openPage(stage, 'example.html', {
      gallery: 'own',
      colorScheme,
      viewport: { width: 900, height: 1400 },
    });
    await complete(page, '#first');
    await complete(page, '#second');
    assert.deepEqual(await violations(page), []);
    await page.leave();
  });

test('axe finds nothing in the product page, its dialogs and its first visit', async () => {
  const page = await openPage(stage, 'index.html', { visits: 0 });
  await page.waitForSelector('.tour');
  await complete(page);
  assert.deepEqual(await violations(page), []);
  await page.keyboard.press('Escape');
  assert.deepEqual(await violations(page), []);
  await page.evaluate(() => {
    const viewer = document.querySelector('lucent-viewer');
    viewer.src = 'made/ball.json';
    return new Promise((done) => viewer.addEventListener('load', done, { once: true }));
  });
  await page.evaluate(() => {
    const viewer = document.querySelector('lucent-viewer');
    viewer.set('mode', 'paint');
    viewer.set('compare', 'methods');
  });
  await page.waitForSelector('lucent-viewer .question');
  assert.deepEqual(await violations(page), []);
  await page.leave();
});

test('axe finds nothing in the documentation', async () => {
  for (const name of ['index', 'page', 'element', 'parameters', 'model']) {
    const page = await openPage(stage, `docs/${name}.html`);
    assert.deepEqual(await violations(page), [], name);
    await page.leave();
  }
});
