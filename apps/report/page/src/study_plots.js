import { colour, drawn } from './charts.js';
import { element } from './numbers.js';

const byId = (id) => document.getElementById(id);
const colours = 8;
const dashes = [[], [8, 4], [2, 3]];

/// The points of a series: its cells that ran to their end; where there is one alone, its cycles.
function pointsOf(series, cells, ended, errorOf, xOf) {
  const own = series.cells.map((index) => cells.find((cell) => cell.index === index)).filter(ended);
  const steps = own.length === 1 ? own[0].cycles.map((cycle) => ({ cell: own[0], cycle }))
    : own.map((cell) => ({ cell, cycle: cell.result }));
  return steps.map(({ cell, cycle }) => ({ cell, cycle, x: xOf(cycle), y: 100 * errorOf(cycle) }))
    .filter(({ x, y }) => x > 0 && y > 0).sort((a, b) => a.x - b.x);
}

/// The fitted line over the points' range: through the centre of their logarithms.
function fittedLine(points, rate) {
  if (rate === null || points.length < 2) return [];
  const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
  const middle = mean(points.map(({ x }) => Math.log(x))), height = mean(points.map(({ y }) => Math.log(y)));
  return [points[0].x, points[points.length - 1].x].map((x) => [x, Math.exp(height - rate * (Math.log(x) - middle))]);
}

/// uPlot's columns: all x once, and each line's y there or null.
function columnsOf(lines) {
  const xs = [...new Set(lines.flatMap((line) => line.map(([x]) => x)))].sort((a, b) => a - b);
  const place = new Map(xs.map((x, i) => [x, i]));
  return [xs, ...lines.map((line) => {
    const column = new Array(xs.length).fill(null);
    for (const [x, y] of line) column[place.get(x)] = y;
    return column;
  })];
}

function rateText(fit) {
  if (fit.rate === null) return fit.note ? `no rate: ${fit.note}` : 'no rate';
  const error = fit.standard_error === null ? '' : ` ± ${fit.standard_error.toFixed(2)}`;
  return `rate ${fit.rate.toFixed(2).replace('-', '−')}${error}${fit.note ? ` (${fit.note})` : ''}`;
}

/// Tells of the point that is nearest to the pointer.
function listen(chart, all, shown, out, tellOf) {
  chart.over.addEventListener('mousemove', ({ offsetX, offsetY }) => {
    let nearest = null, least = 40;
    all.forEach((points, s) => {
      if (!shown[s]) return;
      for (const point of points) {
        const far = Math.hypot(chart.valToPos(point.x, 'x') - offsetX, chart.valToPos(point.y, 'y') - offsetY);
        if (far < least) [nearest, least] = [point, far];
      }
    });
    out.textContent = nearest ? `${nearest.cell.name}: ${tellOf(nearest.cycle)}` : '';
  });
  chart.over.addEventListener('mouseleave', () => { out.textContent = ''; });
}

/// One plot, with its legend: a box a series that hides it. Returns whether there was anything to plot.
function plot(id, title, table, fitName, parts) {
  const { ended, errorOf, tellOf, xOf } = parts;
  const place = byId(`chart-${id}`);
  const series = table.rates.filter((one) => one[fitName]);
  const all = series.map((one) => pointsOf(one, table.cells, ended, errorOf, xOf));
  if (all.every((points) => points.length === 0)) return false;
  const fits = series.map((one, s) => fittedLine(all[s], one[fitName].rate));
  const columns = columnsOf([...all.map((points) => points.map(({ x, y }) => [x, y])), ...fits]);
  const shown = series.map(() => true);
  let chart;
  const lookOf = (s) => ({
    label: series[s].series,
    stroke: colour(`--series-${(s % colours) + 1}`),
    dash: dashes[Math.floor(s / colours) % dashes.length],
    width: 2,
    spanGaps: true,
    show: shown[s],
  });
  const describe = () => [
    ...series.map((_, s) => ({ ...lookOf(s), points: { show: true, size: 7, fill: colour(`--series-${(s % colours) + 1}`) } })),
    ...series.map((_, s) => ({ ...lookOf(s), width: 1, dash: [4, 4], points: { show: false } })),
  ];
  drawn(place, title, table.error === 'measured' ? 'error, %' : 'estimated error, %', columns, describe,
    { legend: { show: false } }, (made) => {
      chart = made;
      listen(chart, all, shown, byId(`hover-${id}`), tellOf);
    });
  series.forEach((one, s) => {
    const box = element('input', undefined, { type: 'checkbox' });
    box.checked = true;
    box.addEventListener('input', () => {
      shown[s] = box.checked;
      for (const line of [1 + s, 1 + s + series.length]) chart.setSeries(line, { show: box.checked });
    });
    const label = element('label');
    label.append(box, element('span', undefined, { class: `swatch series-${(s % colours) + 1}` }),
      element('span', `${one.series}: ${rateText(one[fitName])}`));
    const item = element('li');
    item.append(label);
    byId(`legend-${id}`).append(item);
  });
  place.setAttribute('aria-label', `Plot: error in per cent against ${title}, ${series.length} series; `
    + 'the table of cells holds the same numbers.');
  return true;
}

/// Error against elements and, where the page knows them, seconds.
export function showPlots(table, errorOf, ended, tellOf) {
  const parts = { ended, errorOf, tellOf };
  if (!plot('elements', 'elements', table, 'by_elements', { ...parts, xOf: ({ elements }) => elements })) {
    byId('figure-elements').replaceChildren(element('p', 'No cell has an error yet.', { class: 'hint' }));
  }
  if (!plot('seconds', 'seconds', table, 'by_seconds', { ...parts, xOf: ({ seconds }) => seconds ?? 0 })) {
    byId('figure-seconds').hidden = true;
  }
}
