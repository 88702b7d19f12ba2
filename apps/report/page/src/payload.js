import { DataUtils } from 'three';

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

/// The description in the page, and `read`, which gives the numbers of a place {at, count, type} in the payload:
/// Float32Array for numbers, Uint16Array or Uint32Array for indices.
export function readPage() {
  const description = JSON.parse(document.getElementById('description').textContent);
  const buffer = bytesOf(document.getElementById('payload').textContent);
  const read = ({ at, count, type, scale, low, size }) => {
    if (type === 'float32') return new Float32Array(buffer, at, count);
    if (type === 'uint32') return new Uint32Array(buffer, at, count);
    const words = new Uint16Array(buffer, at, count);
    if (type === 'unorm16') return Float32Array.from(words, (w, i) => low[i % 3] + (w / 65535) * size[i % 3]);
    return type === 'uint16' ? words : Float32Array.from(words, (w) => DataUtils.fromHalfFloat(w) * scale);
  };
  return { description, read };
}
