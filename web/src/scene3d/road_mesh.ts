// Meshes of the road: surface, verge, kerbs, painted lines and the chequered start.
import { lengthsOf, lineOf } from '../draw/line';
import { mod, type Point } from '../lib/math';
import type { RoadLines } from '../state/road';
import { type Colour, colourOf } from './mesh';
import type { Palette } from './palette';

/** A flat mesh on the ground: corners in W at z = 0, three for each triangle, all facing up. */
export interface FlatMesh {
  readonly positions: Float32Array;
  readonly colours: Float32Array; // linear, 3 for each corner
}

/** Colours of the road in one theme. */
export type RoadPaint = Palette['road'];

const BLACK = colourOf('#15181d');

/** Widths of the edge line and the verge, and length of a block of a kerb; chosen. */
const EDGE_LINE_M = 0.16;
const VERGE_M = 7;
const KERB_BLOCK_M = 1.4;
/** Radius below which bends have kerbs in red and white [m]; elsewhere kerbs are plain concrete; chosen. */
export const KERB_RADIUS_M = 130;

/** Collects the triangles of a flat mesh. */
class Flat {
  readonly positions: number[] = [];
  readonly colours: number[] = [];

  /** Corners counter-clockwise seen from above. */
  quad(a: Point, b: Point, c: Point, d: Point, colour: Colour): void {
    for (const { x, y } of [a, b, c, a, c, d]) {
      this.positions.push(x, y, 0);
      this.colours.push(...colour);
    }
  }

  data(): FlatMesh {
    return { positions: new Float32Array(this.positions), colours: new Float32Array(this.colours) };
  }
}

const distance = (a: Point, b: Point): number => Math.hypot(b.x - a.x, b.y - a.y);
const between = (a: Point, b: Point, share: number): Point => ({
  x: a.x + (b.x - a.x) * share,
  y: a.y + (b.y - a.y) * share,
});

/** `metres` from `from` towards `to`, or away from it when negative. */
function towards(from: Point, to: Point, metres: number): Point {
  const length = distance(from, to);
  return length > 0 ? between(from, to, metres / length) : from;
}

/**
 * The lines without repeated points; on a closed road the first point is repeated at the end, whether or not the server
 * repeats it, so that the seam has no gap. Null without a road.
 */
export function tidyLines(lines: RoadLines, isClosed: boolean): RoadLines | null {
  const count = Math.min(lines.left.length, lines.right.length, lines.centre.length);
  const kept: number[] = [];
  for (let i = 0; i < count; ++i) {
    const [here, before] = [lines.centre[i], lines.centre[kept.at(-1) ?? -1]];
    if (here && Number.isFinite(here.x + here.y) && !(before && distance(here, before) < 1e-3)) kept.push(i);
  }
  const [first, last] = [lines.centre[kept[0] ?? -1], lines.centre[kept.at(-1) ?? -1]];
  if (kept.length < 2 || !first || !last) return null;
  if (isClosed && kept.length > 2) {
    if (distance(first, last) < 0.05) kept.pop();
    kept.push(kept[0] ?? 0);
  }
  const pick = (points: readonly Point[]): Point[] => kept.map((i) => points[i] ?? { x: NaN, y: NaN });
  return { left: pick(lines.left), right: pick(lines.right), centre: pick(lines.centre) };
}

/** Adds the band between two lines with equally many points, `left` on the left of `right`. */
function addBand(flat: Flat, left: readonly Point[], right: readonly Point[], colour: Colour): Flat {
  for (let i = 0; i + 1 < left.length; ++i)
    flat.quad(left[i] as Point, right[i] as Point, right[i + 1] as Point, left[i + 1] as Point, colour);
  return flat;
}

/** Curvature at each point from its neighbours a few points before and behind; left positive [1/m]. */
export function curvatures(centre: readonly Point[], isClosed: boolean): Float64Array {
  const count = centre.length;
  const result = new Float64Array(count);
  const reach = 3; // points: suppresses the noise of single points
  const distinct = isClosed ? count - 1 : count;
  const at = (i: number): Point => centre[isClosed ? mod(i, distinct) : Math.min(Math.max(i, 0), count - 1)] as Point;
  for (let i = 0; i < count; ++i) {
    const [a, b, c] = [at(i - reach), at(i), at(i + reach)];
    const cross = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
    const product = distance(a, b) * distance(b, c) * distance(a, c);
    result[i] = product > 0 ? (2 * cross) / product : 0; // of the circle through three points
  }
  return result;
}

/** Adds dashes of `dash` metres along the centre line, with gaps between them. */
function addDashes(flat: Flat, lines: RoadLines, dash: number, gap: number, width: number, colour: Colour): void {
  const s = lengthsOf(lineOf(lines.centre));
  for (let i = 0; i + 1 < lines.centre.length; ++i) {
    const [from, to] = [s[i] ?? 0, s[i + 1] ?? 0];
    const [a, b] = [lines.centre[i] as Point, lines.centre[i + 1] as Point];
    const [k, m] = [lines.left[i] as Point, lines.left[i + 1] as Point];
    for (let start = Math.floor(from / (dash + gap)) * (dash + gap); start < to; start += dash + gap) {
      const [low, high] = [Math.max(start, from), Math.min(start + dash, to)];
      if (high <= low) continue;
      const [p, q] = [(low - from) / (to - from), (high - from) / (to - from)];
      const [here, next, side, nextSide] = [between(a, b, p), between(a, b, q), between(k, m, p), between(k, m, q)];
      const half = width / 2;
      flat.quad(
        towards(here, side, half),
        towards(here, side, -half),
        towards(next, nextSide, -half),
        towards(next, nextSide, half),
        colour,
      );
    }
  }
}

/** Adds chequers across the first point of the road. */
function addStart(flat: Flat, lines: RoadLines, white: Colour): void {
  const [left, right, centre, next] = [lines.left[0], lines.right[0], lines.centre[0], lines.centre[1]];
  if (!left || !right || !centre || !next) return;
  const columns = Math.max(4, Math.round(distance(left, right) / 0.7));
  const [dx, dy] = [(next.x - centre.x) / distance(centre, next), (next.y - centre.y) / distance(centre, next)];
  const place = (column: number, row: number): Point => {
    const across = between(left, right, column / columns);
    return { x: across.x + dx * 0.7 * row, y: across.y + dy * 0.7 * row };
  };
  for (let row = -1; row < 1; ++row) {
    for (let i = 0; i < columns; ++i) {
      flat.quad(
        place(i, row),
        place(i + 1, row),
        place(i + 1, row + 1),
        place(i, row + 1),
        (i + row) % 2 === 0 ? white : BLACK,
      );
    }
  }
}

/** Where kerbs are red and white: in bends and a few points before and after. */
function isPainted(bend: Float64Array, isClosed: boolean): boolean[] {
  const reach = 4; // points
  const count = bend.length;
  const isTight = (i: number): boolean => Math.abs(bend[isClosed ? (i + count) % count : i] ?? 0) * KERB_RADIUS_M > 1;
  return Array.from(bend, (_, i) => Array.from({ length: 2 * reach + 1 }, (_each, k) => i + k - reach).some(isTight));
}

/** Adds the kerb outside one edge, in blocks of equal length. `side` is the edge, `other` the opposite one. */
function addKerb(
  flat: Flat,
  side: readonly Point[],
  other: readonly Point[],
  painted: readonly boolean[],
  width: number,
  isLeft: boolean,
  paint: RoadPaint,
): void {
  const s = lengthsOf(lineOf(side));
  for (let i = 0; i + 1 < side.length; ++i) {
    const [a, b] = [side[i] as Point, side[i + 1] as Point];
    const [outerA, outerB] = [towards(a, other[i] as Point, -width), towards(b, other[i + 1] as Point, -width)];
    const [from, to] = [s[i] ?? 0, s[i + 1] ?? 0];
    for (let start = from; start < to - 1e-9; ) {
      const block = Math.floor(start / KERB_BLOCK_M + 1e-6);
      const end = painted[i] ? Math.min(to, (block + 1) * KERB_BLOCK_M) : to;
      const colour = !painted[i] ? paint.concrete : block % 2 === 0 ? paint.kerbRed : paint.kerbWhite;
      const [p, q] = [(start - from) / (to - from), (end - from) / (to - from)];
      const [inner, innerNext, outer, outerNext] = [
        between(a, b, p),
        between(a, b, q),
        between(outerA, outerB, p),
        between(outerA, outerB, q),
      ];
      if (isLeft) flat.quad(outer, inner, innerNext, outerNext, colour);
      else flat.quad(inner, outer, outerNext, innerNext, colour);
      start = end;
    }
  }
}

/** The meshes on the ground, in drawing order. */
export interface RoadMeshes {
  readonly verge: FlatMesh;
  readonly kerbs: FlatMesh;
  readonly surface: FlatMesh;
  readonly lines: FlatMesh;
}

/**
 * `lines` as tidyLines() returns them; `kerb` is the width of the kerbs, none at 0 [m]. Paint on the road has `size` of
 * a full-size road's, the scale of the car.
 */
export function roadMeshes(lines: RoadLines, isClosed: boolean, kerb: number, paint: RoadPaint, size = 1): RoadMeshes {
  if (size === 1) return fullSizeMeshes(lines, isClosed, kerb, paint);
  const grown = (points: readonly Point[]): Point[] => points.map(({ x, y }) => ({ x: x / size, y: y / size }));
  const { left, right, centre } = lines;
  const full = { left: grown(left), right: grown(right), centre: grown(centre) };
  const meshes = fullSizeMeshes(full, isClosed, kerb / size, paint);
  for (const { positions } of [meshes.verge, meshes.kerbs, meshes.surface, meshes.lines])
    for (let i = 0; i < positions.length; ++i) positions[i] = (positions[i] ?? NaN) * size;
  return meshes;
}

/** The meshes of a road for full-size cars. */
function fullSizeMeshes(lines: RoadLines, isClosed: boolean, kerb: number, paint: RoadPaint): RoadMeshes {
  const { left, right, centre } = lines;
  const offset = (from: readonly Point[], to: readonly Point[], metres: number): Point[] =>
    from.map((point, i) => towards(point, to[i] as Point, metres));
  const kerbs = new Flat();
  if (kerb > 0) {
    const painted = isPainted(curvatures(centre, isClosed), isClosed);
    addKerb(kerbs, left, right, painted, kerb, true, paint);
    addKerb(kerbs, right, left, painted, kerb, false, paint);
  }
  const paintedLines = new Flat();
  addBand(paintedLines, left, offset(left, right, EDGE_LINE_M), paint.edge);
  addBand(paintedLines, offset(right, left, EDGE_LINE_M), right, paint.edge);
  addDashes(paintedLines, lines, 3, 6, 0.12, paint.centreLine);
  addStart(paintedLines, lines, paint.kerbWhite);
  return {
    verge: addBand(new Flat(), offset(left, right, -VERGE_M), offset(right, left, -VERGE_M), paint.verge).data(),
    kerbs: kerbs.data(),
    surface: addBand(new Flat(), left, right, paint.road).data(),
    lines: paintedLines.data(),
  };
}
