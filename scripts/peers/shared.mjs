/**
 * What the scripts of peers in the browser share: their code brought into a page, exact pictures of the program, runs
 * on both software drivers, reports.
 */
import { build } from 'esbuild';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { cpus, totalmem } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const kHere = dirname(fileURLToPath(import.meta.url));
const kRoot = resolve(kHere, '../..');
export const kOut = join(kRoot, 'build/peers');

/** Ends the script, with a message and success, where npm packages that it needs are not installed. */
export function skipWithout(script, packages) {
  const missing = packages.filter((name) => !existsSync(join(kRoot, 'node_modules', name)));
  if (!missing.length) return;
  console.log(`${script}: skipped: npm packages are not there: ${missing.join(', ')}; scripts/setup installs them`);
  process.exit(0);
}

/** Bundles a script of this folder into an open page of the site. It sets window.compare. */
export async function bringIn(page, entry) {
  const bundle = await build({
    entryPoints: [join(kHere, entry)],
    bundle: true,
    format: 'esm',
    write: false,
    logLevel: 'warning',
  });
  await page.route('**/peer-page.js', (route) =>
    route.fulfill({ contentType: 'text/javascript', body: bundle.outputFiles[0].text }),
  );
  await page.addScriptTag({ url: 'peer-page.js', type: 'module' });
  await page.waitForFunction(() => window.compare);
}

/** Lets a page fetch files as peers/NAME. @param paths  where they lie, with their names */
export function offer(page, paths) {
  const files = new Map(paths.map((path) => [basename(path), path]));
  return page.route('**/peers/*', (route) => {
    const path = files.get(new URL(route.request().url()).pathname.split('/').pop());
    return path ? route.fulfill({ body: readFileSync(path) }) : route.fulfill({ status: 404 });
  });
}

/** Names of files by what they hold, for a page that fetches them. @param paths  {exact: path, ...} */
export const namesOf = (paths) => Object.fromEntries(Object.entries(paths).map(([key, path]) => [key, basename(path)]));

/** Scenes with what they name, and their exact pictures: a folder in which the program works. */
export class Truths {
  /** @param program  path of lucent */
  constructor(program) {
    this.program = resolve(program);
    this.folder = join(kOut, 'truths');
    if (!existsSync(this.program)) {
      console.error(`${program}: is not there; cmake --build --preset native builds it`);
      process.exit(1);
    }
    mkdirSync(this.folder, { recursive: true });
  }
  #run(...words) {
    execFileSync(this.program, words, { stdio: ['ignore', 'ignore', 'inherit'], cwd: this.folder });
  }

  /** Turns a mesh file into the plain form that every module reads. @return its path */
  mesh(file, name) {
    const path = join(this.folder, name);
    this.#run('convert', resolve(kRoot, file), '-o', path);
    return path;
  }

  /**
   * The exact picture of a scene, from an earlier run where one has made it.
   * @param more  further words for lucent truth
   * @return      path of the PFM; beside it FILE.json has its standard error
   */
  solve(name, scene, aov, more = []) {
    const path = join(this.folder, `${name}-${aov}.pfm`);
    const [source, asked] = [join(this.folder, `${name}.json`), `${path}.asked`];
    const wish = JSON.stringify({ scene, aov, more });
    if (existsSync(path) && existsSync(asked) && readFileSync(asked, 'utf8') === wish) return path;
    writeFileSync(source, JSON.stringify(scene));
    this.#run('truth', source, '--aov', aov, '-o', path, ...more);
    writeFileSync(asked, wish);
    return path;
  }
}

/** A figure with its target, as reports have it. */
export const atMost = (name, value, target) => ({ name, value, target, atLeast: false, met: value <= target });
export const atLeast = (name, value, target) => ({ name, value, target, atLeast: true, met: value >= target });
/** A figure of which nothing was promised. */
export const figure = (name, value) => ({ name, value });

export const named = (knobs) => Object.entries(knobs).map(([name, value]) => `${name} ${value}`).join(', ');
export const milliseconds = ({ median, low, high }) =>
  `${median.toFixed(1)} ms (${low.toFixed(1)} to ${high.toFixed(1)})`;

/** The setting of a sweep that was marked to race. */
export const bestOf = (swept) => swept.find(({ isBest }) => isBest);

export function textOf({ name, value, target, atLeast: least, met }) {
  const promise = `, target at ${least ? 'least' : 'most'} ${target}${met ? '' : ': missed'}`;
  return `${name}: ${Number(value.toPrecision(3))}${target === undefined ? '' : promise}`;
}

/** What lucent report reads. @param found  of the page: driver, glVersion */
function reportOf(stage, found, measurements, ratios) {
  const [cpu] = cpus();
  return {
    format: 'lucent-bench-1',
    date: new Date().toISOString().slice(0, 10),
    commit: execFileSync('git', ['rev-parse', '--short', 'HEAD'], { cwd: kHere, encoding: 'utf8' }).trim(),
    quick: false,
    machine: {
      cpu: cpu.model,
      cores: cpus().length,
      memoryMB: Math.round(totalmem() / 2 ** 20),
      where: 'browser',
      driver: found.driver,
      version: found.glVersion,
      browser: `Chromium ${stage.browser.version()}`,
    },
    timing: 'finished-frame',
    measurements,
    ratios,
  };
}

/**
 * Runs a comparison in the browser on each software driver and writes build/peers/NAME-DRIVER.json. The process ends
 * with 1 where a target is missed.
 * @param more     further options of the command line, as parseArgs has them
 * @param compare  (page, options, say) => {found, measurements, ratios}
 */
export async function runOnDrivers(name, more, compare) {
  const { values: options } = parseArgs({
    options: { site: { type: 'string', default: 'build/web/site' }, driver: { type: 'string' }, ...more },
  });
  process.env.LUCENT_SITE = options.site;
  mkdirSync(kOut, { recursive: true });
  for (const driver of options.driver ? [options.driver] : ['swiftshader', 'llvmpipe']) {
    process.env.LUCENT_DRIVER = driver;
    const say = (line) => console.log(`${driver}: ${line}`);
    const { openStage, openPage } = await import(`../../tests/web/support.mjs?driver=${driver}`);
    const stage = await openStage();
    const page = await openPage(stage, 'blank.html');
    const { found, measurements, ratios } = await compare(page, options, say);
    ratios.forEach((ratio) => say(textOf(ratio)));
    if (ratios.some(({ met }) => met === false)) process.exitCode = 1;
    const file = `${name}-${driver}.json`;
    writeFileSync(join(kOut, file), JSON.stringify(reportOf(stage, found, measurements, ratios), null, 1) + '\n');
    say(`wrote build/peers/${file}`);
    await stage.close();
  }
}
