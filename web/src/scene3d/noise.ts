// Repeatable random numbers, and tiles of noise for textures.
import { mod } from '../lib/math';

/** Random numbers in [0, 1), equal for equal seeds: pictures of the same track are equal. */
export function randomNumbers(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0; // mulberry32, Tommy Ettinger, public domain
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/**
 * A seamless square of noise: `size` × `size` values around 1, ± `amplitude`, over several scales.
 */
export function noiseTile(size: number, amplitude: number, cells: readonly number[], seed: number): Float32Array {
  const tile = new Float32Array(size * size).fill(1);
  const random = randomNumbers(seed);
  for (const count of cells) {
    const knots = Float32Array.from({ length: count * count }, () => (2 * random() - 1) * (amplitude / cells.length));
    const knot = (i: number, j: number): number => knots[mod(j, count) * count + mod(i, count)] ?? 0;
    const smooth = (u: number): number => u * u * (3 - 2 * u);
    for (let y = 0; y < size; ++y) {
      for (let x = 0; x < size; ++x) {
        const [u, v] = [(x / size) * count, (y / size) * count];
        const [i, j] = [Math.floor(u), Math.floor(v)];
        const [a, b] = [smooth(u - i), smooth(v - j)];
        const low = knot(i, j) * (1 - a) + knot(i + 1, j) * a;
        const high = knot(i, j + 1) * (1 - a) + knot(i + 1, j + 1) * a;
        tile[y * size + x] = (tile[y * size + x] ?? 0) + low * (1 - b) + high * b;
      }
    }
  }
  return tile;
}
