/**
 * Runs the tests of the page on both software drivers, two files at a time, and counts them.
 *
 *   node tests/web/run.mjs --site build/web/site [--native DIR] [--program FILE] [--driver NAME] [FILE...]
 *
 * --site    the finished page
 * --native  folder with SCENE.png that the program rendered: compares the browser's pictures with them
 * --program  the program, which opens what the page saves
 * --driver  swiftshader or llvmpipe only
 * FILE      parts of names of test files; all without
 */
import { spawn } from 'node:child_process';
import { readdirSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const kFolder = dirname(fileURLToPath(import.meta.url));
const kDrivers = ['swiftshader', 'llvmpipe'];
// What hands and attributes do does not hang on who draws: the quicker driver.
const kOnOneDriver = Object.fromEntries(
  [
    'axe',
    'bench',
    'bring',
    'compare',
    'controls',
    'docs',
    'element',
    'export',
    'gestures',
    'keep',
    'limits',
    'modules',
    'page',
    'paint',
    'peers',
    'playing',
    'serve',
    'writing',
  ].map((name) => [`${name}.test.mjs`, 'llvmpipe']),
);
// Much of a test is waiting, compiling and JavaScript, which take one core.
const kWorkers = 2;
// These begin, so that the last worker does not end long after the others.
const kLongest = ['page', 'selfcheck', 'bring', 'pictures', 'compare', 'paint'].map((name) => `${name}.test.mjs`);

const { values: options, positionals } = parseArgs({
  options: { site: { type: 'string' }, native: { type: 'string' }, program: { type: 'string' }, driver: { type: 'string' } },
  allowPositionals: true,
});
if (!options.site) {
  console.error('web tests: --site is missing; must be the folder of the finished page');
  process.exit(1);
}

const files = readdirSync(kFolder)
  .filter((name) => name.endsWith('.test.mjs'))
  .filter((name) => options.native || name !== 'pictures.test.mjs')
  .filter((name) => positionals.length === 0 || positionals.some((part) => name.includes(part)));

/** Runs one file and shows its results. @return {Promise<{passed: number, failed: number}>} */
function runFile(file, driver) {
  const env = { ...process.env, LUCENT_DRIVER: driver, LUCENT_SITE: options.site };
  if (options.native) env.LUCENT_NATIVE = options.native;
  if (options.program) env.LUCENT_PROGRAM = options.program;
  const child = spawn(process.execPath, ['--test-reporter=tap', join(kFolder, file)], {
    env,
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  const start = Date.now();
  let output = '';
  child.stdout.on('data', (data) => (output += data));
  return new Promise((done) => {
    child.on('close', (code) => {
      const results = output.match(/^(not )?ok \d+ - .*/gm) ?? [];
      const failed = results.filter((line) => line.startsWith('not')).length;
      for (const line of results) console.log(`${driver}: ${file}: ${line}`);
      for (const [, name, ms] of output.matchAll(/^(?:not )?ok \d+ - (.*)\n  ---\n  duration_ms: (\d{5,})/gm))
        console.log(`${driver}: ${file}: ${Math.round(ms / 1000)} s: ${name}`);
      console.log(`${driver}: ${file}: ${Math.round((Date.now() - start) / 1000)} s`);
      for (const line of output.match(new RegExp(`^(# )?${driver}: .*`, 'gm')) ?? []) console.log(line);
      const broken = code !== 0 && failed === 0; // the file itself ended early
      if (failed || broken) console.log(output);
      done({ passed: results.length - failed, failed: failed + (broken ? 1 : 0) });
    });
  });
}

const rank = ({ file }) => (kLongest.includes(file) ? kLongest.indexOf(file) : kLongest.length);
const drivers = options.driver ? [options.driver] : kDrivers;
const waiting = drivers
  .flatMap((driver) => files.map((file) => ({ file, driver })))
  .filter(({ file, driver }) => (kOnOneDriver[file] ?? driver) === driver)
  .sort((one, other) => rank(one) - rank(other));

let passed = 0;
let failed = 0;
async function work() {
  for (let next = waiting.shift(); next; next = waiting.shift()) {
    const count = await runFile(next.file, next.driver);
    passed += count.passed;
    failed += count.failed;
  }
}
await Promise.all(Array.from({ length: kWorkers }, work));
console.log(`web tests: ${passed} passed, ${failed} failed`);
process.exit(failed || !passed ? 1 : 0);
