/**
 * Makes the page of benchmark reports: one HTML file with style, script, plotting library and its terms inside. The
 * program puts reports into it (src/cli/ReportPage.cpp).
 *
 *   node scripts/report/build.mjs --out build/native/report_page.html
 */
import { build, transform } from 'esbuild';
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const kHere = dirname(fileURLToPath(import.meta.url));
const kModules = resolve(kHere, '../../node_modules');
const { values: options } = parseArgs({ options: { out: { type: 'string' } } });
if (!options.out) {
  console.error('report: --out is missing; must name the page to write');
  process.exit(1);
}

const read = (name) => readFileSync(join(kHere, name), 'utf8');
const escaped = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;');

const script = await build({
  entryPoints: [join(kHere, 'report.js')],
  bundle: true,
  minify: true,
  write: false,
  format: 'iife',
  target: 'es2022',
  legalComments: 'none', // the terms stand whole at the end of the page
  logLevel: 'warning',
});
const style = await transform(read('report.css'), { loader: 'css', minify: true });
const terms = ['echarts/LICENSE', 'echarts/NOTICE', 'zrender/LICENSE', 'tslib/LICENSE.txt']
  .map((name) => `==== ${name}\n\n${readFileSync(join(kModules, name), 'utf8')}`)
  .join('\n');

const parts = { STYLE: style.code.trim(), SCRIPT: script.outputFiles[0].text.trim(), TERMS: escaped(terms) };
const page = read('report.html').replace(/\{\{(STYLE|SCRIPT|TERMS)\}\}/g, (_, name) => parts[name]);
writeFileSync(options.out, page);
