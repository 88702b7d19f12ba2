import uPlot from 'uplot';
import { significant } from './numbers.js';

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function options(place, xTitle, names, points) {
  const axis = (label) => ({
    label,
    stroke: colour('--ink'),
    grid: { stroke: colour('--line'), width: 1 },
    ticks: { stroke: colour('--line'), width: 1 },
    labelSize: 22,
    font: '12px system-ui, sans-serif',
    labelFont: '12px system-ui, sans-serif',
    values: (_, ticks) => ticks.map((tick) => (tick === null ? '' : significant(tick, 3))),
  });
  const series = names.map((label, i) => ({
    label,
    stroke: colour(`--series-${i + 1}`),
    width: i === 0 ? 2 : 0,
    spanGaps: true,
    points: { show: true, size: i === 0 ? 6 : 10, fill: colour(`--series-${i + 1}`) },
    value: (_, value) => (value === null || value === undefined ? '–' : `${significant(value, 3)} %`),
  }));
  const room = (low, high) => (low > 0 && high > low ? [low / 1.15, high * 1.15] : [low / 2 || 0.1, high * 2 || 1]);
  return {
    width: Math.max(place.clientWidth, 200),
    height: 260,
    scales: { x: { time: false, distr: 3, range: (_, low, high) => room(low, high) },
              y: { distr: 3, range: (_, low, high) => room(low, high) } },
    axes: [axis(xTitle), { ...axis('estimated error, %'), size: 62 }],
    series: [{ label: xTitle, value: (_, value) => significant(value, 5) }, ...series],
    cursor: { drag: { x: false, y: false } },
    legend: { live: points > 1 },
  };
}

/// A log-log plot of points {x, error, uniform}: adaptive cycles joined by a line, uniform ones as dots.
export function plot(place, xTitle, points) {
  const shown = points.filter(({ x, error }) => x > 0 && error > 0).sort((a, b) => a.x - b.x);
  if (shown.length === 0) return false;
  const columns = [shown.map((p) => p.x)], names = [];
  for (const [name, uniform] of [['adaptive mesh', false], ['uniform mesh', true]]) {
    columns.push(shown.map((p) => (p.uniform === uniform ? 100 * p.error : null)));
    names.push(name);
  }
  let chart;
  const make = () => {
    chart?.destroy();
    chart = new uPlot(options(place, xTitle, names, shown.length), columns, place);
  };
  make();
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', make);
  new ResizeObserver(() => {
    const width = Math.max(place.clientWidth, 200);
    if (width !== chart.width) chart.setSize({ width, height: 260 });
  }).observe(place);
  place.setAttribute('aria-label', `Plot: estimated error in per cent against ${xTitle}, `
    + `${shown.length} cycles; the table below holds the same numbers.`);
  return true;
}
