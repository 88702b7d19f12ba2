import { plot } from './charts.js';
import { element, number, percent, significant, table, whole } from './numbers.js';

const byId = (id) => document.getElementById(id);

/// Seconds after each cycle since the beginning, by cycle; empty without a timing.json.
function secondsAfter(timing) {
  const after = new Map();
  let sum = 0;
  for (const { cycle, seconds } of timing?.cycles ?? []) {
    for (const part of Object.values(seconds ?? {})) sum += part;
    after.set(cycle, sum);
  }
  return after;
}

function showHead({ run, timing }) {
  const last = run.cycles[run.cycles.length - 1];
  byId('title').textContent = run.scene.file;
  byId('subtitle').textContent = `${whole(run.scene.surfaces)} surfaces, ${significant(run.scene.area)} m², `
    + `${run.scene.closed ? 'closed' : 'open'} · ${run.cycles.length} cycles · ${run.status}`;
  const facts = [['Elements', whole(last.elements)], ['Estimated error', percent(last.estimated_error)]];
  if (timing?.seconds?.total !== undefined) facts.push(['Seconds', significant(timing.seconds.total, 3)]);
  for (const [name, value] of facts) {
    const fact = element('div');
    fact.append(element('dt', name), element('dd', value));
    byId('facts').append(fact);
  }
}

function showCycles({ run, timing }) {
  const after = secondsAfter(timing);
  const uniform = (c) => c.stage !== 'adaptive' && c.stage !== 'final';
  const points = run.cycles.map((c) => ({ x: c.elements, error: c.estimated_error, uniform: uniform(c) }));
  plot(byId('chart-elements'), 'elements', points);
  const timed = run.cycles.map((c, i) => ({ ...points[i], x: after.get(c.cycle) ?? 0 }));
  if (!plot(byId('chart-seconds'), 'seconds', timed)) byId('figure-seconds').hidden = true;
  const rows = run.cycles.map((c) => [String(c.cycle), c.stage, number(c.elements, 15), number(c.vertices, 15), number(c.rays, 4),
    number(100 * c.estimated_error, 3), number(after.get(c.cycle) ?? NaN, 3)]);
  byId('cycles').append(table(rows, ['Cycle', 'Stage', 'Elements', 'Vertices', 'Rays', 'Error, %', 'Seconds so far']));
}

function showEnergy({ run }) {
  const { emitted, absorbed, escaped, relative_residual: rest } = run.cycles[run.cycles.length - 1].energy;
  const row = (name, watts) => [name, number(watts, 6), emitted > 0 ? percent(watts / emitted) : '–'];
  byId('energy').append(table([row('Emitted', emitted), row('Absorbed', absorbed), row('Escaped', escaped),
    ['Not accounted for', '', percent(rest)]], ['', 'W', 'Share']));
}

function showSource({ run, timing }) {
  const rows = [['Program', `${run.tool.name} ${run.tool.version} (${run.tool.commit})`], ['Scene file', run.scene.file],
    ['SHA-256 of the file', run.scene.sha256], ['SHA-256 of what was read', run.scene.content_sha256],
    ['Seed', String(run.seed)]];
  if (timing?.threads) rows.push(['Threads', `${timing.threads}, ${timing.instruction_set ?? ''}`]);
  for (const warning of run.warnings ?? []) rows.push(['Warning', warning]);
  byId('source').append(table(rows));
}

const textOf = (value) => {
  if (Array.isArray(value)) return value.length > 0 ? value.map(textOf).join(', ') : 'none';
  if (typeof value === 'number') return significant(value, 15);
  return value === null ? 'none' : String(value);
};

/// Nested options as rows "solve.meshing.max_edge".
function flattened(value, name = '') {
  if (value !== null && typeof value === 'object' && !Array.isArray(value)) {
    return Object.entries(value).flatMap(([key, inner]) => flattened(inner, name ? `${name}.${key}` : key));
  }
  return [[name, textOf(value)]];
}

/// Everything in the page that is text and numbers.
export function showNumbers(description) {
  showHead(description);
  showCycles(description);
  showEnergy(description);
  showSource(description);
  byId('options').append(table(flattened(description.run.options)));
}
