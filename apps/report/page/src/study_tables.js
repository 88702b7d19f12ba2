import { element, number, percent, significant, table as tableOf, whole } from './numbers.js';

const byId = (id) => document.getElementById(id);
const share = (value) => (value === null || value === undefined ? { text: '–', exact: '' } : number(100 * value, 3));

/// What a head sorts by: numbers as numbers, texts by their letters, what isn't there last.
function compare(a, b) {
  if (a === '' || b === '') return (a === '') - (b === '');
  const [x, y] = [Number(a), Number(b)];
  return Number.isNaN(x) || Number.isNaN(y) ? String(a).localeCompare(String(b), 'en') : x - y;
}

const sortKey = (cell) => cell.dataset.exact ?? cell.textContent;

/// Makes a table's heads buttons that sort its rows, up and then down.
function makeSortable(made) {
  made.classList.add('sortable');
  const heads = [...made.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    const button = element('button', head.textContent, { type: 'button' });
    head.replaceChildren(button);
    button.addEventListener('click', () => {
      const down = head.getAttribute('aria-sort') === 'ascending';
      heads.forEach((other) => other.removeAttribute('aria-sort'));
      head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
      const rows = [...made.tBodies[0].rows].map((row) => [sortKey(row.cells[column]), row]);
      rows.sort(([a], [b]) => (a === '' || b === '' ? compare(a, b) : (down ? -1 : 1) * compare(a, b)));
      made.tBodies[0].append(...rows.map(([, row]) => row));
    });
  });
}

/// Texts stand at the left, numbers at the right. Columns from 0.
function leftAlign(made, columns) {
  for (const row of made.rows) for (const column of columns) row.cells[column].classList.add('text');
}

/// The rate from the cell before in the same series, by cell.
function localRates(table) {
  const rates = new Map();
  for (const { cells, by_elements: fit } of table.rates) cells.forEach((cell, i) => rates.set(cell, fit.local[i]));
  return rates;
}

/// All cells, sortable.
export function showCells(table) {
  const measured = table.error === 'measured', rates = localRates(table);
  const timed = table.cells.some(({ result }) => result?.seconds > 0);
  const heads = ['Cell', ...table.axes, 'Status', 'Elements', 'Cycles', 'Estimated error, %',
    ...(measured ? ['Error, %', '95 %', 'Max, %'] : []), 'Rate', 'Energy residual', ...(timed ? ['Seconds'] : [])];
  const rows = table.cells.map(({ index, values, result, cycles, status, message }) => {
    const rate = rates.get(index) ?? null;
    const range = result?.error_ci ? result.error_ci.map((bound) => significant(100 * bound, 3)).join(' – ') : '–';
    const value = (name) => ({ text: values[name], exact: values[name] });
    const has = (made) => (result ? made(result) : { text: '–', exact: '' });
    return [String(index), ...table.axes.map(value), message ? `${status}: ${message}` : status,
      has((r) => number(r.elements, 15)), has(() => number(cycles.length, 15)),
      has((r) => share(r.estimated_error)), ...(measured ? [share(result?.error), range, share(result?.max_error)] : []),
      rate === null ? { text: '–', exact: '' } : { text: rate.toFixed(2).replace('-', '−'), exact: rate },
      has((r) => number(r.energy_residual, 2)), ...(timed ? [has((r) => number(r.seconds, 3))] : [])];
  });
  const made = tableOf(rows, heads);
  makeSortable(made);
  const isText = (axis) => table.cells.some(({ values }) => Number.isNaN(Number(values[axis])));
  leftAlign(made, [...table.axes.flatMap((axis, a) => (isText(axis) ? [1 + a] : [])), 1 + table.axes.length]);
  byId('cells').append(made);
}

const quantityText = {
  error: percent,
  elements: (value) => whole(Math.round(value)),
  seconds: (value) => `${significant(value, 3)} s`,
};
const placeText = { error: percent, elements: whole, seconds: (value) => `${significant(value, 4)} s` };

function comparedText(quantity, { value, to_best: toBest }) {
  if (value === null) return '—';
  return `${quantityText[quantity](value)} ${toBest === 1 ? '(best)' : `(${significant(toBest, 3)} ×)`}`;
}

/// A table for all rows that compare the same thing in one scene: a line a series, a column a place.
export function showComparisons(table) {
  const scenes = new Set(table.comparisons.map(({ scene }) => scene));
  const groups = new Map();
  for (const row of table.comparisons) {
    const title = `At equal ${row.at}: ${row.quantity === 'error' && table.error !== 'measured' ? 'estimated error' : row.quantity}`
      + (scenes.size > 1 ? `, ${row.scene}` : '');
    groups.set(title, [...(groups.get(title) ?? []), row]);
  }
  byId('comparisons-section').hidden = groups.size === 0;
  for (const [title, rows] of groups) {
    const lines = rows[0].values.map(({ series }, s) => [series, ...rows.map((row) => comparedText(row.quantity, row.values[s]))]);
    const wide = element('div', undefined, { class: 'wide', tabindex: '0', role: 'region', 'aria-label': title });
    wide.append(tableOf(lines, ['Series', ...rows.map((row) => placeText[row.at](row.place))]));
    byId('comparisons').append(element('h3', title), wide);
  }
}

export function showGates(table) {
  byId('gates-section').hidden = table.gates.length === 0;
  if (table.gates.length === 0) return;
  const rows = table.gates.map(({ gate, of, value, bound, passed, message }) => [
    gate, of, value === null ? '–' : number(value, 4), number(bound, 6), passed ? 'passed' : 'FAILED', message]);
  const made = tableOf(rows, ['Gate', 'Of', 'Value', 'Bound', 'Verdict', 'Note']);
  leftAlign(made, [1, 4, 5]);
  [...made.tBodies[0].rows].forEach((row, i) => row.cells[4].classList.add(table.gates[i].passed ? 'good' : 'bad'));
  byId('gates').append(made);
}

/// Where everything comes from: program, study file, scenes, and each cell's solution.
export function showProvenance({ tool, study_sha256: study, seed, reference, table }) {
  const rows = [['Program', `patchlight ${tool.version} (${tool.commit})`], ['Its numbers', tool.numeric],
    ['SHA-256 of the study file', study], ['Seed', String(seed)],
    ['Reference', [reference.kind, reference.points && `${whole(reference.points)} points`,
      reference.paths && `${whole(reference.paths)} paths each`].filter(Boolean).join(', ')]];
  const scenes = new Map();
  for (const { origin } of table.cells) if (origin) scenes.set(origin.scene_sha256, origin.scene);
  for (const [hash, name] of scenes) rows.push([`SHA-256 of ${name}`, hash]);
  byId('source').append(tableOf(rows));
  const origins = table.cells.map(({ index, name, id, origin }) => [String(index), name, id || '–', origin?.solution_sha256 || '–']);
  const made = tableOf(origins, ['Cell', 'Name', 'Folder, cells/', 'SHA-256 of the solution']);
  leftAlign(made, [1, 2, 3]);
  byId('origins').append(made);
}
