import { fixed } from '../lib/format';
import { mod } from '../lib/math';
import { type SpeedUnit, speedUnit } from '../lib/units';
import { capital } from '../lib/words';
import type { Limit } from '../protocol/topics';
import type { Corner } from './corners';
import type { LapChannel } from './lap_samples';

// A against B along the road: two courses of one lap, the gap between them, and what each corner costs.

/** One lap as a function of the distance from the start line: driven, recorded, computed, or the limit. */
export interface Course {
  /** Distinguishes it from all others that can be chosen: 'lap 3', 'limit', 'wet.mcap 2', 'what if'. */
  readonly id: string;
  readonly name: string; // in a sentence: "lap 3", "the limit"
  readonly total: number; // [s]
  /** Whether it begins at standstill. */
  readonly isStanding: boolean;
  /** A channel at the points of the lap samples, not-a-number where unknown; null where it has none. */
  channel(name: LapChannel): Float64Array | null;
}

/** A corner with the road before and behind it, up to the middles of its straights; distances from the line [m]. */
export interface CornerCost {
  readonly name: string; // "T4"
  readonly from: number;
  readonly entry: number;
  readonly apex: number;
  readonly exit: number;
  readonly to: number;
  /** Time that A loses to B between `from` and `to` [s]; negative: wins. */
  readonly lost: number;
  /** Least speed in the bend, A less B [m/s]. */
  readonly slower: number;
  /** Where A begins to slow down, before where B does [m]; not-a-number where one of them does not. */
  readonly earlier: number;
}

/** A comparison of two courses. */
export interface Comparison {
  readonly a: Course;
  readonly b: Course;
  readonly s: Float64Array; // distance of each point from the line [m]
  readonly length: number; // of the lap [m]
  /** Time that A is behind B at each point [s]. */
  readonly gap: Float64Array;
  /** The gap at the end of the lap, or where the shorter of both ends [s]. */
  readonly total: number;
  /** By distance from the line. */
  readonly corners: readonly CornerCost[];
}

/** Time that `a` is behind `b` at each point [s]; all gaps on the page are computed here. */
export const timeGap = (a: Float64Array, b: Float64Array): Float64Array => a.map((time, i) => time - (b[i] ?? NaN));

/** A road as far as laps on it are compared; `line`: where laps begin along its centre line [m]. */
export interface ComparedRoad {
  readonly samples: { readonly length: number; readonly points: number; s(point: number): number };
  readonly corners: readonly Corner[];
  readonly line: number;
}

/** A against B; null where the course of one of them is not known. */
export function compare(a: Course, b: Course, { samples, corners, line }: ComparedRoad): Comparison | null {
  const [timeA, timeB] = [a.channel('time_s'), b.channel('time_s')];
  if (!timeA || !timeB) return null;
  const gap = timeGap(timeA, timeB);
  const along = {
    a,
    b,
    s: Float64Array.from({ length: samples.points }, (_, point) => samples.s(point)),
    length: samples.length,
    gap,
    total: endOf(a.total - b.total, gap),
  };
  return { ...along, corners: cornerCosts(along, corners, line) };
}

/** The gap at the end of the lap, or where the shorter of both ends [s]. */
const endOf = (total: number, gap: Float64Array): number =>
  Number.isFinite(total) ? total : (Array.from(gap).reverse().find(Number.isFinite) ?? NaN);

/** A comparison before its corners are known. */
type Along = Omit<Comparison, 'corners'>;

/** What A has lost up to a distance from the line [s]. */
export function lostAt({ s, length, gap, total }: Along, place: number): number {
  const last = s.length - 1;
  if (place <= 0) return 0;
  const end = Number.isFinite(total) ? total : (gap[last] ?? NaN);
  if (place >= length - 1e-6) return end;
  const at = (place - (s[0] ?? 0)) / (length / s.length);
  if (at <= 0) return gap[0] ?? NaN;
  const i = Math.min(last, Math.floor(at));
  const here = gap[i] ?? NaN;
  return here + ((i === last ? end : (gap[i + 1] ?? NaN)) - here) * (at - i);
}

/** A stretch of the lap, and what A loses on it. */
export interface Stretch {
  readonly from: number; // from the line [m]
  readonly to: number;
  readonly lost: number; // [s]
}

/** The lap in pieces of about `each` metres. */
export function stretches(along: Along, each: number): Stretch[] {
  const count = Math.max(1, Math.round(along.length / each));
  return Array.from({ length: count }, (_, i) => {
    const [from, to] = [(i * along.length) / count, ((i + 1) * along.length) / count];
    return { from, to, lost: lostAt(along, to) - lostAt(along, from) };
  });
}

/** The end of the colour scale: nine of ten pieces lose less than this [s]. */
export function scaleOf(pieces: readonly Stretch[]): number {
  const sizes = pieces.map(({ lost }) => Math.abs(lost)).filter(Number.isFinite);
  sizes.sort((a, b) => a - b);
  return Math.max(0.01, sizes[Math.floor(0.9 * sizes.length)] ?? 0);
}

const LEAST_BRAKING_MPS = 1; // loss of speed that counts as slowing down; chosen

/** Index of the point at a distance from the line [m]. */
export const pointAt = ({ s, length }: Pick<Along, 's' | 'length'>, place: number): number =>
  Math.min(s.length - 1, Math.max(0, Math.round((place / length) * s.length)));

/** Where a course is fastest before the apex, that is, begins to slow down [m]; NaN where it does not slow down. */
function slowsAt(along: Along, speed: Float64Array, from: number, apex: number): number {
  const first = pointAt(along, from);
  const speeds = speed.subarray(first, pointAt(along, apex) + 1);
  let best = 0;
  speeds.forEach((each, i) => {
    if (each >= (speeds[best] ?? NaN)) best = i;
  });
  const drop = (speeds[best] ?? NaN) - (speeds.at(-1) ?? NaN);
  return drop >= LEAST_BRAKING_MPS ? (along.s[first + best] ?? NaN) : NaN;
}

/** The corners by their distance from the start line, at `line` along the road's centre line [m]. */
export function numbered(corners: readonly Corner[], line: number, length: number): (Corner & { at: number })[] {
  return corners.map((corner) => ({ ...corner, at: mod(corner.apex - line, length) })).sort((a, b) => a.at - b.at);
}

/** What A loses in each corner, with the straights halved between their corners. */
function cornerCosts(along: Along, corners: readonly Corner[], line: number): CornerCost[] {
  const { length, a, b } = along;
  const none = new Float64Array();
  const [speedA, speedB] = [a.channel('speed_mps') ?? none, b.channel('speed_mps') ?? none];
  const all = numbered(corners, line, length).map(({ from, to, apex, at }) => {
    return {
      apex: at,
      entry: Math.max(0, at - mod(apex - from, length)),
      exit: Math.min(length, at + mod(to - apex, length)),
    };
  });
  const middle = (i: number): number =>
    i < 0 ? 0 : i + 1 >= all.length ? length : ((all[i]?.exit ?? 0) + (all[i + 1]?.entry ?? 0)) / 2;
  return all.map((corner, i) => {
    const [from, to] = [middle(i - 1), middle(i)];
    const [entry, exit] = [Math.max(from, corner.entry), Math.min(to, corner.exit)];
    const slowest = (speed: Float64Array): number =>
      speed.subarray(pointAt(along, entry), pointAt(along, exit) + 1).reduce((x, y) => Math.min(x, y), Infinity);
    return {
      name: `T${i + 1}`,
      from,
      entry,
      apex: corner.apex,
      exit,
      to,
      lost: lostAt(along, to) - lostAt(along, from),
      slower: slowest(speedB) - slowest(speedA),
      earlier: slowsAt(along, speedB, from, corner.apex) - slowsAt(along, speedA, from, corner.apex),
    };
  });
}

/** The corners, those that decide the comparison first: the order of table and sentence. */
export function byCost({ corners, total }: Comparison): CornerCost[] {
  const sense = total < 0 ? -1 : 1;
  const known = corners.filter(({ lost }) => Number.isFinite(lost));
  return known.sort((one, other) => sense * (other.lost - one.lost));
}

/** Differences below these are not mentioned: what two decimals round to zero [s], and chosen ones. */
const SAME_S = 0.005;
const SAME_MPS = 0.3;
const SAME_M = 4; // braking points are not known more precisely

/** A difference in time with its sign, as sentence, table and plot show it: "+1.08". */
export const signed = (seconds: number): string =>
  `${seconds >= SAME_S ? '+' : ''}${Math.abs(seconds) < SAME_S ? '0.00' : fixed(seconds, 2)}`;

/** 'lost', 'won', or neither. */
export const toneOf = (lost: number): 'lost' | 'won' | '' => (lost >= SAME_S ? 'lost' : lost <= -SAME_S ? 'won' : '');

/** "20 mph slower, slows 8 m early" */
export function whyOf({ lost, slower, earlier }: CornerCost, unit: SpeedUnit = speedUnit()): string {
  const pace = Math.round(Math.abs(slower) * unit.perMps);
  const parts = [
    Math.abs(slower) >= SAME_MPS && pace >= 1 ? `${pace} ${unit.name} ${slower > 0 ? 'slower' : 'faster'}` : '',
    Math.abs(earlier) >= SAME_M ? `slows ${fixed(Math.abs(earlier), 0)} m ${earlier > 0 ? 'early' : 'late'}` : '',
  ].filter((part) => part !== '');
  if (parts.length > 0) return parts.join(', ');
  return toneOf(lost) === '' ? 'the same' : 'another line';
}

/** "Lap 3 lost 3.45 s to the limit; T4 cost most, 1.08 s.", in parts: A and B are between them. */
export interface Headline {
  readonly verb: string; // " lost ", ", from standstill, lost "
  readonly amount: string; // "3.45 s"
  readonly tone: 'lost' | 'won' | '';
  readonly to: string; // " to "
  readonly rest: string; // "; T4 cost most, 1.08 s."
}

/** The sentence of a comparison. */
export function headlineOf(comparison: Comparison): Headline {
  const { a, b, total } = comparison;
  const tone = toneOf(total);
  const from = a.isStanding && !b.isStanding ? ', from standstill,' : '';
  if (!Number.isFinite(total))
    return { verb: `${from} beside `, amount: '', tone: '', to: '', rest: ': one of them is not known to its end.' };
  if (tone === '') return { verb: `${from} took as long as `, amount: '', tone, to: '', rest: '.' };
  const most = byCost(comparison)[0];
  const rest =
    most && toneOf(most.lost) === tone
      ? `; ${most.name} ${tone === 'lost' ? 'cost' : 'gave'} most, ${fixed(Math.abs(most.lost), 2)} s.`
      : '.';
  const amount = `${fixed(Math.abs(total), 2)} s`;
  return tone === 'lost'
    ? { verb: `${from} lost `, amount, tone, to: ' to ', rest }
    : { verb: `${from} won `, amount, tone, to: ' from ', rest };
}

/** A cause of the gap to the limit, and how much faster a lap is without it [s]. Causes do not add up. */
export interface GapCause {
  readonly name: string;
  readonly faster: number;
}

/** Causes in words, by the names that the program sends. */
const CAUSES: Readonly<Record<string, string>> = {
  latency: 'the delay',
  'grip reserve': 'its grip reserve',
  'edge margin': 'its margin to the edge',
  guard: 'the guard',
};

/** The causes, what costs `best`, the best lap [s], most first; empty where it was not driven without (--explain). */
export function causesOf(limit: Limit, best: number): GapCause[] {
  return limit.without
    .map((name, i) => ({
      name: CAUSES[name] ?? `its ${name}`,
      faster: best - (limit.without_lap_times_s[i] ?? NaN),
    }))
    .filter(({ faster }) => Number.isFinite(faster))
    .sort((one, other) => other.faster - one.faster);
}

/** "Without its grip reserve the best lap would be 0.81 s faster, without the guard 0.30 s. …" */
export function causesText(causes: readonly GapCause[]): string {
  const costly = causes.filter(({ faster }) => faster >= SAME_S);
  const free = causes.filter(({ faster }) => faster < SAME_S);
  const parts = costly.map(({ name, faster }, i) =>
    i === 0
      ? `Without ${name} the best lap would be ${fixed(faster, 2)} s faster`
      : `without ${name} ${fixed(faster, 2)} s`,
  );
  const names = free.map(({ name }) => name).join(' and ');
  return [
    parts.length > 0 ? `${parts.join(', ')}.` : '',
    names === '' ? '' : `${capital(names)} ${free.length > 1 ? 'cost' : 'costs'} nothing.`,
  ]
    .filter((each) => each !== '')
    .join(' ');
}
