import 'uplot/dist/uPlot.min.css';
import './page.css';
import './study_page.css';
import { element, percent, significant, whole } from './numbers.js';
import { showCells, showComparisons, showGates, showProvenance } from './study_tables.js';
import { showPictures } from './study_pictures.js';
import { showPlots } from './study_plots.js';

const byId = (id) => document.getElementById(id);
const description = JSON.parse(byId('description').textContent);
const { table } = description;

/// The error that the page is about: the measured one, or the estimate where nothing is measured.
const errorOf = (cycle) => (table.error === 'measured' ? cycle?.error : cycle?.estimated_error) ?? null;
const ended = (cell) => cell.status === 'done' || cell.status === 'not-converged';

function showHead() {
  byId('title').textContent = table.name;
  const done = table.cells.filter(ended);
  const axes = table.axes.length > 0 ? table.axes.join(' × ') : 'one cell';
  byId('subtitle').textContent = table.error === 'measured'
    ? `${axes} · errors measured against a reference: ${description.reference.kind}`
    : `${axes} · errors as the solver estimates them: there is no reference`;
  const facts = [['Cells', `${done.length} of ${table.cells.length}`]];
  const errors = done.map((cell) => errorOf(cell.result)).filter((error) => error !== null);
  if (errors.length > 0) facts.push(['Least error', percent(Math.min(...errors))]);
  const elements = done.map((cell) => cell.result.elements);
  if (elements.length > 0) facts.push(['Most elements', whole(Math.max(...elements))]);
  if (table.gates.length > 0) {
    facts.push(['Gates passed', `${table.gates.filter(({ passed }) => passed).length} of ${table.gates.length}`]);
  }
  for (const [name, value] of facts) {
    const fact = element('div');
    fact.append(element('dt', name), element('dd', value));
    byId('facts').append(fact);
  }
}

/// One line in words: what hovering and captions tell of a cell's cycle.
function tellOf(cycle) {
  if (!cycle) return 'no result';
  const error = errorOf(cycle);
  return `${whole(cycle.elements)} elements, ${error === null ? 'error unknown' : `error ${percent(error)}`}`
    + (cycle.seconds > 0 ? `, ${significant(cycle.seconds, 3)} s` : '');
}

showHead();
showPlots(table, errorOf, ended, tellOf);
showPictures(description, tellOf);
showCells(table);
showComparisons(table);
showGates(table);
showProvenance(description);
