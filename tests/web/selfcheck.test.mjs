/** The self-check: closed forms and capabilities on the device of the browser. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { complete, difference, kDriver, openPage, openStage, openViewers, pictureOf } from './support.mjs';

const kViewer = '<lucent-viewer src="made/dome.json"></lucent-viewer>';
const kMasks = [
  { EXT_float_blend: 'Blend 32-bit floats' },
  { OES_texture_float_linear: 'Filter 32-bit floats', EXT_disjoint_timer_query_webgl2: 'Timer queries' },
];
// How checks begin, end and are shown, and what stands in for an extension, does not hang on who draws: the quicker driver.
const onOneDriver = { skip: kDriver !== 'llvmpipe' && 'runs on llvmpipe' };

let stage;
before(async () => (stage = await openStage()));
after(() => stage.close());

const open = async (options) => {
  const page = await openViewers(stage, kViewer, { viewport: { width: 320, height: 240 }, ...options });
  await complete(page);
  return page;
};
const check = (page) => page.evaluate(() => document.querySelector('lucent-viewer').selfCheck());
const named = (report, name) => report.capabilities.find((one) => one.name === name);
const text = (page, selector) => page.textContent(`.lucent-check ${selector}`);

test('every closed form holds in this browser, capabilities are measured, and the picture beside them stays', async () => {
  const page = await open();
  const before = await pictureOf(page);
  const report = await check(page);
  for (const { name, expected, found, passed, message } of report.checks) {
    assert.ok(passed, `${name}: expected ${expected}, found ${found} ${message ?? ''}`);
    console.log(`${kDriver}: ${name}: ${Math.abs(found - expected).toExponential(1)}`);
  }
  assert.ok(report.passed);
  assert.ok(report.checks.length >= 57, `${report.checks.length} checks`);
  assert.match(report.device.renderer, kDriver === 'swiftshader' ? /SwiftShader/ : /llvmpipe/);
  assert.equal(named(report, 'Draw into 32-bit floats').measured, 0);
  const half = named(report, 'Draw into 16-bit floats').measured;
  assert.ok(half > 2 ** -12 && half <= 2 ** -10, `one store in 16 bits costs ${half}`);
  assert.equal(named(report, 'High precision in shaders').measured, 2 ** -23);
  assert.ok(named(report, 'Filter 16-bit floats').measured <= 1 / 512 + 1e-3);
  for (const { name, measured } of report.capabilities) console.log(`${kDriver}: ${name}: ${measured}`);
  assert.deepEqual(difference(await pictureOf(page), before, 0), { max: 0, mean: 0, share: 0 });
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
});

/** A script that takes extensions from a page. */
const without = (...names) => `{
  const getExtension = WebGL2RenderingContext.prototype.getExtension;
  WebGL2RenderingContext.prototype.getExtension = function (name) {
    return ${JSON.stringify(names)}.includes(name) ? null : getExtension.call(this, name);
  };
}`;

for (const mask of kMasks)
  test(`without ${Object.keys(mask).join(' and ')} every closed form holds and the table says so`, onOneDriver, async () => {
    const page = await open({ init: without(...Object.keys(mask)) });
    const report = await check(page);
    assert.deepEqual(report.checks.filter(({ passed }) => !passed), []);
    for (const name of Object.values(mask)) {
      assert.equal(named(report, name).present, false);
      assert.equal(named(report, name).measured, null);
    }
    assert.deepEqual(page.problems, []);
    await page.leave();
  });

test('the table says what glass and caustics lose without blending of floats, and glass is as it says', onOneDriver, async () => {
  const pictures = [];
  for (const init of [undefined, without('EXT_float_blend')]) {
    const page = await openViewers(stage, kViewer.replace('dome', 'bead'), { viewport: { width: 320, height: 240 }, init });
    await complete(page);
    pictures.push(await pictureOf(page));
    if (init) {
      const { present, use, fallback } = named(await check(page), 'Blend 32-bit floats');
      assert.equal(present, false);
      assert.match(use, /caustic maps.*glass/);
      assert.match(fallback, /caustic maps of 16-bit floats.*loses 0\.7 % of its light/);
      assert.match(fallback, /layers of glass by peeling are the same/);
    }
    await page.leave();
  }
  assert.deepEqual(difference(...pictures, 0), { max: 0, mean: 0, share: 0 });
});

test('without floating-point targets the page says what they hold', onOneDriver, async () => {
  const page = await openViewers(stage, '', { init: without('EXT_color_buffer_float') });
  const { code, message } = await page.evaluate(async () => {
    const viewer = document.createElement('lucent-viewer');
    const failed = new Promise((done) => viewer.addEventListener('error', ({ detail }) => done(detail)));
    viewer.src = 'made/bead.json';
    document.body.append(viewer);
    const { code, message } = await failed;
    return { code, message };
  });
  assert.equal(code, 'gpu');
  assert.match(message, /^caps: cannot draw into floating-point textures \(EXT_color_buffer_float missing\) on .*llvmpipe/);
  assert.match(message, /; visible points, layers of glass and sums of light are drawn into them$/);
  await page.leave();
});

test('two checks at once both come to an end', onOneDriver, async () => {
  const page = await open();
  const passed = await page.evaluate(async () => {
    const viewer = document.querySelector('lucent-viewer');
    const reports = await Promise.all([viewer.selfCheck(), viewer.selfCheck()]);
    return reports.map((report) => report.passed);
  });
  assert.deepEqual(passed, [true, true]);
  await page.leave();
});

test('a cancelled check rejects with its reason and gives its context back', onOneDriver, async () => {
  const page = await open();
  const [name, lost] = await page.evaluate(async () => {
    const abort = new AbortController();
    const options = { signal: abort.signal, progress: () => abort.abort() };
    const reason = await document.querySelector('lucent-viewer').selfCheck(options).catch((error) => error.name);
    return [reason, window.seen.contexts.map((context) => context.isContextLost())];
  });
  assert.equal(name, 'AbortError');
  assert.deepEqual(lost, [false, true]); // the page's own stays
  await page.leave();
});

test('a lost context ends the check with a message, and it runs again afterwards', onOneDriver, async () => {
  const page = await open();
  const message = await page.evaluate(() => {
    const progress = () => window.seen.contexts.at(-1).getExtension('WEBGL_lose_context')?.loseContext();
    return document.querySelector('lucent-viewer').selfCheck({ progress }).catch((error) => error.message);
  });
  assert.equal(message, 'self-check: the WebGL context was lost; must be kept to the end');
  assert.ok((await check(page)).passed);
  await page.leave();
});

test('the keyboard opens and leaves a dialog that is cancelled, runs again, shows both tables and copies them', onOneDriver, async () => {
  const page = await openPage(stage, 'index.html', { viewport: { width: 1100, height: 900 } });
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await complete(page);
  await page.evaluate(() => {
    const viewer = document.querySelector('lucent-viewer');
    const forever = ({ signal }) =>
      new Promise((_, fail) => signal.addEventListener('abort', () => fail(signal.reason)));
    viewer.selfCheck = forever;
    window.again = () => delete viewer.selfCheck; // the element's own
  });
  await page.focus('#check');
  await page.keyboard.press('Enter');
  assert.equal(await page.isEnabled('.lucent-check [data-do=copy]'), false);
  await page.click('.lucent-check [data-do=cancel]');
  await page.waitForFunction(() => document.querySelector('.lucent-check [role=status]').textContent === 'Cancelled');
  await page.evaluate(() => window.again());
  await page.click('.lucent-check [data-do=run]');
  await page.waitForSelector('.lucent-check table');
  assert.match(await text(page, '[role=status]'), /^All \d+ pass on /);
  assert.equal(await page.locator('.lucent-check table').count(), 2);
  assert.equal(await page.locator('.lucent-check .failed').count(), 0);
  const cells = await page.locator('.lucent-check tbody tr', { hasText: 'light at 30 degrees' }).locator('td').allTextContents();
  assert.deepEqual(cells.slice(0, 2), ['passed', '0.5']);
  assert.ok(Math.abs(Number(cells[2]) - 0.5) < 1e-5, cells[2]);
  // What a screen reader walks by: captions, and heads of rows and columns.
  assert.deepEqual(await page.locator('.lucent-check caption').allTextContents(), ['Closed forms', 'Capabilities']);
  assert.equal(await page.locator('.lucent-check tbody tr').count(), await page.locator('.lucent-check th[scope=row]').count());
  assert.equal(await page.evaluate(() => document.activeElement.closest('dialog')?.className), 'lucent-check');
  if (process.env.LUCENT_SHOTS) await page.screenshot({ path: `${process.env.LUCENT_SHOTS}/selfcheck-${kDriver}.png` });
  await page.click('.lucent-check [data-do=copy]'); // is enabled by now, or is waited for in vain
  await page.waitForFunction(() => document.querySelector('.lucent-check [role=status]').textContent === 'Copied');
  const report = JSON.parse(await page.evaluate(() => navigator.clipboard.readText()));
  assert.ok(report.passed);
  assert.ok(report.device.renderer.length > 0);
  await page.keyboard.press('Escape');
  assert.equal(await page.locator('.lucent-check').isVisible(), false);
  assert.equal(await page.evaluate(() => document.activeElement.id), 'check');
  assert.deepEqual(page.problems, []);
  assert.deepEqual(await page.violations(), []);
  await page.leave();
});

test('a line that fails stands out, with its message', onOneDriver, async () => {
  const page = await openPage(stage);
  await complete(page);
  await page.evaluate(() => {
    const line = { meaning: 'm', expected: 1, tolerance: 0, reason: 'r' };
    const checks = [
      { ...line, name: 'good', found: 1, passed: true },
      { ...line, name: 'bad', found: 2, passed: false },
      { ...line, name: 'broken', found: null, passed: false, message: 'no memory' },
    ];
    const report = { device: { renderer: 'a device' }, checks, capabilities: [] };
    document.querySelector('lucent-viewer').selfCheck = async () => report;
  });
  await page.click('#check');
  await page.waitForSelector('.lucent-check table');
  assert.equal(await text(page, '[role=status]'), '2 of 3 fail on a device');
  const failed = await page.locator('.lucent-check .failed').allTextContents();
  assert.match(failed[0], /badm.*FAILED/);
  assert.match(failed[1], /brokenno memory.*FAILED.*no number/);
  await page.leave();
});
