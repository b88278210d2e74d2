import { describe, expect, it } from 'vitest';
import { paintSize } from '../lib/paint_size';
import { type RoadPaint, roadMeshes } from './road_mesh';

const paint = {
  road: [0, 0, 0],
  verge: [0, 0, 0],
  edge: [1, 1, 1],
  centreLine: [1, 1, 1],
  kerbWhite: [1, 1, 1],
  kerbRed: [1, 0, 0],
  concrete: [1, 1, 1],
} as const satisfies RoadPaint;

/** A straight road of `half` m to each side. */
function straight(half: number, length: number) {
  const at = (y: number) => Array.from({ length: 21 }, (_, i) => ({ x: (length * i) / 20, y }));
  return { left: at(half), centre: at(0), right: at(-half) };
}

describe('what is painted on a road', () => {
  it('is smaller for model cars alone', () => {
    expect(paintSize({ body_length_m: 4.3 })).toBe(1);
    expect(paintSize({ body_length_m: 2.9 })).toBe(1); // a student's racing car drives on full-size roads
    expect(paintSize({ body_length_m: 0.45 })).toBeCloseTo(0.1, 9);
    expect(paintSize({ body_length_m: NaN })).toBe(1);
  });

  it('is in the size of the car, and the road as it is', () => {
    const [small, full] = [
      roadMeshes(straight(0.5, 20), false, 0.1, paint, 0.1),
      roadMeshes(straight(5, 200), false, 1, paint),
    ];
    for (const part of ['verge', 'kerbs', 'surface', 'lines'] as const) {
      expect(small[part].positions.length).toBe(full[part].positions.length);
      small[part].positions.forEach((value, i) => expect(value).toBeCloseTo((full[part].positions[i] ?? NaN) / 10, 4));
    }
    const reach = Math.max(...[...small.surface.positions].filter((_, i) => i % 3 === 1));
    expect(reach).toBeCloseTo(0.5, 6);
  });
});
