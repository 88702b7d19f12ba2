import { BufferAttribute, BufferGeometry, ShaderMaterial } from 'three';
import { lux } from './cycles.js';
import { mapSteps, viridisTexture } from './colours.js';

const vertexShader = `
attribute vec3 light;
attribute float value;
varying vec3 vLight;
varying float vValue;
varying vec3 vCorner;
void main() {
  int corner = gl_VertexID % 3;
  vCorner = vec3(corner == 0, corner == 1, corner == 2);
  vLight = light;
  vValue = value;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const fragmentShader = `
uniform float scale;       // 2^EV / pi: radiosity to what is shown
uniform bool mapped;
uniform bool logarithmic;
uniform bool wire;
uniform vec2 range;
uniform sampler2D map;
varying vec3 vLight;
varying float vValue;
varying vec3 vCorner;
vec3 encoded(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
void main() {
  vec3 shown;
  if (mapped) {
    float t = logarithmic ? log(max(vValue, range.x * 1e-3) / range.x) / log(range.y / range.x)
                          : (vValue - range.x) / (range.y - range.x);
    float steps = ${mapSteps}.0;
    shown = vValue < 0.0 ? vec3(0.45) : texture2D(map, vec2((clamp(t, 0.0, 1.0) * (steps - 1.0) + 0.5) / steps, 0.5)).rgb;
  } else {
    shown = encoded(vLight * scale);
  }
  if (wire) {
    vec3 inside = smoothstep(vec3(0.0), 1.3 * fwidth(vCorner), vCorner);
    float edge = 1.0 - min(inside.x, min(inside.y, inside.z));
    float bright = dot(shown, vec3(0.2126, 0.7152, 0.0722));
    shown = mix(shown, bright > 0.4 ? vec3(0.0) : vec3(1.0), 0.55 * edge);
  }
  gl_FragColor = vec4(shown, 1.0);
}`;

/// Fronts only; pushed back a little, so that lines lie on top.
export function patchMaterial() {
  return new ShaderMaterial({
    vertexShader,
    fragmentShader,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 2,
    uniforms: {
      scale: { value: 1 },
      mapped: { value: false },
      logarithmic: { value: false },
      wire: { value: false },
      range: { value: [0, 1] },
      map: { value: viridisTexture() },
    },
  });
}

/// Three vertices of its own for each patch: triangle i of the geometry is patch i.
export function patchGeometry(cycle) {
  const n = cycle.corners.length;
  const position = new Float32Array(3 * n);
  for (let i = 0; i < n; ++i) {
    const v = 3 * cycle.corners[i];
    position[3 * i] = cycle.positions[v];
    position[3 * i + 1] = cycle.positions[v + 1];
    position[3 * i + 2] = cycle.positions[v + 2];
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(position, 3));
  geometry.setAttribute('light', new BufferAttribute(new Float32Array(3 * n), 3));
  geometry.setAttribute('value', new BufferAttribute(new Float32Array(n), 1));
  return geometry;
}

/// Radiosity at the corners of all patches: the vertices' own (Gouraud), or the patch's one value (flat). `shot`, the
/// progressive solution at the vertices, takes the place of the cycle's own light.
function fillLight(light, cycle, shading, shot) {
  const source = shot ?? cycle.vertexLight;
  for (let p = 0; p < cycle.count; ++p) {
    const corners = [0, 1, 2].map((k) => cycle.corners[3 * p + k]);
    for (let band = 0; band < 3; ++band) {
      const at = corners.map((v) => source[3 * v + band]);
      const one = shot ? (at[0] + at[1] + at[2]) / 3 : cycle.patchLight[3 * p + band];
      for (let k = 0; k < 3; ++k) light[9 * p + 3 * k + band] = shading === 'flat' ? one : at[k];
    }
  }
}

/// What the colour map shows, from the light that fillLight() put there.
function fillValue(value, light, cycle, quantity) {
  for (let p = 0; p < cycle.count; ++p) {
    const material = cycle.material(p);
    for (let i = 3 * p; i < 3 * p + 3; ++i) {
      const [r, g, b] = [light[3 * i], light[3 * i + 1], light[3 * i + 2]];
      value[i] = quantity === 'lux' ? lux(r, g, b, material) : quantity === 'error' ? cycle.eta[p] : (r + g + b) / 3;
    }
  }
}

export function fillGeometry(geometry, cycle, { shading, quantity }, shot) {
  const { light, value } = geometry.attributes;
  fillLight(light.array, cycle, shading, shot);
  light.needsUpdate = true;
  if (quantity === 'light') return;
  fillValue(value.array, light.array, cycle, quantity);
  value.needsUpdate = true;
}
