import { DataTexture, LinearFilter } from 'three';

/// Viridis at 17 even steps (Nathaniel Smith, Stéfan van der Walt; CC0).
const viridis = ['#440154', '#48186a', '#472d7b', '#424086', '#3b528b', '#33638d', '#2c728e', '#26828e', '#21918c',
  '#1fa088', '#28ae80', '#3fbc73', '#5ec962', '#84d44b', '#addc30', '#d8e219', '#fde725'];

export const gradient = `linear-gradient(to right, ${viridis.join(', ')})`;

/// The same for the shader: sRGB bytes, as the shader writes them.
export function viridisTexture() {
  const data = new Uint8Array(viridis.length * 4);
  viridis.forEach((colour, i) => {
    for (let k = 0; k < 3; ++k) data[4 * i + k] = parseInt(colour.slice(1 + 2 * k, 3 + 2 * k), 16);
    data[4 * i + 3] = 255;
  });
  const texture = new DataTexture(data, viridis.length, 1);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
export const mapSteps = viridis.length;

/// The next of `steps` times a power of ten.
export function niceAbove(value, steps = [1, 2, 5, 10]) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  for (const step of steps) if (value <= step * power * 1.0000001) return step * power;
  return 10 * power;
}
