/** The documentation as the site serves it: under the page's policy, on screens wide and narrow. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { openPage, openStage } from './support.mjs';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

for (const [width, colorScheme] of [
  [1200, 'light'],
  [390, 'dark'],
])
  test(`every page of the documentation is whole at ${width} pixels, ${colorScheme}`, async () => {
    const page = await openPage(stage, 'docs/index.html', { viewport: { width, height: 800 }, colorScheme });
    const names = await page.$$eval('header nav a', (links) => links.map((link) => link.getAttribute('href')));
    assert.ok(names.length >= 8);
    for (const name of names) {
      await page.goto(new URL(`docs/${name}`, stage.address).href);
      const { over, broken } = await page.evaluate(() => ({
        over: document.documentElement.scrollWidth - innerWidth,
        broken: [...document.images].filter(({ naturalWidth }) => !naturalWidth).length,
      }));
      assert.ok(over <= 0, `${name}: is ${over} pixels wider than the window`);
      assert.equal(broken, 0, `${name}: a picture is not there`);
      assert.deepEqual(await page.violations(), []);
    }
    assert.deepEqual(page.problems, []);
    await page.leave();
  });
