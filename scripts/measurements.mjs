/**
 * Makes web/docs/measurements.html, the page of measurements, of what benchmarks wrote.
 *
 *   node scripts/measurements.mjs [NAME=]PATH... [--shared] [--drop NAME]
 *   node scripts/measurements.mjs            only the page, of what is kept
 *   node scripts/measurements.mjs --check    ends with 1 where the page is not what the kept figures make
 *
 * PATH      a folder that `lucent bench` wrote (bench.json, and compose.json or budget.json beside it), or a report of
 *           the page or of a peer ("lucent-bench-1"). NAME is what was measured (relief, refraction, caustics,
 *           subsurface, budget, budget-glass, compose, page, ...), else the name of the folder or file.
 * --shared  other work ran on the machine: times are left out
 * --drop    forgets the runs of that name
 *
 * A digest of each run is kept in web/docs/data/runs.json and takes the place of the last one with the same name and
 * driver. What was measured by hand or before this page stands in web/docs/data/statements.json, dated.
 */
import { existsSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { parseArgs } from 'node:util';
import { documentOf, escaped, idOf, kDocs, table } from './docs_page.mjs';

const kRuns = join(kDocs, 'data/runs.json');
const kStatements = join(kDocs, 'data/statements.json');
const kPage = join(kDocs, 'measurements.html');

// Headings in the order of the page; runs of other names follow under their own.
const kTopics = {
  relief: 'Light on height fields',
  environment: 'Environments',
  budget: 'Error budget',
  refraction: 'Refraction',
  caustics: 'Caustics',
  subsurface: 'Subsurface scattering',
  throughput: 'Precomputed throughput',
  displacement: 'Displaced surfaces',
  compose: 'Every lamp, by way of every object, onto every receiver',
  page: 'The page',
};
// Runs whose names are not topics.
const kTopicOf = {
  hard: 'relief',
  scaling: 'relief',
  gpu: 'relief',
  three: 'relief',
  povray: 'relief',
  'budget-glass': 'budget',
  translucency: 'subsurface',
  textured: 'page',
  web: 'page',
};
// Figures that are times or ratios of times, by their names in the benches of src and in scripts/peers.
const kIsTime = /\btimes?\b|\bms\b|against march|cost of a texel|over that at|transfer against|frames? per/i;
const kShort = 16; // characters
const kFluxTolerance = 0.01; // of a cell of the matrix, as src/measure/Compose.h has it

const fail = (message) => {
  console.error(`measurements: ${message}`);
  process.exit(1);
};

// --- reading

function readJson(path) {
  try {
    return JSON.parse(readFileSync(path, 'utf8'));
  } catch (error) {
    return fail(`${path}: ${error.message}`);
  }
}

const driverOf = ({ driver }) => driver.replace(/^ANGLE \([^,]*, /, '').replace(/\s*\(.*/, '');

/** "build/bench-web-llvmpipe.json" -> "web", "build/bench/caustics" -> "caustics" */
const nameOf = (path) =>
  basename(path)
    .replace(/\.json$/, '')
    .replace(/^bench-(?=.)/, '')
    .replace(/-(llvmpipe|swiftshader)$/, '');

/** What the page keeps of a report. @param shared  times count for nothing */
function digest(name, report, folder, shared) {
  if (report.format !== 'lucent-bench-1')
    fail(`${name}: format is ${JSON.stringify(report.format)}; must be "lucent-bench-1"`);
  const error = ({ degrees, flux, rmse, relRmse }) => {
    if (degrees) return { degrees: degrees.all };
    return flux ? { misplaced: flux.misplaced, byNoise: flux.byNoise } : { rmse, relRmse };
  };
  const settings = (report.measurements ?? []).map((m) => ({
    scene: m.scene,
    method: [m.method, ...Object.entries(m.knobs ?? {}).map(([knob, value]) => `${knob} ${value}`)].join(', '),
    size: m.width ? `${m.width}×${m.height}` : '',
    ...(m.ms && !shared ? { ms: m.ms.median } : {}),
    ...(m.error ? { error: error(m.error) } : {}),
    ...(m.modelError ? { modelError: error(m.modelError) } : {}),
    ...(m.refused ? { refused: m.refused } : {}),
  }));
  const hard = {};
  for (const { method, status } of report.hardCases ?? []) {
    hard[method] ??= { pass: 0, error: 0, refused: 0 };
    hard[method][status] += 1;
  }
  const wrong = (report.hardCases ?? [])
    .filter(({ status }) => status === 'error')
    .map(({ method, name: which, error: by }) => ({ method, name: which, error: by }));
  // Every run says what memory a relief takes: it counts once.
  const isOwn = (ratio) => name === 'relief' || !ratio.name.startsWith('MB resident');
  const figures = (report.ratios ?? []).filter((ratio) => isOwn(ratio) && (!shared || !kIsTime.test(ratio.name)));
  const compose = join(folder, 'compose.json');
  return {
    name,
    date: report.date,
    commit: report.commit,
    quick: Boolean(report.quick),
    ...(shared ? { shared } : {}),
    machine: report.machine,
    figures,
    ...(settings.length ? { settings } : {}),
    ...(Object.keys(hard).length ? { hard, wrong } : {}),
    ...(folder && existsSync(compose) ? { compose: readJson(compose).cells.map(({ seconds, ...cell }) => cell) } : {}),
  };
}

function readRun(text, shared) {
  const split = text.indexOf('=');
  const path = text.slice(split + 1);
  const name = split < 0 ? nameOf(path) : text.slice(0, split);
  if (!existsSync(path)) fail(`${path}: is not there; must be a folder of lucent bench, or a report`);
  const isFolder = statSync(path).isDirectory();
  return digest(name, readJson(isFolder ? join(path, 'bench.json') : path), isFolder ? path : '', shared);
}

// --- text

/** Three digits, with a power of ten where that is shorter. */
function number(value) {
  if (value == null || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e6) return value.toExponential(1);
  return size >= 1000 ? Math.round(value).toLocaleString('en') : String(Number(value.toPrecision(3)));
}
const percent = (share) => `${number(100 * share)}\u00a0%`;

const verdict = (met, text) => `<span class="${met ? 'met' : 'missed'}">${text}</span>`;
const verdictOf = (met) => (met == null ? '' : verdict(met, met ? '✓ met' : '✗ missed'));

// --- sections

function machineText({ machine, date, commit, quick, shared }) {
  const where = machine.where === 'browser' ? `in a browser (${machine.browser})` : '';
  const parts = [
    machine.cpu,
    machine.cores && `${machine.cores} cores`,
    machine.driver,
    machine.version,
    where,
    `commit ${commit}`,
    quick && 'quick: small scenes, few repeats',
    shared && 'other work ran beside it: times are left out',
  ];
  return `${date}: ${parts.filter(Boolean).join('; ')}`;
}

function errorText(error) {
  if (!error) return '';
  if (error.degrees) {
    const { median, p95, p99, lost } = error.degrees;
    return `median ${number(median)}°, 95 % ${number(p95)}°, 99 % ${number(p99)}°, lost ${percent(lost)}`;
  }
  if (error.misplaced != null) return `misplaced ${percent(error.misplaced)} (noise ${percent(error.byNoise)})`;
  return `RMSE ${number(error.rmse)}, ${number(error.relRmse)} of the mean`;
}

const folded = (summary, content) => `<details>\n<summary>${escaped(summary)}</summary>\n${content}</details>\n`;

/** What has a target stands open, the rest folded away. */
function figuresTable(run) {
  const columns = ['Figure', 'Measured', 'Target', 'Verdict'];
  const aim = ({ target, atLeast }) =>
    target == null ? '' : `at\u00a0${atLeast ? 'least' : 'most'}\u00a0${Number(target.toPrecision(4))}`;
  const nameOfFigure = ({ name }) => escaped(name.replaceAll('^2', '²'));
  const rowOf = (figure) => [nameOfFigure(figure), number(figure.value), aim(figure), verdictOf(figure.met)];
  const aimed = run.figures.filter(({ target }) => target != null).map(rowOf);
  const others = run.figures.filter(({ target }) => target == null).map((figure) => rowOf(figure).slice(0, 2));
  return (
    (aimed.length ? table(`Figures of ${run.name} with their targets`, columns, aimed) : '') +
    (others.length
      ? folded(
          `${others.length} figures without a target`,
          table(`Figures of ${run.name} without a target`, columns.slice(0, 2), others),
        )
      : '')
  );
}

function settingsTable(run) {
  if (!run.settings) return '';
  const timed = run.settings.some(({ ms }) => ms != null);
  const physics = run.settings.some(({ modelError }) => modelError);
  const columns = ['Scene', 'Method', 'Size', ...(timed ? ['ms'] : []), 'Error against the model'];
  if (physics) columns.push('Error against the physics');
  const rows = run.settings.map((s) => [
    escaped(s.scene),
    escaped(s.method),
    s.size,
    ...(timed ? [number(s.ms)] : []),
    s.refused ? `refused: ${escaped(s.refused)}` : errorText(s.error),
    ...(physics ? [errorText(s.modelError)] : []),
  ]);
  return folded(`All ${rows.length} settings`, table(`Settings of ${run.name}`, columns, rows));
}

function hardTable(run) {
  if (!run.hard) return '';
  const rowOf = ([method, { pass, error, refused }]) => [escaped(method), pass, error, refused];
  const rows = Object.entries(run.hard).map(rowOf);
  const wrong = run.wrong.map(({ method, name, error }) => [escaped(name), escaped(method), number(error)]);
  return (
    table('Hard cases, by what became of them', ['Method', 'pass', 'with an error', 'refused with a message'], rows) +
    (wrong.length
      ? folded(`${wrong.length} with an error`, table('Hard cases with an error', ['Case', 'Method', 'RMSE'], wrong))
      : '')
  );
}

const isMeasured = (cell) => cell.misplaced != null;

function composeTables(run) {
  if (!run.compose) return '';
  const measured = run.compose.filter(isMeasured);
  const met = measured.filter((cell) => cell.met).length;
  const reasons = [...new Set(run.compose.filter((cell) => cell.notDrawn).map((cell) => cell.notDrawn))];
  const receivers = [...new Set(run.compose.map(({ receiver }) => receiver))];
  const lamps = [...new Set(run.compose.map(({ lamp }) => lamp))];
  const cellText = (cell) => {
    if (!cell) return '';
    if (cell.notDrawn) return 'not drawn';
    if (!isMeasured(cell)) return cell.message ? `refused: ${escaped(cell.message)}` : verdict(false, 'no figure ✗');
    const flux = Math.abs(cell.flux - 1) > kFluxTolerance ? ` flux ${cell.flux.toFixed(3)}` : '';
    const text = `${(100 * cell.misplaced).toFixed(2)}\u00a0%`;
    return verdict(cell.met, cell.met ? text : `${text} ✗${flux}`);
  };
  const tables = lamps.map((lamp) => {
    const cells = run.compose.filter((cell) => cell.lamp === lamp);
    const at = (between, receiver) => cells.find((cell) => cell.between === between && cell.receiver === receiver);
    const rows = [...new Set(cells.map(({ between }) => between))].map((between) => [
      escaped(between),
      ...receivers.map((receiver) => cellText(at(between, receiver))),
    ]);
    const caption = `Misplaced light of lamp "${lamp}": what stands between (rows) and what receives (columns)`;
    return table(caption, ['', ...receivers], rows);
  });
  return (
    `<p>${measured.length} of ${run.compose.length} cells are drawn, ${met} of them within their target: at most 1 % of ` +
    'the light misplaced, 2 % by way of glass, mirrors or water, 3 % on what scatters, and the whole flux within 1 %. ' +
    'A cross marks those that miss one of the two.</p>\n' +
    (reasons.length ? `<p>Not drawn: ${reasons.map(escaped).join('; ')}.</p>\n` : '') +
    tables.join('')
  );
}

/** What ran, as a heading: reports of the browser are the page's own sweep or a peer's. */
function titleOf({ name, machine }) {
  const driver = driverOf(machine);
  if (name === 'web') return `Sweep in the page, ${driver}`;
  if (machine.where === 'browser' || name === 'povray') return `Beside other renderers: ${name}, ${driver}`;
  return `lucent bench ${name}, ${driver}`;
}

function runSection(run) {
  const title = titleOf(run);
  return (
    `<h3 id="${idOf(title)}">${escaped(title)}</h3>\n` +
    `<p class="source">${escaped(machineText(run))}</p>\n` +
    figuresTable(run) +
    composeTables(run) +
    hardTable(run) +
    settingsTable(run)
  );
}

/** A cell that is not broken where it is short. */
const whole = (text) => (text.length > kShort ? escaped(text) : escaped(text).replaceAll(' ', '\u00a0'));

function statementSection({ title, date, commit, machine, source, note, columns, rows, figures, after, picture }) {
  const where = `${date}: ${machine}${commit ? `; commit ${commit}` : ''}. ${source}`;
  const cells = (figures ?? []).map(([figure, value, target, held]) => [
    escaped(figure),
    whole(value),
    whole(target ?? ''),
    verdictOf(held && held === 'met'),
  ]);
  const image = picture && `<img src="${picture.file}" alt="${escaped(picture.alt)}">`;
  return (
    `<h3 id="${idOf(title)}">${escaped(title)}</h3>\n<p class="source">${escaped(where)}</p>\n` +
    (note ? `<p>${escaped(note)}</p>\n` : '') +
    (rows ? table(title, columns, rows.map((row) => row.map(escaped))) : '') +
    (cells.length ? table(`${title}: figures`, ['Figure', 'Measured', 'Target', 'Verdict'], cells) : '') +
    (picture ? `<figure>\n${image}\n<figcaption>${escaped(picture.caption)}</figcaption>\n</figure>\n` : '') +
    (after ? `<p>${escaped(after)}</p>\n` : '')
  );
}

function pageOf(runs, statements) {
  const topicOf = (name) => (kTopics[name] ? name : (kTopicOf[name] ?? name));
  const topics = [...new Set([...Object.keys(kTopics), ...runs.map(({ name }) => topicOf(name))])];
  const sections = topics
    .map((topic) => ({
      topic,
      title: kTopics[topic] ?? topic,
      body: [
        ...runs.filter(({ name }) => topicOf(name) === topic).map(runSection),
        ...statements.filter((one) => one.topic === topic).map(statementSection),
      ].join(''),
    }))
    .filter(({ body }) => body);
  const contents = sections.map(({ topic, title }) => `<li><a href="#${topic}">${escaped(title)}</a></li>`).join('\n');
  const content = `<h2>Measurements</h2>
<p class="lead">Speed and error of every method, with the target each figure was held against, the machine it was measured
on, and the date.</p>
<p>Sections that name a <code>lucent bench</code> run are made of the JSON which that run wrote; <code>scripts/bench
--page</code> measures all of them again and makes this page anew. The other sections were measured on the day that they
name and are kept until a run replaces them. Errors are distances from the same model solved in double precision
(<a href="model.html#truth">truth</a>), unless they say against the physics. Missed targets stay on the page.</p>
<ul>
${contents}
</ul>
${sections.map(({ topic, title, body }) => `<h2 id="${topic}">${escaped(title)}</h2>\n${body}`).join('')}`;
  return documentOf({
    name: 'measurements.html',
    title: 'measurements',
    source: 'Made by scripts/measurements.mjs of data/runs.json and data/statements.json: change those, or the script.',
    content,
  });
}

// --- the command

const { values: options, positionals } = parseArgs({
  options: {
    shared: { type: 'boolean' },
    check: { type: 'boolean' },
    drop: { type: 'string', multiple: true, default: [] },
  },
  allowPositionals: true,
});
let { runs } = existsSync(kRuns) ? readJson(kRuns) : { runs: [] };
const keyOf = (run) => `${run.name}, ${run.machine.where}, ${driverOf(run.machine)}`;
for (const text of positionals) {
  const run = readRun(text, options.shared);
  runs = [...runs.filter((other) => keyOf(other) !== keyOf(run)), run];
}
runs = runs.filter(({ name }) => !options.drop.includes(name)).sort((a, b) => (keyOf(a) < keyOf(b) ? -1 : 1));
const page = pageOf(runs, readJson(kStatements).statements);
if (options.check) {
  if (readFileSync(kPage, 'utf8') !== page)
    fail('web/docs/measurements.html is not what web/docs/data makes; node scripts/measurements.mjs makes it');
} else {
  writeFileSync(kRuns, JSON.stringify({ format: 'lucent-measurements-1', runs }, null, 1) + '\n');
  writeFileSync(kPage, page);
  console.log(`measurements: ${runs.length} runs and the dated statements make web/docs/measurements.html`);
}
