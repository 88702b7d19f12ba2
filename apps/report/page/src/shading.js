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

/// Whether each patch needs three vertices of its own: to have one value, or its edges drawn. Without, a vertex serves
/// all patches around it, which is much faster.
export const needsOwnCorners = ({ shading, quantity, wire }) => wire || shading === 'flat' || quantity === 'error';

/// Triangle i of the geometry is patch i. `userData` holds for each vertex of the geometry the mesh's vertex and a patch.
export function patchGeometry(cycle, ownCorners) {
  const count = cycle.positions.length / 3, n = ownCorners ? cycle.corners.length : count;
  const vertices = ownCorners ? cycle.corners : Uint32Array.from({ length: n }, (_, v) => v);
  const patches = new Uint32Array(n);
  for (let i = 0; i < cycle.corners.length; ++i) patches[ownCorners ? i : cycle.corners[i]] = Math.floor(i / 3);
  const position = new Float32Array(3 * n);
  for (let i = 0; i < n; ++i) {
    for (let k = 0; k < 3; ++k) position[3 * i + k] = cycle.positions[3 * vertices[i] + k];
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(position, 3));
  geometry.setAttribute('light', new BufferAttribute(new Float32Array(3 * n), 3));
  geometry.setAttribute('value', new BufferAttribute(new Float32Array(n), 1));
  if (!ownCorners) geometry.setIndex(new BufferAttribute(cycle.corners, 1));
  geometry.userData = { vertices, patches };
  return geometry;
}

/// Radiosity at the geometry's vertices: the mesh's own there (Gouraud), or the patch's one value (flat). `shot`, the
/// progressive solution at the vertices, takes the place of the cycle's own light.
function fillLight(light, { vertices, patches }, cycle, shading, shot) {
  const flat = shading === 'flat', source = shot ?? cycle.vertexLight;
  for (let i = 0; i < patches.length; ++i) {
    for (let band = 0; band < 3; ++band) {
      light[3 * i + band] = !flat ? source[3 * vertices[i] + band]
        : shot ? cycle.meanOfCorners(shot, patches[i], band) : cycle.patchLight[3 * patches[i] + band];
    }
  }
}

/// What the colour map shows, from the light that fillLight() put there.
function fillValue(value, light, { patches }, cycle, quantity) {
  for (let i = 0; i < patches.length; ++i) {
    const [r, g, b] = [light[3 * i], light[3 * i + 1], light[3 * i + 2]];
    value[i] = quantity === 'lux' ? lux(r, g, b, cycle.material(patches[i]))
      : quantity === 'error' ? cycle.eta[patches[i]] : (r + g + b) / 3;
  }
}

export function fillGeometry(geometry, cycle, { shading, quantity }, shot) {
  const { light, value } = geometry.attributes;
  fillLight(light.array, geometry.userData, cycle, shading, shot);
  light.needsUpdate = true;
  if (quantity === 'light') return;
  fillValue(value.array, light.array, geometry.userData, cycle, quantity);
  value.needsUpdate = true;
}
