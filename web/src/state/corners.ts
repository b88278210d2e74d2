import { mod, type Point, wrapAngle } from '../lib/math';

// The corners of a road, found from its centre line.

/** Places are distances along the centre line from its first point [m], within one lap. */
export interface Corner {
  readonly from: number;
  readonly to: number; // less than `from` where the corner crosses the first point of a closed road
  readonly apex: number; // where the road bends most
  readonly turn: number; // change of heading [rad], left positive
}

/** Distance of samples of the curvature, and how many of them are averaged; chosen. */
const SPACING_M = 2;
const SMOOTHED_OVER = 7;
/** Curvature below which the road is straight for a car at racing speed [1/m]; chosen. */
const LEAST_CURVATURE = 1 / 220;
/** Length of straight road below which two bends to the same side are one corner [m]; chosen. */
const SAME_CORNER_M = 20;
/** Turn below which a bend is no corner [rad]; chosen. */
const LEAST_TURN = 0.3;

/** Curvature of a closed road at equal distances. */
interface Sampled {
  readonly spacing: number; // [m]
  readonly curvature: Float64Array; // [1/m], left positive
}

/** Samples the headings at equal distances, and averages their changes over 14 m of road; null for a short line. */
function sampled(points: readonly Point[]): Sampled | null {
  const steps = points.slice(1).map((point, i) => {
    const before = points[i] ?? point;
    const [dx, dy] = [point.x - before.x, point.y - before.y];
    return { length: Math.hypot(dx, dy), heading: Math.atan2(dy, dx) };
  });
  const length = steps.reduce((sum, step) => sum + step.length, 0);
  const count = Math.round(length / SPACING_M);
  if (!(count > SMOOTHED_OVER)) return null;
  const spacing = length / count;
  // The heading of the road at each place: between the middles of two steps it changes linearly.
  const middles: { s: number; heading: number }[] = [];
  let [s, last] = [0, steps[0]?.heading ?? 0];
  for (const step of steps) {
    if (step.length === 0) continue;
    last += wrapAngle(step.heading - last);
    middles.push({ s: s + step.length / 2, heading: last });
    s += step.length;
  }
  const first = middles[0];
  if (!first) return null;
  const round = last + wrapAngle(first.heading - last);
  const all = [...middles, { s: first.s + length, heading: round }];
  const headings = new Float64Array(count + 1);
  for (let i = 0, at = 0; i <= count; ++i) {
    const place = Math.max(first.s, i * spacing);
    while (at + 2 < all.length && (all[at + 1]?.s ?? 0) < place) ++at;
    const [a, b] = [all[at] ?? first, all[at + 1] ?? first];
    headings[i] = a.heading + ((b.heading - a.heading) * (place - a.s)) / (b.s - a.s || 1);
  }
  const raw = Float64Array.from({ length: count }, (_, i) => ((headings[i + 1] ?? 0) - (headings[i] ?? 0)) / spacing);
  const half = (SMOOTHED_OVER - 1) / 2;
  const curvature = raw.map((_, i) => {
    let sum = 0;
    for (let k = -half; k <= half; ++k) sum += raw[mod(i + k, count)] ?? 0;
    return sum / SMOOTHED_OVER;
  });
  return { spacing, curvature };
}

/** The corners of a closed road in the order of its centre line, whose last point repeats the first. */
export function cornersOf(centre: readonly Point[]): Corner[] {
  const road = sampled(centre);
  if (!road) return [];
  const { spacing, curvature } = road;
  const count = curvature.length;
  const at = (i: number): number => curvature[mod(i, count)] ?? 0;
  const sideAt = (i: number): number => (Math.abs(at(i)) < LEAST_CURVATURE ? 0 : Math.sign(at(i)));
  // From a place on, where the road is straight or changes its side: no corner is cut in two.
  const begin = Array.from({ length: count }, (_, i) => i).find((i) => sideAt(i) === 0 || sideAt(i - 1) !== sideAt(i));
  if (begin === undefined) return [];
  const bends: { first: number; end: number; side: number }[] = [];
  for (let i = begin; i < begin + count; ++i) {
    const [side, last] = [sideAt(i), bends.at(-1)];
    if (side === 0) continue;
    if (last?.side === side && (i - last.end) * spacing < SAME_CORNER_M) last.end = i + 1;
    else bends.push({ first: i, end: i + 1, side });
  }
  return bends.flatMap(({ first, end }) => {
    let [turn, apex] = [0, first];
    for (let i = first; i < end; ++i) {
      turn += at(i) * spacing;
      if (Math.abs(at(i)) > Math.abs(at(apex))) apex = i;
    }
    const placeOf = (i: number): number => (i % count) * spacing;
    return Math.abs(turn) < LEAST_TURN ? [] : [{ from: placeOf(first), to: placeOf(end), apex: placeOf(apex), turn }];
  });
}
