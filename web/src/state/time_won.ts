import type { Corner } from './corners';

// Where one lap loses time to another: by mini-sectors, and by corners with the cause.

/** Two laps at the same places, from the start line on. */
export interface TwoLaps {
  /** Distance of each point from the start line [m]. */
  readonly s: Float64Array;
  readonly length: number; // of the lap [m]
  readonly time: readonly [Float64Array, Float64Array]; // since the line [s]
  readonly speed: readonly [Float64Array, Float64Array]; // [m/s]
  /** What the first lap lost over the whole lap [s]; not-a-number where a lap time is not known. */
  readonly total: number;
}

/** A stretch of the lap, and what the first lap loses on it; negative: gains. */
export interface Stretch {
  readonly from: number; // from the start line [m]
  readonly to: number;
  readonly lost: number; // [s]
}

export const MINI_SECTOR_M = 25;

/** What the first lap has lost up to a distance from the line [s]. */
function lostAt({ s, length, time, total }: TwoLaps, place: number): number {
  const gap = (i: number): number => (time[0][i] ?? NaN) - (time[1][i] ?? NaN);
  const last = s.length - 1;
  if (place <= 0) return 0;
  const end = Number.isFinite(total) ? total : gap(last);
  if (place >= length - 1e-6) return end;
  const spacing = length / s.length;
  const at = (place - (s[0] ?? 0)) / spacing;
  if (at <= 0) return gap(0);
  const i = Math.min(last, Math.floor(at));
  return gap(i) + ((i === last ? end : gap(i + 1)) - gap(i)) * (at - i);
}

const stretch = (laps: TwoLaps, from: number, to: number): Stretch => ({
  from,
  to,
  lost: lostAt(laps, to) - lostAt(laps, from),
});

/** The lap in pieces of about 25 m. */
export function miniSectors(laps: TwoLaps, each = MINI_SECTOR_M): Stretch[] {
  const count = Math.max(1, Math.round(laps.length / each));
  return Array.from({ length: count }, (_, i) =>
    stretch(laps, (i * laps.length) / count, ((i + 1) * laps.length) / count),
  );
}

/** Why time is lost or gained: what it is, and by how much. */
export type Cause =
  | { readonly kind: 'braking' | 'way'; readonly metres: number }
  | { readonly kind: 'apex'; readonly mps: number }
  | { readonly kind: 'in' | 'out' };

/** A corner with the road before and behind it, up to the middles of its straights. */
export interface CornerTime extends Stretch {
  readonly number: number; // from 1, by distance from the start line
  readonly apex: number; // from the start line [m]
  /** The part that costs, or brings, most, and how much of it [s]. */
  readonly main: { readonly cause: Cause; readonly lost: number };
}

const EARLIER_M = 4; // braking points are no better known
const SLOWER_MPS = 0.3;
const LEAST_BRAKING_MPS = 1;

const indexOf = ({ s, length }: TwoLaps, place: number): number =>
  Math.min(s.length - 1, Math.max(0, Math.round((place / length) * s.length)));

/** Where a lap is fastest before the apex, and so begins to slow down [m]; NaN where it does not slow down. */
function slowsAt(laps: TwoLaps, which: 0 | 1, from: number, apex: number): number {
  const [first, end] = [indexOf(laps, from), indexOf(laps, apex)];
  const speeds = laps.speed[which].subarray(first, end + 1);
  let best = 0;
  speeds.forEach((speed, i) => {
    if (speed >= (speeds[best] ?? NaN)) best = i;
  });
  const drop = (speeds[best] ?? NaN) - (speeds.at(-1) ?? NaN);
  return drop >= LEAST_BRAKING_MPS ? (laps.s[first + best] ?? NaN) : NaN;
}

const slowestBetween = (laps: TwoLaps, which: 0 | 1, from: number, to: number): number =>
  laps.speed[which].subarray(indexOf(laps, from), indexOf(laps, to) + 1).reduce((a, b) => Math.min(a, b), Infinity);

interface Parts {
  readonly from: number;
  readonly entry: number;
  readonly apex: number;
  readonly exit: number;
  readonly to: number;
}

/** Of the three parts of a corner the one that costs most where it costs, or brings most where it brings. */
function mainOf(laps: TwoLaps, { from, entry, apex, exit, to }: Parts, lost: number): CornerTime['main'] {
  const parts = [stretch(laps, from, entry), stretch(laps, entry, exit), stretch(laps, exit, to)];
  const weight = (part: Stretch | undefined): number => (part?.lost ?? 0) * Math.sign(lost);
  const main = [0, 1, 2].reduce((a, b) => (weight(parts[b]) > weight(parts[a]) ? b : a));
  const part = parts[main]?.lost ?? NaN;
  const apexes = slowestBetween(laps, 0, entry, exit) - slowestBetween(laps, 1, entry, exit);
  const brakes = slowsAt(laps, 0, from, apex) - slowsAt(laps, 1, from, apex);
  const isBraking = lost > 0 ? brakes < -EARLIER_M : brakes > EARLIER_M;
  const isApex = lost > 0 ? apexes < -SLOWER_MPS : apexes > SLOWER_MPS;
  if (main === 0) return { cause: isBraking ? { kind: 'braking', metres: brakes } : { kind: 'in' }, lost: part };
  if (main === 2) return { cause: { kind: 'out' }, lost: part };
  if (isApex) return { cause: { kind: 'apex', mps: apexes }, lost: part };
  if (isBraking) return { cause: { kind: 'braking', metres: brakes }, lost: part };
  return { cause: { kind: 'way', metres: NaN }, lost: part };
}

/** The corners by their distance from the start line, at `line` along the road's centre line [m]. */
export function numbered(corners: readonly Corner[], line: number, length: number): (Corner & { at: number })[] {
  const from = (place: number): number => place - line - length * Math.floor((place - line) / length);
  return corners.map((corner) => ({ ...corner, at: from(corner.apex) })).sort((a, b) => a.at - b.at);
}

/** What the first lap loses in each corner, with the straights halved between their corners. */
export function cornerTimes(laps: TwoLaps, corners: readonly Corner[], line: number): CornerTime[] {
  const { length } = laps;
  const all = numbered(corners, line, length).map(({ from, to, apex, at }) => {
    const back = (a: number, b: number): number => a - b - length * Math.floor((a - b) / length);
    return { apex: at, entry: Math.max(0, at - back(apex, from)), exit: Math.min(length, at + back(to, apex)) };
  });
  const middle = (i: number): number =>
    i < 0 ? 0 : i + 1 >= all.length ? length : ((all[i]?.exit ?? 0) + (all[i + 1]?.entry ?? 0)) / 2;
  return all.map(({ apex, entry, exit }, i) => {
    const [from, to] = [middle(i - 1), middle(i)];
    const whole = stretch(laps, from, to);
    const parts = { from, entry: Math.max(from, entry), apex, exit: Math.min(to, exit), to };
    return { ...whole, number: i + 1, apex, main: mainOf(laps, parts, whole.lost) };
  });
}
