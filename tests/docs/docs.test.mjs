/** README and the pages of web/docs: what they link to is there, what they are made of is what they say. */
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { kPolicy } from '../../scripts/serve.mjs';

const kRoot = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
const kDocs = join(kRoot, 'web/docs');
const kMostLines = 180;
// What only the finished site has.
const kBuilt = /^(gallery\/|licences\.txt|bench\.js|page\.js|lucent|caustics-peers\.png)/;

const read = (path) => readFileSync(path, 'utf8');
const pages = readdirSync(kDocs).filter((name) => name.endsWith('.html'));
const htmlLinks = (text) => [...text.matchAll(/\s(?:href|src)="([^"]+)"/g)].map(([, link]) => link);
const markdownLinks = (text) => [...text.matchAll(/\]\(([^)\s]+)\)/g)].map(([, link]) => link);
const isLocal = (link) => !/^[a-z]+:/.test(link);

/** Fails for a link to a file that is not there, or to a place that it does not have. */
function check(from, link) {
  const [path, place] = link.split('#');
  const target = path ? resolve(dirname(from), path) : from;
  assert.ok(existsSync(target), `${from}: ${link}: is not there`);
  if (place) assert.ok(read(target).includes(`id="${place}"`), `${from}: ${link}: has no such place`);
}

test('README is short enough to be read', () => {
  const lines = read(join(kRoot, 'README.md')).split('\n').length - 1;
  assert.ok(lines <= kMostLines, `README.md: has ${lines} lines; must have at most ${kMostLines}`);
});

test('every local link of README leads somewhere', () => {
  const readme = join(kRoot, 'README.md');
  const links = markdownLinks(read(readme)).filter(isLocal);
  assert.ok(links.length > 10);
  for (const link of links) check(readme, link);
});

test('every local link of the documentation and of the pages beside it leads somewhere', () => {
  const beside = ['index.html', 'example.html', 'bench.html'].map((name) => join(kRoot, 'web', name));
  const files = [...pages.map((name) => join(kDocs, name)), ...beside];
  for (const file of files)
    for (const link of htmlLinks(read(file).replace(/<pre>.*?<\/pre>/gs, '')).filter(isLocal))
      if (!kBuilt.test(link)) check(file, link);
});

test('the pages have one navigation, their own title, and nothing that a strict policy forbids', () => {
  const navigation = (name) => read(join(kDocs, name)).match(/<header>.*?<\/header>/s)[0];
  const unmarked = (name) => navigation(name).replace(' aria-current="page"', '');
  for (const name of pages) {
    const text = read(join(kDocs, name));
    assert.match(navigation(name), new RegExp(`href="${name}" aria-current="page"`), name);
    assert.equal(unmarked(name), unmarked('index.html'), name);
    assert.match(text, /<html lang="en">/, name);
    assert.match(text, /<title>Lucent: .+<\/title>/, name);
    assert.doesNotMatch(text, /<script|<style|\sstyle="|\son[a-z]+="|(href|src)="https?:/, name);
    for (const [tag] of text.matchAll(/<img [^>]*>/g)) assert.match(tag, /alt="[^"]+"/, `${name}: ${tag}`);
  }
  for (const name of pages) assert.ok(unmarked('index.html').includes(`href="${name}"`), `${name}: is in no navigation`);
});

test('the policy that the element is promised to live under is the one that its tests serve', () => {
  assert.ok(read(join(kDocs, 'element.html')).includes(kPolicy));
});

test('the page of measurements is what the script makes of the figures that are kept', () => {
  execFileSync(process.execPath, [join(kRoot, 'scripts/measurements.mjs'), '--check'], { stdio: 'pipe' });
});

test('every command of the program that is shown is one that it has', () => {
  const folder = join(kRoot, 'src/cli');
  const sources = readdirSync(folder).filter((name) => name.endsWith('.cpp'));
  const declared = (text) => [...text.matchAll(/add_subcommand\(\s*"(\w+)"/g)].map(([, name]) => name);
  const known = new Set(sources.flatMap((name) => declared(read(join(folder, name)))));
  assert.ok(known.size > 5);
  for (const file of [join(kRoot, 'README.md'), ...pages.map((name) => join(kDocs, name))])
    for (const [, command] of read(file).matchAll(/(?:^|>)lucent ([a-z]+) /gm))
      assert.ok(known.has(command), `${file}: lucent ${command}: is no command`);
});
