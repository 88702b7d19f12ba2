import 'uplot/dist/uPlot.min.css';
import './page.css';
import { gradient, niceAbove } from './colours.js';
import { Cycle, Scene } from './cycles.js';
import { element, percent, significant, whole } from './numbers.js';
import { showNumbers } from './numbers_sections.js';
import { showPatches } from './patch_panel.js';
import { readPage } from './payload.js';
import { Views } from './views.js';

const byId = (id) => document.getElementById(id);
const chosen = (name) => document.querySelector(`input[name="${name}"]:checked`).value;

const { description, read } = readPage();
const { run, line_kinds: lineKinds } = description;
const scene = new Scene(description.scene, read);
const shots = description.shots.map(({ shots: count, vertex_light: light }) => ({ count, light: read(light) }));
const cycles = description.cycles.map((c) => {
  let made;
  return () => (made ??= new Cycle(c, read, run.cycles.find((r) => r.cycle === c.cycle), scene));
});
const first = cycles[0](), last = cycles[cycles.length - 1]();

/// Stops that show the last cycle well: the run's pictures' own, else the 90th percentile of what doesn't emit at half
/// of white, as those have it.
function usualExposure() {
  if (run.options.pictures?.written === 'all') return run.cycles[0].exposure;
  const bright = last.percentile(0.9, (p) => last.patchLuminance(p)) / Math.PI;
  return bright > 0 ? Math.log2(0.5 / bright) : 0;
}

/// The map's ranges, the same for all cycles. A quarter of each is a round number.
const quarters = [1, 1.2, 1.6, 2, 3, 4, 5, 6, 8, 10];
const tops = {
  lux: niceAbove(last.percentile(0.98, (p) => last.patchLux(p)), quarters),
  radiosity: niceAbove(last.percentile(0.98, (p) => last.patchMean(p)), quarters),
  error: niceAbove(Math.max(first.percentile(0.999, (p) => first.eta[p]), last.percentile(0.999, (p) => last.eta[p]))),
};
const mapTitles = {
  lux: 'Illuminance, lux (683 lm/W; grey: reflects nothing)',
  radiosity: 'Radiosity, W/m², mean of the bands',
  error: 'Estimated error per patch, W/m²·m',
};
const decades = { lux: 3, radiosity: 3, error: 4 };

const exposure = usualExposure();
const sidesShown = () => [
  { cycle: cycles[byId('left').value](), shot: null },
  { cycle: cycles[byId('right').value](), shot: shots[byId('shots').value - 1] ?? null },
].map((side) => (side.shot ? { cycle: last, shot: side.shot } : side));

const sideNames = ['Before', 'After'];

function titleOf({ cycle, shot }, side) {
  return `${sideNames[side]}: ${shot ? `${shot.count} shot${shot.count === 1 ? '' : 's'}` : `cycle ${cycle.record.cycle}`}`;
}

function detailOf({ cycle, shot }) {
  const elements = `${whole(cycle.record.elements)} elements`;
  return shot ? `progressive solve, ${elements}` : `${elements}, error ${percent(cycle.record.estimated_error)}`;
}

function showLegend(quantity, range, logarithmic) {
  byId('legend').hidden = quantity === 'light';
  if (quantity === 'light') return;
  byId('legend-title').textContent = mapTitles[quantity];
  byId('legend-bar').style.background = gradient;
  const ticks = logarithmic ? Array.from({ length: decades[quantity] + 1 }, (_, i) => range[0] * 10 ** i)
    : [0, 1, 2, 3, 4].map((i) => (range[1] * i) / 4);
  byId('legend-ticks').replaceChildren(...ticks.map((tick, i) => {
    const made = element('span', significant(tick, 3));
    made.style.left = `${(100 * i) / (ticks.length - 1)}%`;
    return made;
  }));
}

function showTexts(sides) {
  ['left', 'right'].forEach((id, i) => {
    byId(`caption-${id}`).replaceChildren(titleOf(sides[i], i), element('span', detailOf(sides[i])));
    const { cycle } = cycles[byId(id).value]().record;
    byId(`${id}-out`).textContent = `${cycle} of ${run.cycles[run.cycles.length - 1].cycle}`;
    byId(id).setAttribute('aria-valuetext', `cycle ${cycle}`);
  });
  byId('shots-out').textContent = sides[1].shot ? String(sides[1].shot.count) : 'off';
  byId('shots').setAttribute('aria-valuetext', byId('shots-out').textContent);
  const stops = Number(byId('exposure').value);
  byId('exposure-out').textContent = `${stops < 0 ? '−' : '+'}${Math.abs(stops).toFixed(1)} stops`;
  byId('wipe-out').textContent = `${byId('wipe').value} %`;
}

function showLayout() {
  const wipe = chosen('layout') === 'wipe', part = byId('wipe').value;
  byId('views').classList.toggle('wipe', wipe);
  byId('wipe-row').hidden = !wipe;
  byId('figure-right').style.clipPath = wipe ? `inset(0 0 0 ${part}%)` : '';
  byId('divider').style.left = `${part}%`;
}

/// Brings everything to what the controls say.
function update(views) {
  const quantity = byId('quantity').value;
  const logarithmic = byId('log').checked;
  const top = tops[quantity] ?? 1;
  const range = [logarithmic ? top / 10 ** (decades[quantity] ?? 1) : 0, top];
  const sides = sidesShown();
  showTexts(sides);
  showLayout();
  showLegend(quantity, range, logarithmic);
  if (!views) return;
  const kinds = new Set(lineKinds.map((_, k) => k).filter((k) => byId(`kind-${k}`)?.checked));
  const look = { shading: chosen('shading'), quantity, kinds, wire: byId('wire').checked };
  const { uniforms } = views.material;
  uniforms.scale.value = 2 ** (exposure + Number(byId('exposure').value)) / Math.PI;
  uniforms.mapped.value = quantity !== 'light';
  uniforms.logarithmic.value = logarithmic;
  uniforms.range.value = range;
  uniforms.wire.value = look.wire;
  views.sides.forEach((side, i) => side.show(sides[i].cycle, look, sides[i].shot?.light));
  views.draw();
}

/// Lines by what makes them, as meshing/surface_line.h has it.
const kindTexts = {
  contact: 'contact: something stands here',
  EV: 'EV: blocker’s edge, lamp’s corner',
  VE: 'VE: blocker’s corner, lamp’s edge',
  EEE: 'EEE: lamp’s edge, two blockers’ edges',
  plane: 'plane of a lamp or a blocker',
};

function fillControls() {
  // On a narrow screen the pictures lie one on the other, and stay in sight of the controls.
  if (window.matchMedia('(max-width: 700px)').matches) document.querySelector('input[value=wipe]').checked = true;
  for (const id of ['left', 'right']) byId(id).max = cycles.length - 1;
  byId('right').value = cycles.length - 1;
  byId('shots').max = shots.length;
  byId('shots-row').hidden = shots.length === 0;
  for (const view of scene.views) byId('camera').append(element('option', view.name || 'unnamed'));
  byId('camera-row').hidden = scene.views.length < 2;
  lineKinds.forEach(({ name, color }, k) => {
    if (!description.cycles.some((c) => c.lines[k].count > 0)) return;
    const label = element('label', undefined, { class: 'check' });
    const swatch = element('span', undefined, { class: 'swatch', 'aria-hidden': 'true' });
    swatch.style.background = color;
    label.append(element('input', undefined, { type: 'checkbox', id: `kind-${k}` }), swatch, kindTexts[name] ?? name);
    byId('kinds').append(label);
  });
  byId('kinds').hidden = byId('kinds').children.length < 2;
  const missing = run.cycles.length - cycles.length;
  const notes = [];
  if (missing > 0) {
    notes.push(`To keep this page small, ${missing} of the run's ${run.cycles.length} cycles are not in the 3-D views.`);
  }
  if (run.options.solve?.elements === 'quadratic') {
    notes.push('The views draw these quadratic elements linear between their vertices.');
  }
  byId('notice').textContent = notes.join(' ');
  byId('notice').hidden = notes.length === 0;
}

/// A camera for a run without any: the whole scene from its front.
const anywhere = {
  name: '', from: [0, 0, 1.5 * scene.diameter], forward: [0, 0, -1], up: [0, 1, 0], vertical_fov: 40, aspect: 0,
};

function makeViews() {
  try {
    return new Views({
      canvases: [byId('canvas-left'), byId('canvas-right')],
      scene,
      lineKinds,
      smooth: last.count < 50_000,
      onPick: (patches) => showPatches(byId('patch'), sidesShown().map((side, i) => ({
        cycle: side.cycle,
        patch: patches[i],
        shot: side.shot?.light,
        title: titleOf(side, i),
      })), scene),
    });
  } catch (problem) {
    byId('notice').textContent = 'The 3-D views need WebGL, which this browser doesn’t offer '
      + `(${problem.message}). Everything else is here.`;
    byId('notice').hidden = false;
    return null;
  }
}

function start() {
  fillControls();
  showNumbers(description);
  const views = makeViews();
  byId('controls').addEventListener('submit', (event) => event.preventDefault());
  byId('controls').addEventListener('input', (event) => {
    if (event.target.id === 'quantity') byId('log').checked = event.target.value === 'error';
    if (event.target.id === 'right') byId('shots').value = 0;
    if (event.target.id !== 'camera') update(views);
  });
  const lookAgain = () => views?.lookFrom(scene.views[byId('camera').selectedIndex] ?? anywhere);
  byId('camera').addEventListener('change', lookAgain);
  byId('reset').addEventListener('click', lookAgain);
  update(views);
  lookAgain();
}

start();
