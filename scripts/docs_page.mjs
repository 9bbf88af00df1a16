/** What scripts that make pages of web/docs share: their frame, tables, escaping. */
import { readFileSync } from 'node:fs';
import { dirname, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

export const kDocs = resolve(dirname(fileURLToPath(import.meta.url)), '../web/docs');
const kEntities = { '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' };

/** Text as HTML; a percent sign stays with its number. */
export const escaped = (text) =>
  String(text)
    .replace(/[&<>"]/g, (sign) => kEntities[sign])
    .replaceAll(' %', '\u00a0%');

/** Text as the id of a heading. */
export const idOf = (text) =>
  text
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, '-')
    .replace(/^-|-$/g, '');

/** @param rows  cells as HTML; the first of a row names it */
export function table(caption, columns, rows) {
  const head = columns.map((column) => `<th scope="col">${escaped(column)}</th>`).join('');
  const cellsOf = (cells) => cells.map((cell) => `<td>${cell}</td>`).join('');
  const body = rows.map(([name, ...cells]) => `<tr><th scope="row">${name}</th>${cellsOf(cells)}</tr>`);
  const label = escaped(caption);
  return (
    `<div class="scroll" tabindex="0" role="region" aria-label="${label}">\n<table>\n<caption>${label}</caption>\n` +
    `<thead><tr>${head}</tr></thead>\n<tbody>\n${body.join('\n')}\n</tbody>\n</table>\n</div>\n`
  );
}

/** The navigation of the overview with another page marked: there is one text of it. */
function headerOf(name) {
  const header = readFileSync(resolve(kDocs, 'index.html'), 'utf8').match(/<header>.*?<\/header>/s)[0];
  return header.replace(' aria-current="page"', '').replace(`href="${name}"`, `href="${name}" aria-current="page"`);
}

/**
 * A whole page.
 * @param name     of its file
 * @param source   what it is made of, for whoever opens the file to change it
 * @param content  HTML
 */
export function documentOf({ name, title, source, content }) {
  return `<!doctype html>
<!-- ${source} -->
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Lucent: ${escaped(title)}</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="../page.css">
<link rel="stylesheet" href="docs.css">
</head>
<body>
${headerOf(name)}
<main>
<article>
${content}</article>
</main>
</body>
</html>
`;
}
