// Reads solution.glb without any of the program's or the page's own code.
import { readFileSync } from 'node:fs';

const kinds = {
  positions: Float64Array, patches: Uint32Array, patch_surface: Uint32Array, patch_radiosity: Float64Array, eta: Float64Array,
};

/// The stored arrays of a solution, by name.
export function readSolution(file) {
  const bytes = readFileSync(file);
  const jsonLength = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + jsonLength));
  const binary = 20 + jsonLength + 8;
  return Object.fromEntries(Object.entries(kinds).map(([name, Kind]) => {
    const view = json.bufferViews[json.extras.patchlight.views[name]];
    const start = binary + (view.byteOffset ?? 0);
    return [name, new Kind(new Uint8Array(bytes.subarray(start, start + view.byteLength)).buffer)];
  }));
}

const minus = (a, b) => a.map((v, k) => v - b[k]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/// How many halvings of its surface lead to a patch of its size.
export function levelOf({ positions, patches, patch_surface: surfaces }, patch) {
  const area = (p) => {
    const [a, b, c] = [0, 1, 2].map((k) => Array.from(positions.subarray(3 * patches[3 * p + k], 3 * patches[3 * p + k] + 3)));
    return Math.hypot(...cross(minus(b, a), minus(c, a))) / 2;
  };
  const whole = [...surfaces.keys()].filter((p) => surfaces[p] === surfaces[patch]).reduce((sum, p) => sum + area(p), 0);
  return Math.round(Math.log2(whole / area(patch)));
}

/// The first patch whose front a ray meets [MoellerTrumbore97]; null when there is none.
export function firstHit({ positions, patches }, from, direction) {
  let nearest = Infinity, hit = null;
  for (let p = 0; p < patches.length / 3; ++p) {
    const [a, b, c] = [0, 1, 2].map((k) => Array.from(positions.subarray(3 * patches[3 * p + k], 3 * patches[3 * p + k] + 3)));
    const u = minus(b, a), v = minus(c, a), h = cross(direction, v), det = dot(u, h);
    if (det <= 1e-300) continue;
    const s = minus(from, a), q = cross(s, u);
    const x = dot(s, h) / det, y = dot(direction, q) / det, t = dot(v, q) / det;
    if (x >= 0 && y >= 0 && x + y <= 1 && t > 0 && t < nearest) [nearest, hit] = [t, p];
  }
  return hit;
}
