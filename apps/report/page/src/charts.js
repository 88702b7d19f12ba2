import uPlot from 'uplot';
import { niceAbove } from './colours.js';
import { significant } from './numbers.js';

const height = 260;

export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/// 1, 2, 5 times the powers of ten in a range; where that would be less than three, even steps.
function ticksIn(low, high) {
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power) {
    for (const digit of [1, 2, 5]) ticks.push(Number(`${digit}e${power}`));
  }
  const inside = ticks.filter((tick) => tick >= low && tick <= high);
  if (inside.length >= 3) return inside;
  const step = niceAbove((high - low) / 5), first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

const axis = (label) => ({
  label,
  stroke: colour('--ink'),
  grid: { stroke: colour('--line'), width: 1 },
  ticks: { stroke: colour('--line'), width: 1 },
  labelSize: 22,
  font: '12px system-ui, sans-serif',
  labelFont: '12px system-ui, sans-serif',
  splits: (_, __, low, high) => ticksIn(low, high),
  filter: (_, ticks) => ticks,
  values: (_, ticks) => ticks.map((tick) => significant(tick, 3)),
});

const room = (low, high) => (low > 0 && high > low ? [low / 1.15, high * 1.15] : [low / 2 || 0.1, high * 2 || 1]);

/// uPlot's options of a log-log plot; `series` without the first, which is x.
function options(place, xTitle, yTitle, series, more) {
  return {
    width: Math.max(place.clientWidth, 200),
    height,
    scales: { x: { time: false, distr: 3, range: (_, low, high) => room(low, high) },
              y: { distr: 3, range: (_, low, high) => room(low, high) } },
    axes: [axis(xTitle), { ...axis(yTitle), size: 62 }],
    series: [{}, ...series],
    cursor: { show: false },
    ...more,
  };
}

/// Keeps a plot as wide as its place, and in the colours of the scheme. `describe` gives the series anew for each
/// scheme; `onMade` is told of every plot that is made.
export function drawn(place, xTitle, yTitle, columns, describe, more = {}, onMade = () => {}) {
  let chart;
  const make = () => {
    chart?.destroy();
    chart = new uPlot(options(place, xTitle, yTitle, describe(), more), columns, place);
    onMade(chart);
  };
  make();
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', make);
  new ResizeObserver(() => {
    const width = Math.max(place.clientWidth, 200);
    if (width !== chart.width) chart.setSize({ width, height });
  }).observe(place);
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
  drawn(place, xTitle, 'estimated error, %', columns, () => names.map((label, i) => ({
    label,
    stroke: colour(`--series-${i + 1}`),
    width: i === 0 ? 2 : 0,
    spanGaps: true,
    points: { show: true, size: i === 0 ? 6 : 10, fill: colour(`--series-${i + 1}`) },
  })), { legend: { live: false } });
  place.setAttribute('aria-label', `Plot: estimated error in per cent against ${xTitle}, `
    + `${shown.length} cycles; the table below holds the same numbers.`);
  return true;
}
