/**
 * Makes the page of parameters, web/docs/parameters.html, of what `lucent list` prints.
 *
 *   node scripts/parameters.mjs [--program build/native/lucent] [--out web/docs/parameters.html]
 *
 * The page in the repository is for who reads it there; scripts/build_web.mjs makes the site's anew, so that what is
 * served is what the program knows.
 */
import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { documentOf, escaped, idOf, kDocs, table } from './docs_page.mjs';

const { values: options } = parseArgs({
  options: {
    program: { type: 'string', default: 'build/native/lucent' },
    out: { type: 'string', default: join(kDocs, 'parameters.html') },
  },
});

// Of the element's attributes, by the first part of a path; of objects by what follows the name.
const kPrefixes = { lights: 'light', environment: 'env', camera: 'camera', view: 'view', quality: 'quality' };
function prefixOf(path) {
  const [first, second, third] = path.split('.');
  if (path.includes('.layers')) return '';
  if (first === 'technique') return second;
  return first === 'objects' ? third : kPrefixes[first];
}

function valuesOf({ kind, choices, min, max, minIsExcluded }) {
  if (kind === 'toggle') return 'true or false';
  if (kind === 'choice') return choices.map((choice) => `<code>${escaped(choice)}</code>`).join(', ');
  const low = min == null ? '' : minIsExcluded ? `above ${min}` : `at least ${min}`;
  const high = max == null ? '' : `at most ${max}`;
  return [kind, [low, high].filter(Boolean).join(', ')].filter(Boolean).join(': ');
}

function sectionOf({ title, path, parameters }) {
  const prefix = prefixOf(path);
  const rows = parameters.map((one) => [
    `<code>${escaped(one.id)}</code>`,
    escaped(one.label),
    valuesOf(one) + (one.unit ? `, ${escaped(one.unit)}` : ''),
    `<code>${escaped(one.default)}</code>`,
    escaped(one.doc),
  ]);
  const attributes = prefix ? ` Attributes of the element begin with <code>${prefix}-</code>.` : '';
  return (
    `<h2 id="${idOf(title)}">${escaped(title[0].toUpperCase() + title.slice(1))}</h2>\n` +
    `<p><code>${escaped(path)}.KEY</code>.${attributes}</p>\n` +
    table(title, ['Key', 'Label', 'Values', 'Default', 'Meaning'], rows)
  );
}

const { sections, aovs } = JSON.parse(execFileSync(options.program, ['list', '--json'], { encoding: 'utf8' }));
const contents = sections.map(({ title }) => `<li><a href="#${idOf(title)}">${escaped(title)}</a></li>`).join('\n');
const content = `<h2>Parameters</h2>
<p class="lead">Every parameter of a scene: its key in scene files and in <code>--set</code>, its label in the panel, what
it may be, and what it does. <a href="element.html#parameters">As attributes</a> keys are in kebab case.</p>
<p>Quantities that <code>view.show</code> and <code>--aov</code> name:
${aovs.map((aov) => `<code>${escaped(aov)}</code>`).join(', ')}.</p>
<ul class="columns">
${contents}
</ul>
${sections.map(sectionOf).join('')}`;
writeFileSync(
  options.out,
  documentOf({
    name: 'parameters.html',
    title: 'parameters',
    source: 'Made by scripts/parameters.mjs of what lucent list prints: change the declarations in the code.',
    content,
  }),
);
