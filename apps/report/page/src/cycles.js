/// lm/W at all wavelengths, as everywhere in patchlight.
export const lumensPerWatt = 683;
const weights = [0.2126, 0.7152, 0.0722];

export const luminance = (r, g, b) => weights[0] * r + weights[1] * g + weights[2] * b;

/// The illuminance, in lux, of a surface that shows B: of the irradiance H = (B − E)/ρ. Where a band isn't reflected
/// it can't be known from B and doesn't count; -1 where none is.
export function lux(r, g, b, material) {
  const B = [r, g, b];
  let sum = 0, known = false;
  for (let k = 0; k < 3; ++k) {
    const rho = material.reflectance[k];
    if (!(rho > 0)) continue;
    known = true;
    sum += weights[k] * Math.max(0, B[k] - material.emission[k]) / rho;
  }
  return known ? lumensPerWatt * sum : -1;
}

function triangleArea(p, a, b, c) {
  const u = [0, 1, 2].map((k) => p[3 * b + k] - p[3 * a + k]);
  const v = [0, 1, 2].map((k) => p[3 * c + k] - p[3 * a + k]);
  return 0.5 * Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}

/// The scene's surfaces: what each is made of and part of.
export class Scene {
  constructor(description, read) {
    this.diameter = description.diameter;
    this.views = description.views;
    this.materials = description.materials;
    this.objects = description.objects;
    this.surfaceMaterial = read(description.surface_material);
    this.surfaceObject = read(description.surface_object);
  }

  materialOf(surface) { return this.materials[this.surfaceMaterial[surface]]; }
}

/// One cycle's mesh and light.
export class Cycle {
  constructor(description, read, record, scene) {
    this.record = record;
    this.exact = description.exact;
    this.scene = scene;
    this.positions = read(description.positions);
    this.corners = read(description.corners);
    this.vertexLight = read(description.vertex_light);
    this.patchLight = read(description.patch_light);
    this.eta = read(description.eta);
    this.lines = description.lines.map(read);
    this.count = this.corners.length / 3;
    this.areas = description.areas ? read(description.areas) : null;
    this.patchSurface = new Uint32Array(this.count);
    const first = read(description.first_patches);
    for (let s = 0; s + 1 < first.length; ++s) this.patchSurface.fill(s, first[s], first[s + 1]);
  }

  material(patch) { return this.scene.materialOf(this.patchSurface[patch]); }

  area(patch) {
    if (this.areas) return this.areas[patch];
    const [a, b, c] = this.corners.subarray(3 * patch, 3 * patch + 3);
    return triangleArea(this.positions, a, b, c);
  }

  /// How many halvings of its surface lead to a patch of its size: what VTU files call level, too.
  level(patch) {
    const surface = this.patchSurface[patch];
    let whole = 0;
    for (let p = 0; p < this.count; ++p) if (this.patchSurface[p] === surface) whole += this.area(p);
    return Math.max(0, Math.round(Math.log2(whole / this.area(patch))));
  }

  /// Of values at the vertices, three bands each.
  meanOfCorners(values, patch, band) {
    let sum = 0;
    for (let k = 0; k < 3; ++k) sum += values[3 * this.corners[3 * patch + k] + band];
    return sum / 3;
  }

  /// The value below which the share `part` of the area that doesn't emit has its own.
  percentile(part, valueOf) {
    const entries = [];
    let total = 0;
    for (let p = 0; p < this.count; ++p) {
      if (Math.max(...this.material(p).emission) > 0) continue;
      const value = valueOf(p);
      if (value < 0) continue;
      const area = this.area(p);
      total += area;
      entries.push([value, area]);
    }
    entries.sort((a, b) => a[0] - b[0]);
    let sum = 0;
    for (const [value, area] of entries) if ((sum += area) >= part * total) return value;
    return 0;
  }

  patchLux(p) { return lux(this.patchLight[3 * p], this.patchLight[3 * p + 1], this.patchLight[3 * p + 2], this.material(p)); }
  patchMean(p) { return (this.patchLight[3 * p] + this.patchLight[3 * p + 1] + this.patchLight[3 * p + 2]) / 3; }
  patchLuminance(p) { return luminance(...this.patchLight.subarray(3 * p, 3 * p + 3)); }
}
