import { expect, it } from 'vitest';
import type { Point } from '../lib/math';
import { paintSize } from '../lib/paint_size';
import type { RoadLines } from '../state/road';
import { colourOf } from './mesh';
import { curvatures, type FlatMesh, KERB_RADIUS_M, roadMeshes, tidyLines } from './road_mesh';

const grey = colourOf('#808080');
const PAINT = {
  road: grey,
  edge: colourOf('#ffffff'),
  centreLine: grey,
  verge: grey,
  concrete: colourOf('#b9bcb8'),
  kerbRed: colourOf('#c8342c'),
  kerbWhite: colourOf('#f2f2ee'),
};

/**
 * A ring road of mean radius `radius`, `half` to each side, driven to the left; the first point once more at its end.
 */
function ring(radius: number, half: number, count = 60): RoadLines {
  const line = (r: number): Point[] =>
    Array.from({ length: count + 1 }, (_, i) => ({
      x: r * Math.cos((2 * Math.PI * i) / count),
      y: r * Math.sin((2 * Math.PI * i) / count),
    }));
  return { left: line(radius - half), right: line(radius + half), centre: line(radius) };
}

/** Signed area seen from above: positive for counter-clockwise triangles, which face up. */
function areas({ positions: p }: FlatMesh): number[] {
  const all: number[] = [];
  for (let i = 0; i < p.length; i += 9) {
    const [ax = 0, ay = 0, , bx = 0, by = 0, , cx = 0, cy = 0] = p.slice(i, i + 9);
    all.push(((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2);
  }
  return all;
}
const sum = (values: number[]): number => values.reduce((a, b) => a + b, 0);
const mirror = (lines: RoadLines): RoadLines => {
  const flip = (points: readonly Point[]): Point[] => points.map(({ x, y }) => ({ x, y: -y }));
  return { left: flip(lines.right), right: flip(lines.left), centre: flip(lines.centre) };
};
/** A straight road of `half` m to each side. */
function straight(half: number, length: number): RoadLines {
  const at = (y: number): Point[] => Array.from({ length: 21 }, (_, i) => ({ x: (length * i) / 20, y }));
  return { left: at(half), centre: at(0), right: at(-half) };
}
const polygon = (r: number, n: number): number => (n / 2) * r * r * Math.sin((2 * Math.PI) / n);

it('covers what lies between its edges, facing up, seam included', () => {
  const { surface } = roadMeshes(tidyLines(ring(50, 5), true) as RoadLines, true, 0, PAINT);
  expect(Math.min(...areas(surface))).toBeGreaterThan(0);
  expect(sum(areas(surface))).toBeCloseTo(polygon(55, 60) - polygon(45, 60), 1);
});

it('closes its seam where the first point is not repeated, and where the last nearly repeats it', () => {
  const whole = ring(50, 5);
  const open: RoadLines = {
    left: whole.left.slice(0, -1),
    right: whole.right.slice(0, -1),
    centre: whole.centre.slice(0, -1),
  };
  const [a, b] = [tidyLines(whole, true), tidyLines(open, true)];
  expect(a?.centre.length).toBe(61);
  expect(b?.centre.length).toBe(61);
  expect(a?.left[0]).toEqual(a?.left[60]);
  expect(b?.left[0]).toEqual(b?.left[60]);
  expect(tidyLines(open, false)?.centre.length).toBe(60); // an open road stays open
});

it('is no road without two points', () => {
  expect(tidyLines({ left: [], right: [], centre: [] }, true)).toBeNull();
  const one = [{ x: 1, y: 2 }];
  expect(tidyLines({ left: one, right: one, centre: one }, true)).toBeNull();
  expect(tidyLines({ left: [...one, ...one], right: [...one, ...one], centre: [...one, ...one] }, false)).toBeNull();
});

it('is the mirrored road in a mirrored world', () => {
  const lines = ring(40, 4);
  const [here, there] = [lines, mirror(lines)].map((each) => roadMeshes(each, true, 0.8, PAINT));
  for (const part of ['verge', 'kerbs', 'surface'] as const) {
    expect(sum(areas(there?.[part] as FlatMesh)), part).toBeCloseTo(sum(areas(here?.[part] as FlatMesh)), 2);
    expect(Math.min(...areas(there?.[part] as FlatMesh)), part).toBeGreaterThan(-1e-6);
  }
});

it('has kerbs of the given width outside the edges, and none for width 0', () => {
  const lines = ring(50, 5, 120);
  const radii = (flat: FlatMesh): number[] => {
    const all: number[] = [];
    for (let i = 0; i < flat.positions.length; i += 3)
      all.push(Math.hypot(flat.positions[i] ?? 0, flat.positions[i + 1] ?? 0));
    return all;
  };
  const { kerbs } = roadMeshes(lines, true, 0.8, PAINT);
  const inner = radii(kerbs).filter((r) => r < 50);
  const outer = radii(kerbs).filter((r) => r > 50);
  expect(Math.min(...inner)).toBeCloseTo(44.2, 1);
  expect(Math.max(...inner)).toBeCloseTo(45, 1);
  expect(Math.min(...outer)).toBeGreaterThan(54.9);
  expect(Math.max(...outer)).toBeCloseTo(55.8, 1);
  expect(roadMeshes(lines, true, 0, PAINT).kerbs.positions.length).toBe(0);
});

it('paints kerbs red and white in bends only', () => {
  const shades = (radius: number): Set<string> => {
    const { kerbs } = roadMeshes(ring(radius, 5, 200), true, 0.8, PAINT);
    const all = new Set<string>();
    for (let i = 0; i < kerbs.colours.length; i += 3) all.add(kerbs.colours.slice(i, i + 3).join());
    return all;
  };
  expect(shades(KERB_RADIUS_M * 0.5).size).toBe(2);
  expect([...shades(KERB_RADIUS_M * 3)]).toEqual([new Float32Array(PAINT.concrete).join()]);
});

it('is painted in the size of the car, full size but for model cars', () => {
  const lengths = [4.3, 2.9, 0.45, NaN]; // at 2.9 m a student's racing car, which drives on full-size roads
  expect(lengths.map((body_length_m) => paintSize({ body_length_m }))).toEqual([1, 1, expect.closeTo(0.1, 9), 1]);
  const small = roadMeshes(straight(0.5, 20), false, 0.1, PAINT, 0.1);
  const full = roadMeshes(straight(5, 200), false, 1, PAINT);
  for (const part of ['verge', 'kerbs', 'surface', 'lines'] as const) {
    expect(small[part].positions.length).toBe(full[part].positions.length);
    small[part].positions.forEach((value, i) => expect(value).toBeCloseTo((full[part].positions[i] ?? NaN) / 10, 4));
  }
  expect(Math.max(...small.surface.positions.filter((_, i) => i % 3 === 1))).toBeCloseTo(0.5, 6);
});

it('bends to the left positively, seam included', () => {
  for (const value of curvatures(ring(50, 5).centre, true)) expect(value).toBeCloseTo(1 / 50, 4);
  for (const value of curvatures(mirror(ring(50, 5)).centre, true)) expect(value).toBeCloseTo(-1 / 50, 4);
});
