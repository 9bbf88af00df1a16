/** The page of benchmark reports in Chromium: it opens by itself, draws its plots and fills its tables. */
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const kFlags = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];

const measurement = (method, knobs, ms, rmse, more = {}) => ({
  technique: 'relief', scene: 'noise', method, knobs, width: 64, height: 64, lights: 4,
  ms: { median: ms, low: ms, high: ms, repeats: 3 }, passes: 2, draws: 2, bytes: 1000, truthNoise: 0, pareto: true,
  error: { rmse, relRmse: rmse, relMse: rmse, mae: rmse, p50: rmse, p90: rmse, p99: rmse, max: rmse, bias: 0, psnr: 60, ssim: 1, flip: rmse, fluxRatio: 1 },
  ...more,
});
const report = (where) => ({
  format: 'lucent-bench-1', date: '2026-01-02', commit: 'abc1234', quick: true,
  machine: { where, driver: 'a driver', version: 'a version' }, timing: 'finished-frame',
  measurements: [
    measurement('hierarchy', {}, 10, 0), // no error at all: a logarithmic axis must bear it
    measurement('march', { steps: 64 }, 20, 0.01, { modelError: { rmse: 0.2 } }),
    { technique: 'relief', scene: 'noise', method: 'magic', knobs: {}, width: 64, height: 64, lights: 0, refused: 'unknown </script><b id="broken">' },
  ],
  scaling: [{ technique: 'relief', method: 'hierarchy', over: 'texels', points: [{ x: 1, ms: 1 }, { x: 4, ms: 4 }], exponent: 1 }],
  hardCases: [{ name: 'cliff', method: 'hierarchy', status: 'pass', error: 1e-7 }, { name: 'NaN', method: 'hierarchy', status: 'refused', message: 'texel (1, 1) is nan' }],
  ratios: [{ name: 'a promise', value: 9, target: 10, atLeast: true, met: false }],
});

let folder, browser;
before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'lucent-report-'));
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: kFlags });
});
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true });
});

async function open(reports, options = {}) {
  const files = reports.map((content, i) => {
    writeFileSync(join(folder, `${i}.json`), JSON.stringify(content));
    return join(folder, `${i}.json`);
  });
  const path = join(folder, 'report.html');
  execFileSync(process.env.LUCENT_PROGRAM, ['report', ...files, '-o', path]);
  const page = await browser.newPage(options);
  const wrong = [];
  page.on('pageerror', (error) => wrong.push(error.message));
  page.on('console', (message) => message.type() !== 'log' && wrong.push(message.text()));
  page.on('request', (request) => /^(file|data):/.test(request.url()) || wrong.push(`asked for ${request.url()}`));
  await page.goto(pathToFileURL(path).href);
  return { page, wrong };
}

test('draws every plot with a table and asks for nothing from elsewhere', async () => {
  const { page, wrong } = await open([report('native')]);
  assert.deepEqual(wrong, []);
  assert.equal(await page.locator('.plot svg').count(), 3); // method error, model error, cost
  assert.equal(await page.locator('#broken').count(), 0);
  const tables = await page.locator('table caption').allTextContents();
  assert.deepEqual(tables, ['Figures with their targets', 'Measurements: noise, 64 x 64', 'Time over texels', 'Native, a driver']);
  assert.match(await page.locator('main').textContent(), /missed.*pass.*refused: texel \(1, 1\) is nan/s);
  await page.close();
});

test('tells the figures of a point under the mouse', async () => {
  const { page } = await open([report('native')]);
  const plot = page.locator('.plot').first();
  await plot.scrollIntoViewIfNeeded();
  const places = await plot.locator('svg path').evaluateAll((paths) => paths.map((path) => path.getBoundingClientRect()).map(({ x, y, width, height }) => [x + width / 2, y + height / 2, width]));
  for (const [x, y] of places.filter(([, , width]) => width > 8 && width < 18)) { // points, and the dots of the legend
    await page.mouse.move(x, y);
    await page.waitForTimeout(50);
  }
  assert.match(await plot.locator('div').allTextContents().then((texts) => texts.join(' ')), /3 times/);
  await page.close();
});

test('shows other errors when they are chosen, in the dark as well', async () => {
  const { page, wrong } = await open([report('native')], { colorScheme: 'dark' });
  await page.selectOption('#metric', 'flip');
  assert.match(await page.locator('.plot svg').first().textContent(), /FLIP/);
  assert.deepEqual(wrong, []);
  await page.close();
});

test('puts several machines side by side, one of which measured little', async () => {
  const { format, date, commit, machine, timing } = report('native');
  const peer = { format, date, commit, machine, timing, measurements: [{ ...measurement('shadow map', {}, 5), technique: 'three.js', error: { wrongShare: 0.01 } }] };
  const { page, wrong } = await open([report('native'), report('browser'), peer]);
  assert.deepEqual(wrong, []);
  assert.equal(await page.locator('.grid section').count(), 3);
  await page.selectOption('#metric', 'wrongShare');
  assert.match(await page.locator('.plot svg').first().textContent(), /share of wrong texels.*three\.js|three\.js.*share of wrong texels/s);
  assert.equal(await page.locator('.plot svg').count(), 3); // the same case is one plot
  assert.equal(await page.locator('text=✗ missed').count(), 2);
  await page.close();
});
