import { lux } from './cycles.js';
import { element, number, table, whole } from './numbers.js';

const bands = ['red', 'green', 'blue'];

/// What one view says about a patch, by row. `shot`: the progressive solution at the vertices, or nothing.
function facts(cycle, patch, scene, shot) {
  const surface = cycle.patchSurface[patch];
  const digits = cycle.exact ? 6 : 3;
  const light = [0, 1, 2].map((k) => (shot ? cycle.meanOfCorners(shot, patch, k) : cycle.patchLight[3 * patch + k]));
  const illuminance = lux(...light, scene.materialOf(surface));
  return new Map([
    ['Patch', { text: whole(patch), exact: patch }],
    ['Surface', { text: whole(surface), exact: surface }],
    ['Object', scene.objects[scene.surfaceObject[surface]] ?? '–'],
    ['Material', scene.materialOf(surface).name],
    ...bands.map((band, k) => [`Radiosity, ${band} (W/m²)`, number(light[k], digits)]),
    ['Illuminance (lux)', illuminance < 0 ? '–' : number(illuminance, digits)],
    ['Area (m²)', number(cycle.area(patch), digits)],
    ['Level (halvings of its surface)', { text: whole(cycle.level(patch)), exact: cycle.level(patch) }],
    ['Estimated error η (W/m²·m)', shot ? '–' : number(cycle.eta[patch], digits)],
  ]);
}

/// Shows the patches that were picked, a column for each view.
export function showPatches(place, sides, scene) {
  const known = sides.map(({ cycle, patch, shot }) => (patch === null ? null : facts(cycle, patch, scene, shot)));
  place.replaceChildren();
  const names = (known[0] ?? known[1])?.keys();
  if (!names) {
    place.append(element('p', 'There is no patch at that place: nothing, or a black back.', { class: 'hint' }));
    return;
  }
  const rows = [...names].map((name) => [name, ...known.map((side) => side?.get(name) ?? '–')]);
  place.append(table(rows, ['', ...sides.map((side) => side.title)]));
  if (sides.some(({ cycle, patch }) => patch !== null && !cycle.exact)) {
    place.append(element('p', 'Cycles between the first and the last are kept rounded: three digits count.', { class: 'hint' }));
  }
}
