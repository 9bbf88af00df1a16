/** The page of benchmark reports ("lucent-bench-1"): plots, each with its table, and what was promised. */
import { LineChart, ScatterChart } from 'echarts/charts';
import { AriaComponent, GridComponent, LegendComponent, TooltipComponent } from 'echarts/components';
import * as echarts from 'echarts/core';
import { LabelLayout } from 'echarts/features';
import { SVGRenderer } from 'echarts/renderers';

echarts.use([LineChart, ScatterChart, AriaComponent, GridComponent, LegendComponent, TooltipComponent, LabelLayout, SVGRenderer]);

// What does not apply to a report is absent in it.
const kReports = JSON.parse(document.getElementById('reports').textContent).map((report) => ({ measurements: [], scaling: [], hardCases: [], ratios: [], ...report }));
const kDark = matchMedia('(prefers-color-scheme: dark)');
const kMethodOrder = ['hierarchy', 'transfer', 'march', 'counting'];
const kPalette = {
  light: ['#2364c4', '#b4540a', '#177a50', '#8c35a6', '#94700a', '#b3265e', '#4e5864'],
  dark: ['#74aaff', '#f3a860', '#52c795', '#d792ec', '#e0c24f', '#ff8fb3', '#aab3be'],
};
const kSymbols = ['circle', 'triangle', 'diamond', 'rect'];
const kSmallest = 1e-9; // what is 0 is drawn here: a logarithmic axis has no 0
const kErrors = {
  rmse: { label: 'RMSE', of: (e) => e.rmse },
  relRmse: { label: 'RMSE over the mean', of: (e) => e.relRmse },
  p99: { label: '99th percentile', of: (e) => e.p99 },
  max: { label: 'largest difference', of: (e) => e.max },
  flip: { label: 'FLIP', of: (e) => e.flip },
  degrees: { label: 'median angle in degrees', of: (e) => e.degrees?.all.median },
  wrongShare: { label: 'share of wrong texels', of: (e) => e.wrongShare },
  misplaced: { label: 'share of misplaced light', of: (e) => e.flux?.misplaced },
  ssim: { label: '1 - SSIM', of: (e) => (e.ssim == null ? null : 1 - e.ssim) },
};

// --- small things

/** @return an element with attributes and children; text is put in as text */
function element(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children.flat().filter((child) => child != null));
  return node;
}

/** Three digits, with a power of ten where that is shorter; a dash for what is not there. */
function number(value) {
  if (value == null || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e6) return value.toExponential(1);
  return size >= 1000 ? Math.round(value).toLocaleString('en') : String(Number(value.toPrecision(3)));
}

function axisNumber(value) {
  return value >= 1e-3 && value < 1e5 ? Number(value.toPrecision(2)).toLocaleString('en') : value.toExponential(0);
}

const escaped = (text) => String(text).replaceAll('&', '&amp;').replaceAll('<', '&lt;');
const isTimed = (m, which) => m.ms && m[which];
const knobsOf = (m) => Object.entries(m.knobs ?? {}).map(([name, value]) => `${name} ${value}`).join(', ');
const groupBy = (items, key) => Map.groupBy?.(items, key) ?? items.reduce((map, item) => map.set(key(item), [...(map.get(key(item)) ?? []), item]), new Map());

/** A table with a caption; `columns` are {title, cell(row) -> text or node, number?: true}. The first names the row. */
function table(caption, columns, rows) {
  const head = columns.map((column) => element('th', { scope: 'col', class: column.number ? 'number' : '' }, column.title));
  const body = rows.map((row) =>
    element(
      'tr',
      {},
      columns.map((column, i) => element(i ? 'td' : 'th', { ...(i ? {} : { scope: 'row' }), class: column.number ? 'number' : '' }, column.cell(row))),
    ),
  );
  return element(
    'div',
    { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': caption },
    element('table', {}, element('caption', {}, caption), element('thead', {}, element('tr', {}, head)), element('tbody', {}, body)),
  );
}

function fold(title, content) {
  return element('details', {}, element('summary', {}, title), content);
}

// --- plots

const plots = []; // {node, chart, option()}: drawn again when the colours of the system change

const methods = [...new Set([...kMethodOrder, ...kReports.flatMap((report) => report.measurements.map(labelOf))])];
function labelOf(m) {
  return m.technique === 'three.js' || m.technique === 'POV-Ray' ? m.technique : m.method;
}
function colorOf(label) {
  const palette = kDark.matches ? kPalette.dark : kPalette.light;
  return palette[methods.indexOf(label) % palette.length];
}

function inks() {
  const style = getComputedStyle(document.documentElement);
  const probe = document.body.appendChild(element('span'));
  const color = (name) => {
    probe.style.color = style.getPropertyValue(name);
    return getComputedStyle(probe).color;
  };
  const found = { ink: color('--ink'), muted: color('--muted'), line: color('--line'), card: color('--card') };
  probe.remove();
  return found;
}

/** What all plots share: two logarithmic axes, hover, a legend. */
function baseOption(xTitle, yTitle) {
  const { ink, muted, line, card } = inks();
  const axis = (name) => ({
    type: 'log',
    name,
    nameLocation: 'middle',
    nameTextStyle: { color: muted },
    axisLabel: { color: muted, formatter: axisNumber, hideOverlap: true },
    axisLine: { show: true, lineStyle: { color: muted } },
    splitLine: { lineStyle: { color: line } },
    minorSplitLine: { show: false },
  });
  return {
    animation: false,
    aria: { enabled: true },
    textStyle: { color: ink, fontFamily: 'inherit' },
    grid: { left: 74, right: 18, top: 44, bottom: 52 },
    legend: { top: 4, itemGap: 20, textStyle: { color: ink }, icon: 'circle', type: 'plain' },
    tooltip: { backgroundColor: card, borderColor: line, textStyle: { color: ink, fontSize: 13 }, confine: true },
    xAxis: { ...axis(xTitle), nameGap: 30 },
    yAxis: { ...axis(yTitle), nameGap: 56 },
  };
}

function plot(caption, option) {
  const node = element('div', { class: 'plot' });
  plots.push({ node, option });
  return element('figure', {}, node, element('figcaption', {}, caption));
}

function drawPlots() {
  for (const one of plots) {
    one.chart ??= echarts.init(one.node, null, { renderer: 'svg' });
    one.chart.setOption(one.option(), true);
  }
}

/** Points that no other beats in both time and error. */
function front(points) {
  const beats = ([x, y], [u, v]) => x <= u && y <= v && (x < u || y < v);
  return points.filter((one) => !points.some((other) => beats(other.value, one.value))).sort((a, b) => a.value[0] - b.value[0]);
}

function angles(where, { median, p95, p99, lost }) {
  return `${where}: half within ${number(median)}°, 95 % within ${number(p95)}°, 99 % within ${number(p99)}°, ${number(100 * lost)} % lost`;
}

function hover(m) {
  const lines = [
    `<b>${escaped(labelOf(m))}</b> ${escaped(knobsOf(m))}`,
    `${number(m.ms.median)} ms (${number(m.ms.low)} to ${number(m.ms.high)}, ${m.ms.repeats} times)`,
    m.bakeMs == null ? null : `prepared in ${number(m.bakeMs)} ms`,
  ];
  if (m.error?.wrongShare != null) lines.push(`${number(100 * m.error.wrongShare)} % of the texels wrong`);
  if (m.error?.flux) lines.push(`${number(100 * m.error.flux.misplaced)} % of the light misplaced, ${number(100 * m.error.flux.byNoise)} % by the noise of the truth`);
  if (m.error?.degrees) lines.push(angles('everywhere', m.error.degrees.all), angles('away from silhouettes', m.error.degrees.inside));
  else if (m.error?.rmse != null) lines.push(`RMSE ${number(m.error.rmse)}, ${number(m.error.relRmse)} of the mean`, `99 % within ${number(m.error.p99)}, all within ${number(m.error.max)}`);
  if (m.error?.flip != null) lines.push(`FLIP ${number(m.error.flip)}, SSIM ${number(m.error.ssim)}`);
  if (m.modelError?.rmse != null) lines.push(`model error ${number(m.modelError.rmse)}`);
  lines.push(m.passes == null ? null : `${m.passes} passes, ${m.draws} draws, ${number(m.bytes / 1e6)} MB`, escaped(m.report));
  return lines.filter(Boolean).join('<br>');
}

/**
 * Time against an error of the measurements of one case.
 * @param which  'error' or 'modelError'
 */
function timeAgainst(which, measurements, metric, withFront) {
  // Peers do not know every error: where the chosen one is missing the first that is there stands in.
  const known = [metric, ...Object.keys(kErrors)].find((key) => measurements.some((m) => isTimed(m, which) && kErrors[key].of(m[which]) != null));
  const { label, of } = kErrors[known];
  const points = measurements
    .filter((m) => isTimed(m, which) && of(m[which]) != null)
    .map((m) => ({ value: [m.ms.median, Math.max(kSmallest, of(m[which]))], m }));
  const best = new Set([...groupBy(points, ({ m }) => m.report).values()].flatMap(front));
  const option = baseOption('milliseconds', which === 'error' ? label : `${label} against the physics`);
  option.tooltip.formatter = ({ data }) => (data.m ? hover(data.m) : '');
  option.series = [...groupBy(points, ({ m }) => labelOf(m))].map(([name, list]) => ({
    name,
    type: 'scatter',
    color: colorOf(name),
    symbolSize: 12,
    label: { show: true, position: 'right', color: inks().muted, fontSize: 11, formatter: ({ data }) => Object.values(data.m.knobs ?? {}).join(' ') },
    labelLayout: { hideOverlap: true },
    data: list.map((point) => ({
      ...point,
      symbol: kSymbols[point.m.reportIndex % kSymbols.length],
      itemStyle: withFront && !best.has(point) ? { color: 'transparent', borderColor: colorOf(name), borderWidth: 2 } : {},
    })),
  }));
  if (withFront)
    for (const list of groupBy([...best], ({ m }) => m.report).values())
      option.series.push({ type: 'line', data: list.map(({ value }) => value).sort((a, b) => a[0] - b[0]), symbol: 'none', silent: true, color: inks().muted, lineStyle: { width: 1, type: 'dashed' }, tooltip: { show: false } });
  return option;
}

// --- sections

function heading(title, note) {
  return [element('h2', {}, title), note ? element('p', { class: 'note' }, note) : null];
}

function machineCards() {
  const cards = kReports.map((report, i) => {
    const { machine } = report;
    const facts = {
      runs: machine.where === 'browser' ? `in ${machine.browser ?? 'a browser'}` : 'natively',
      driver: [machine.driver, machine.version].filter(Boolean).join(', '),
      processor: [machine.cpu, machine.cores && `${machine.cores} cores`, machine.memoryMB && `${number(machine.memoryMB / 1024)} GB`].filter(Boolean).join(', '),
      commit: report.commit,
      date: report.date,
      times: report.timing === 'gpu-timer' ? 'GPU timer queries' : 'finished frames: draw and read one pixel back (a query on this driver would time submission only)',
      memory: report.memory ? `${number(report.memory.contextMB)} MB with a context alone, ${number(report.memory.peakMB)} MB with a relief` : null,
      size: report.quick ? 'quick: small scenes, few repeats' : 'whole',
    };
    const list = Object.entries(facts).filter(([, value]) => value).flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]);
    return element('section', { class: 'card' }, element('h3', {}, nameOf(report, i)), element('dl', {}, list));
  });
  return element('div', { class: 'grid' }, cards);
}

function nameOf(report, index) {
  const place = report.machine.where === 'browser' ? 'Browser' : 'Native';
  return `${kReports.length > 1 ? `${index + 1}. ` : ''}${place}, ${report.machine.driver.replace(/\s*\(.*/, '')}`;
}

function promises() {
  const rows = kReports.flatMap((report, i) => report.ratios.map((ratio) => ({ ...ratio, report: nameOf(report, i) })));
  if (!rows.length) return [];
  const verdict = ({ met }) => (met == null ? '' : element('span', { class: met ? 'good' : 'bad' }, met ? '✓ met' : '✗ missed'));
  const columns = [
    { title: 'Figure', cell: (r) => r.name },
    { title: 'Value', number: true, cell: (r) => number(r.value) },
    { title: 'Target', number: true, cell: (r) => (r.target == null ? '' : `${r.atLeast ? '≥' : '≤'} ${number(r.target)}`) },
    { title: 'Verdict', cell: verdict },
  ];
  if (kReports.length > 1) columns.push({ title: 'Where', cell: (r) => r.report });
  return [...heading('What was promised'), element('div', { class: 'card' }, table('Figures with their targets', columns, rows))];
}

const kAngleColumns = [
  ['all', ''],
  ['inside', ', inside'],
].flatMap(([part, where]) => [
  { title: `degrees${where}`, number: true, cell: (m) => number(m.error?.degrees?.[part].median) },
  { title: `95 %${where}`, number: true, cell: (m) => number(m.error?.degrees?.[part].p95) },
  { title: `99 %${where}`, number: true, cell: (m) => number(m.error?.degrees?.[part].p99) },
  { title: `lost %${where}`, number: true, cell: (m) => number(m.error?.degrees && 100 * m.error.degrees[part].lost) },
]);

function measurementTable(title, measurements) {
  const error = (key) => (m) => number(m.error?.[key]);
  const noisy = (m) => m.error && m.truthNoise > 0 && m.error.rmse < 3 * m.truthNoise;
  return table(
    title,
    [
      { title: 'Method', cell: (m) => labelOf(m) },
      { title: 'Knobs', cell: (m) => knobsOf(m) || '–' },
      { title: 'ms', number: true, cell: (m) => number(m.ms?.median) },
      { title: 'from', number: true, cell: (m) => number(m.ms?.low) },
      { title: 'to', number: true, cell: (m) => number(m.ms?.high) },
      { title: 'prepare ms', number: true, cell: (m) => number(m.bakeMs) },
      { title: 'RMSE', number: true, cell: (m) => number(m.error?.rmse) + (noisy(m) ? ' ≈' : '') },
      { title: 'over mean', number: true, cell: error('relRmse') },
      { title: '99 %', number: true, cell: error('p99') },
      { title: 'max', number: true, cell: error('max') },
      ...(measurements.some((m) => m.error?.degrees) ? kAngleColumns : []),
      ...(measurements.some((m) => m.error?.flux) ? [{ title: 'misplaced %', number: true, cell: (m) => number(m.error?.flux && 100 * m.error.flux.misplaced) }] : []),
      ...(measurements.some((m) => m.error?.wrongShare != null) ? [{ title: 'wrong texels', number: true, cell: error('wrongShare') }] : []),
      { title: 'FLIP', number: true, cell: error('flip') },
      { title: 'SSIM', number: true, cell: (m) => m.error?.ssim?.toFixed(5) ?? '–' },
      { title: 'model RMSE', number: true, cell: (m) => number(m.modelError?.rmse) },
      { title: 'truth ±', number: true, cell: (m) => number(m.truthNoise) },
      { title: 'lights', number: true, cell: (m) => number(m.lights) },
      { title: 'passes', number: true, cell: (m) => number(m.passes) },
      { title: 'draws', number: true, cell: (m) => number(m.draws) },
      { title: 'MB', number: true, cell: (m) => number(m.bytes == null ? null : m.bytes / 1e6) },
      { title: 'front', cell: (m) => (m.pareto ? 'yes' : '') },
      ...(kReports.length > 1 ? [{ title: 'Where', cell: (m) => m.report }] : []),
      ...(measurements.some((m) => m.refused) ? [{ title: 'Refused', cell: (m) => element('div', { class: 'message bad' }, m.refused ?? '') }] : []),
    ],
    measurements,
  );
}

function cases(metric) {
  const all = kReports.flatMap((report, i) => report.measurements.map((m) => ({ ...m, report: nameOf(report, i), reportIndex: i })));
  if (!all.length) return [];
  const choice = element('select', { id: 'metric' }, Object.entries(kErrors).map(([key, { label }]) => element('option', { value: key }, label)));
  choice.addEventListener('change', () => {
    metric.name = choice.value;
    drawPlots();
  });
  const groups = [...groupBy(all, (m) => `${m.scene}, ${m.width} x ${m.height}`)];
  const cards = groups.map(([title, list]) => {
    const figures = [];
    if (list.some((m) => isTimed(m, 'error'))) figures.push(plot('Method error: against the same model solved exactly. Filled points on the dashed line are the Pareto front: nothing else is quicker and nearer at once.', () => timeAgainst('error', list, metric.name, true)));
    if (list.some((m) => isTimed(m, 'modelError'))) figures.push(plot('Model error: against the physics, or, for a method with a model of its own, against ours. More work does not make it smaller.', () => timeAgainst('modelError', list, metric.name, false)));
    return element('section', { class: 'card' }, element('h3', {}, title), element('div', { class: 'pair' }, figures), fold('Table', measurementTable(`Measurements: ${title}`, list)));
  });
  return [
    ...heading('Time against error', 'Both axes are logarithmic; lower and farther left is better. Times are those of the picture less the same picture without light, or, of refraction, without the glass; its errors away from silhouettes are those inside. Hover a point for its knobs and figures; click a name in the legend to hide a method. ≈ in a table: the error is within three times the exact solution’s own.'),
    element('div', { class: 'bar' }, element('label', { for: 'metric' }, 'Error shown'), choice),
    ...cards,
  ];
}

function costs() {
  const all = kReports.flatMap((report, i) => report.scaling.map((series) => ({ ...series, label: kReports.length > 1 ? `${series.method} (${nameOf(report, i)})` : series.method })));
  const groups = [...groupBy(all.filter(({ points }) => points.length), ({ over }) => over)];
  if (!groups.length) return [];
  const cards = groups.map(([over, list]) => {
    const option = () => {
      const base = baseOption(over, 'milliseconds');
      base.tooltip.formatter = ({ seriesName, value }) => `<b>${escaped(seriesName)}</b><br>${number(value[0])} ${over}<br>${number(value[1])} ms`;
      base.series = list.map((series) => ({ name: `${series.label}: ${over}^${number(series.exponent)}`, type: 'line', symbol: 'circle', symbolSize: 9, color: colorOf(series.method), data: series.points.map(({ x, ms }) => [x, ms]) }));
      return base;
    };
    const rows = list.flatMap((series) => series.points.map((point) => ({ ...point, series })));
    const columns = [
      { title: 'Method', cell: (r) => r.series.label },
      { title: over, number: true, cell: (r) => number(r.x) },
      { title: 'ms', number: true, cell: (r) => number(r.ms) },
      { title: `ns for one of ${over}`, number: true, cell: (r) => number((r.ms * 1e6) / r.x) },
    ];
    return element('section', { class: 'card' }, element('h3', {}, `Over ${over}`), plot(`Fitted exponent: ${list.map((s) => `${s.label} ${number(s.exponent)}`).join(', ')}. 1 is linear, 0 is free.`, option), fold('Table', table(`Time over ${over}`, columns, rows)));
  });
  return [...heading('Cost against size'), element('div', { class: 'pair' }, cards)];
}

function hardCell(result) {
  if (!result) return '';
  if (result.status === 'refused') return element('div', { class: 'message' }, `refused: ${result.message}`);
  const passed = result.status === 'pass';
  return element('div', { class: passed ? 'good' : 'message bad' }, `${passed ? '✓ pass' : '✗ error'} ${result.message ?? number(result.error)}`);
}

function hardCases() {
  const sections = kReports.map((report, i) => {
    if (!report.hardCases.length) return null;
    const columns = [...new Set(report.hardCases.map(({ method }) => method))];
    const rows = [...groupBy(report.hardCases, ({ name }) => name)];
    return element('section', { class: 'card' }, table(nameOf(report, i), [
      { title: 'Case', cell: ([name]) => name },
      ...columns.map((method) => ({ title: method, cell: ([, results]) => hardCell(results.find((r) => r.method === method)) })),
    ], rows));
  }).filter(Boolean);
  if (!sections.length) return [];
  return [...heading('Hard cases', 'Pass: every value is finite and 99 % of the pixels are within one step of an 8-bit display (1/255) of the exact solution; the figure is the RMSE. What cannot have a picture is refused with a message.'), ...sections];
}

function show() {
  const main = document.querySelector('main');
  if (!kReports.length) {
    main.append(element('p', {}, 'No report is in this page; lucent bench and lucent report put them in.'));
    return;
  }
  const metric = { name: 'rmse' };
  const parts = [machineCards(), promises(), cases(metric), costs(), hardCases()];
  main.append(...parts.flat().filter((part) => part != null));
  drawPlots();
  kDark.addEventListener('change', drawPlots);
  addEventListener('resize', () => plots.forEach(({ chart }) => chart.resize()));
}

show();
