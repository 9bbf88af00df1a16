/**
 * Makes the page from its sources and the compiled modules.
 *
 *   node scripts/build_web.mjs --wasm build/web --out build/web/site [--program build/native/lucent | --first]
 *
 * --wasm  folder with the modules lucent, lucent-relief, lucent-readers, lucent-truth, lucent-check and lucent-bench, .mjs and .wasm each
 * --out   folder of the finished page; the gallery is copied from assets/generated/gallery when it is there, the
 *         documentation from web/docs to docs/, with the pictures that it shows
 * --first  takes the modules that a page needs to open, others where they are there, and copies no gallery: it is served
 *         from where it is made
 * --program  makes the page of parameters anew of what this program lists; else it is the repository's
 */
import { build, transform } from 'esbuild';
import { spawnSync } from 'node:child_process';
import { copyFileSync, cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';

const kRoot = resolve(dirname(fileURLToPath(import.meta.url)), '..');
const kGallery = join(kRoot, 'assets/generated/gallery');
const web = (name) => join(kRoot, 'web', name);

const { values: options } = parseArgs({
  options: {
    wasm: { type: 'string' },
    out: { type: 'string' },
    program: { type: 'string' },
    first: { type: 'boolean' },
  },
});
if (!options.wasm || !options.out) fail('--wasm and --out are missing; both must name a folder');
const wasm = (name) => resolve(options.wasm, name);
const out = (name) => resolve(options.out, name);

function fail(message) {
  console.error(`build_web: ${message}`);
  process.exit(1);
}

/** Of the sources; "unknown" where they are no checkout. */
function commit() {
  const asked = spawnSync('git', ['rev-parse', '--short', 'HEAD'], { cwd: kRoot, encoding: 'utf8' });
  return asked.status === 0 ? asked.stdout.trim() : 'unknown';
}

/** `import css from './viewer.css'` gives the minified text. */
const cssAsText = {
  name: 'css-as-text',
  setup(bundler) {
    bundler.onLoad({ filter: /\.css$/ }, async ({ path }) => {
      const { code } = await transform(readFileSync(path, 'utf8'), { loader: 'css', minify: true });
      return { contents: code.trim(), loader: 'text' };
    });
  },
};

const common = { minify: true, format: 'esm', target: 'es2022', legalComments: 'none', logLevel: 'warning' };

const kFirst = ['lucent', 'lucent-readers'];
const kLater = ['lucent-relief', 'lucent-truth', 'lucent-check', 'lucent-bench'];
const isThere = (module) => existsSync(wasm(`${module}.mjs`)) && existsSync(wasm(`${module}.wasm`));
const modules = [...kFirst, ...kLater.filter((module) => !options.first || isThere(module))];
for (const module of modules)
  if (!isThere(module)) fail(`${wasm(module)}: .mjs or .wasm is not there; the preset "web" builds both`);
// Of reliefs the whole module draws the same: it stands in until theirs is there.
const reliefs = modules.includes('lucent-relief') ? 'lucent-relief' : 'lucent';
/** Bundles what a module belongs to. */
const bundleOf = (module, bundle) => modules.includes(module) && build({ ...common, ...bundle });
mkdirSync(options.out, { recursive: true });

await build({
  ...common,
  bundle: true,
  entryPoints: [web('lucent-viewer.js')],
  outfile: out('lucent-viewer.js'),
  alias: { 'lucent-relief-wasm': wasm(`${reliefs}.mjs`) },
  external: ['./export.js', './selfcheck.js', './zip.js'], // fetched when asked for
  plugins: [cssAsText],
});
await bundleOf('lucent-check', {
  bundle: true,
  entryPoints: [web('selfcheck.js')],
  outfile: out('selfcheck.js'),
  alias: { 'lucent-check-wasm': wasm('lucent-check.mjs') },
  plugins: [cssAsText],
});
for (const name of ['lucent', 'lucent-readers'])
  await build({ ...common, entryPoints: [wasm(`${name}.mjs`)], outfile: out(`${name}.js`) });
await bundleOf('lucent-bench', { entryPoints: [wasm('lucent-bench.mjs')], outfile: out('lucent-bench.js') });
await build({
  ...common,
  bundle: true,
  entryPoints: [web('bench.js')],
  outfile: out('bench.js'),
  external: ['./lucent-bench.js'],
  define: { LUCENT_COMMIT: JSON.stringify(commit()) },
});
await bundleOf('lucent-truth', {
  bundle: true,
  entryPoints: [web('truth_job.js')],
  outfile: out('lucent-truth.js'),
  alias: { 'lucent-truth-wasm': wasm('lucent-truth.mjs') },
});
for (const [source, name] of [['stereo_job', 'lucent-stereo'], ['reading', 'lucent-reading'], ['bake_job', 'lucent-bake']])
  await build({ ...common, bundle: true, entryPoints: [web(`${source}.js`)], outfile: out(`${name}.js`) });
for (const name of ['export', 'zip'])
  await build({ ...common, bundle: true, entryPoints: [web(`${name}.js`)], outfile: out(`${name}.js`) });
const dialogs = ['./open.js', './picture.js', './selfcheck.js', './tour.js']; // fetched when asked for
for (const name of ['page', 'open', 'picture', 'tour'])
  await build({
    ...common,
    bundle: true,
    entryPoints: [web(`${name}.js`)],
    outfile: out(`${name}.js`),
    external: ['./lucent-viewer.js', ...dialogs],
  });
await build({ minify: true, entryPoints: [web('page.css')], outfile: out('page.css') });
for (const name of ['index.html', 'bench.html']) copyFileSync(web(name), out(name));

// The picture of what public peers make of a caustic is measured (scripts/peers/caustics.mjs); without it its figure
// is left out.
const kPeers = join(kRoot, 'assets/pictures/caustics-peers.png');
const example = readFileSync(web('example.html'), 'utf8');
if (existsSync(kPeers)) copyFileSync(kPeers, out('caustics-peers.png'));
writeFileSync(out('example.html'), existsSync(kPeers) ? example : example.replace(/<figure class="peers">.*?<\/figure>\n/s, ''));

// The documentation: pages and style as they are, pictures beside them.
const kPictures = '../../assets/pictures/';
rmSync(out('docs'), { recursive: true, force: true });
mkdirSync(out('docs/pictures'), { recursive: true });
for (const name of readdirSync(web('docs')).filter((name) => /\.(html|css)$/.test(name))) {
  const text = readFileSync(web(`docs/${name}`), 'utf8');
  for (const [, picture] of text.matchAll(/\.\.\/\.\.\/assets\/pictures\/([\w.-]+)/g))
    copyFileSync(join(kRoot, 'assets/pictures', picture), out(`docs/pictures/${picture}`));
  writeFileSync(out(`docs/${name}`), text.replaceAll(kPictures, 'pictures/'));
}
if (options.program) {
  const command = [join(kRoot, 'scripts/parameters.mjs'), '--program', options.program, '--out', out('docs/parameters.html')];
  if (spawnSync(process.execPath, command, { stdio: 'inherit' }).status !== 0) fail('the page of parameters cannot be made');
}
for (const module of modules) copyFileSync(wasm(`${module}.wasm`), out(`${module}.wasm`));
if (!options.first && existsSync(kGallery)) {
  rmSync(out('gallery'), { recursive: true, force: true });
  cpSync(kGallery, out('gallery'), { recursive: true });
}

// The terms of what the page carries, as the packages state them.
const kCarried = ['emscripten', 'fonts-inter', 'libeigen3-dev', 'libglm-dev', 'libstb-dev', 'libtinyexr-dev', 'libtiff-dev', 'libtinygltf-dev', 'nlohmann-json3-dev', 'zlib1g-dev'];
const terms = kCarried.map((name) => [name, `/usr/share/doc/${name}/copyright`]);
terms.push(['zip.js', join(kRoot, 'node_modules/@zip.js/zip.js/LICENSE')]);
terms.push(['imgui', join(kRoot, 'build/packages/imgui/LICENSE.txt')], ['lucent', join(kRoot, 'LICENSE')]);
const notices = terms.filter(([, file]) => existsSync(file)).map(([name, file]) => `==== ${name}\n\n${readFileSync(file, 'utf8')}`);
writeFileSync(out('licences.txt'), notices.join('\n'));

const sizeOf = (name) => gzipSync(readFileSync(out(name)), { level: 9 }).length;
for (const name of readdirSync(options.out).filter((name) => /\.(js|css|html|wasm)$/.test(name)))
  console.log(`build_web: ${name}: ${readFileSync(out(name)).length} bytes, ${sizeOf(name)} compressed`);
const first = ['index.html', 'page.css', 'page.js', 'lucent-viewer.js'];
for (const [scene, more] of Object.entries({ relief: [`${reliefs}.wasm`], glass: ['lucent.js', 'lucent.wasm'] })) {
  const bytes = [...first, ...more].reduce((sum, name) => sum + sizeOf(name), 0);
  console.log(`build_web: before a scene of ${scene} is interactive: ${bytes} bytes compressed`);
}
