/** The benchmark page: the sweep runs, says how far it is, stops when told to, and hands out its figures. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { openPage, openStage } from './support.mjs';

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

async function openWith(parts) {
  const page = await openPage(stage, 'bench.html');
  for (const part of ['relief', 'environment', 'scaling', 'hard', 'refraction', 'caustics'])
    await page.setChecked(`input[name=${part}]`, parts.includes(part));
  return page;
}

/**
 * Starts the sweep and cancels it once it is past a share and in a part. The page does it itself: on a fast machine
 * the sweep has ended before a click from here arrives.
 */
async function runUntil(page, { share = 0, part = '' }) {
  await page.evaluate(
    ({ share, part }) =>
      new Promise((done) => {
        const told = document.querySelector('#part');
        const observer = new MutationObserver(() => {
          if (document.querySelector('#share').value <= share || !told.value.startsWith(part)) return;
          observer.disconnect();
          document.querySelector('#cancel').click();
          done();
        });
        observer.observe(told, { childList: true, characterData: true, subtree: true });
        document.querySelector('#start').click();
      }),
    { share, part },
  );
  await page.waitForSelector('#start:enabled');
}

test('cancelled in the middle, the page hands out what it has found so far', async () => {
  const page = await openWith(['hard']);
  await runUntil(page, { share: 0.1 });
  assert.ok(await page.isVisible('#download'));
  assert.match(await page.textContent('#part'), /^cancelled after \d+ s$/);
  const found = await page.evaluate(() => window.found);
  assert.equal(found.format, 'lucent-bench-1');
  assert.equal(found.quick, true);
  assert.equal(found.machine.where, 'browser');
  assert.match(found.machine.browser, /Chrom/);
  assert.match(found.date, /^\d{4}-\d\d-\d\d$/);
  assert.equal(found.timing, 'finished-frame'); // both test drivers are software
  assert.equal(found.measurements.length, 0);
  const exact = found.hardCases.filter(({ method }) => method === 'hierarchy');
  assert.ok(exact.length > 0);
  for (const { name, status, error } of exact) assert.equal(status, 'pass', `${name}: RMSE ${error}`);
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
});

test('after a cancelled run the next one starts anew', async () => {
  const page = await openWith(['hard']);
  await runUntil(page, { share: 0.5 });
  await runUntil(page, { part: 'hard case' });
  assert.match(await page.textContent('#part'), /^cancelled after \d+ s$/);
  assert.ok((await page.evaluate(() => document.querySelector('#share').value)) < 0.5);
  await page.leave();
});

test('refraction is measured in the page as natively', async () => {
  const page = await openWith(['refraction']);
  await runUntil(page, { part: 'sphere: peel maxLayers' });
  const [first] = (await page.evaluate(() => window.found)).measurements;
  assert.equal(first.technique, 'refract');
  assert.ok(first.ms.median > 0);
  const { median, p95, lost } = first.error.degrees.all; // natively 0.002 and 0.021
  assert.ok(median < 0.004 && p95 < 0.04 && lost === 0, JSON.stringify(first.error));
  assert.deepEqual(page.problems, []);
  await page.leave();
});
