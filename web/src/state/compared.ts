import { computed } from '@preact/signals';
import { store } from '../lib/store';
import type { Lap } from '../protocol/topics';
import { type Corner, cornersOf } from './corners';
import type { LapChannel, LapSamples } from './lap_samples';
import { bestsOf, type LapBests } from './lap_table';
import { lapSamples, laps, sampledLaps } from './laps';
import { limit, limitChannel } from './limit';
import { channelOnto, isSameRoad, type OtherLap, otherLaps } from './other_laps';
import { road } from './road';
import type { Losses, MarkedCorner } from './road_marks';
import { run } from './run';
import { miniSectors, numbered, type Stretch, type TwoLaps } from './time_won';

// The laps that are compared, and what is known of them along the road. Each has a number: laps of the run count from
// 1, the limit is 0, laps of other recordings are below 0.

/** Number of the limit, the fastest possible lap, beside those of laps, which count from 1. */
export const LIMIT = 0;

/** The laps to compare, by number; null for the default: the newest against the best. */
export const chosen = store.signal<readonly [number | null, number | null]>('run', [null, null]);

/** Laps that are drawn beside these two, by number. */
export const overlaid = store.signal<readonly number[]>('run', []);

export function toggleOverlaid(number: number): void {
  const all = overlaid.value;
  overlaid.value = all.includes(number) ? all.filter((each) => each !== number) : [...all, number];
}

const otherOf = (number: number): OtherLap | undefined => otherLaps.value.find((each) => each.number === number);

/** "lap 3", "limit", "lap 2 of wet.mcap" */
export function lapName(number: number): string {
  if (number === LIMIT) return 'limit';
  const other = number < 0 ? otherOf(number) : undefined;
  return other ? `lap ${other.lap} of ${other.recording}` : `lap ${number}`;
}

/** The pair shown: the laps chosen, else the newest complete lap against the best, or against the one before it. */
function pairOf(all: readonly Lap[], bests: LapBests): [number, number] {
  const seen = all.filter(({ lap }) => lapSamples.laps.includes(lap - 1)).map(({ lap }) => lap);
  const newest = seen.at(-1) ?? all.at(-1)?.lap ?? -1;
  const isOther = ({ lap }: Lap): boolean => lap !== newest;
  const other =
    bests.lap !== newest && seen.includes(bests.lap)
      ? bests.lap
      : (seen.at(-2) ?? all.filter(isOther).at(-1)?.lap ?? newest);
  const isKnown = (lap: number | null): lap is number =>
    (lap === LIMIT && limit.value !== null) ||
    all.some((each) => each.lap === lap) ||
    otherLaps.value.some(({ number, samples }) => number === lap && isSameRoad(samples, lapSamples));
  return [isKnown(chosen.value[0]) ? chosen.value[0] : newest, isKnown(chosen.value[1]) ? chosen.value[1] : other];
}

export const pair = computed<readonly [number, number]>(() => {
  void sampledLaps.value;
  return pairOf(laps.value, bestsOf(laps.value));
});

/** A channel of a lap from the start line on; null where this page has not seen it. */
export function samplesOf(number: number, name: LapChannel): Float64Array | null {
  if (number > 0) return lapSamples.channel(number - 1, name);
  if (number === LIMIT) return limit.value && limitChannel(limit.value, lapSamples, name);
  const other = otherOf(number);
  return other ? channelOnto(other, name, lapSamples) : null;
}

function timeOf(number: number): number {
  if (number === LIMIT) return limit.value?.lap_time_s ?? NaN;
  if (number < 0) return otherOf(number)?.time ?? NaN;
  return laps.value.find(({ lap }) => lap === number)?.lap_time_s ?? NaN;
}

/** All laps that are drawn along the road: A, B, and those beside them. */
export const drawn = computed<readonly number[]>(() => {
  void sampledLaps.value;
  const beside = overlaid.value.filter((number) => !pair.value.includes(number) && samplesOf(number, 'time_s'));
  return [...pair.value, ...beside];
});

/** A lap along the road. */
export interface DrivenLap {
  readonly total: number; // [s]
  readonly time: Float64Array | null;
  readonly speed: Float64Array | null;
}

const drivenLap = (number: number): DrivenLap => ({
  total: timeOf(number),
  time: samplesOf(number, 'time_s'),
  speed: samplesOf(number, 'speed_mps'),
});

/** Two laps at the points of `samples`; null where one of them is not known. */
export function along(samples: LapSamples, [a, b]: readonly [DrivenLap, DrivenLap]): TwoLaps | null {
  if (!a.time || !b.time || !a.speed || !b.speed) return null;
  return {
    s: Float64Array.from({ length: samples.points }, (_, point) => samples.s(point)),
    length: samples.length,
    time: [a.time, b.time],
    speed: [a.speed, b.speed],
    total: a.total - b.total,
  };
}

/** Both laps along the road; null where one of them is not known, or both are the same. */
export const twoLaps = computed<TwoLaps | null>(() => {
  void sampledLaps.value;
  const [a, b] = pair.value;
  return a === b ? null : along(lapSamples, [drivenLap(a), drivenLap(b)]);
});

/** Names of the compared laps whose course this page does not have. */
export const forgotten = computed<readonly string[]>(() => {
  void sampledLaps.value;
  const [a, b] = pair.value;
  return a === b ? [] : [a, b].filter((each) => each > 0 && samplesOf(each, 'time_s') === null).map(lapName);
});

const known = store.data('page', () => ({ of: null as object | null, corners: [] as readonly Corner[] }));

/** The corners of the road, found once for each road. */
export function roadCorners(): readonly Corner[] {
  const { centre } = road.lines;
  if (known.of !== centre) Object.assign(known, { of: centre, corners: cornersOf(centre) });
  return known.corners;
}

/** Where laps begin, along the centre line [m]; its first point as long as no lap has begun. */
export function startLine(samples: LapSamples = lapSamples): number {
  const place = samples.place(0) - samples.s(0);
  return Number.isFinite(place) ? place : 0;
}

const marked = store.data('page', () => ({
  of: null as readonly Corner[] | null,
  line: NaN,
  corners: [] as readonly MarkedCorner[],
}));

/** The corners with their numbers, by distance from the start line. */
export function markedCorners(): readonly MarkedCorner[] {
  const [corners, line] = [roadCorners(), startLine()];
  if (marked.of !== corners || marked.line !== line) {
    const length = run.value?.track_length_m ?? NaN;
    const all = length > 0 ? numbered(corners, line, length) : [];
    Object.assign(marked, { of: corners, line, corners: all.map((corner, i) => ({ ...corner, number: i + 1 })) });
  }
  return marked.corners;
}

/** The end of the colour scale: what nine of ten pieces do not reach [s]. */
export function scaleOf(pieces: readonly Stretch[]): number {
  const sizes = pieces.map(({ lost }) => Math.abs(lost)).filter(Number.isFinite);
  sizes.sort((a, b) => a - b);
  return Math.max(0.01, sizes[Math.floor(0.9 * sizes.length)] ?? 0);
}

/** The line of the first lap by what it loses on it; null where the laps are not known. */
export const lossesNow = computed<Losses | null>(() => {
  const two = twoLaps.value;
  const [x, y] = (['x_m', 'y_m'] as const).map((name) => samplesOf(pair.value[0], name));
  if (!two || !x || !y) return null;
  const pieces = miniSectors(two);
  const indexOf = (place: number): number => Math.round((place / two.length) * x.length);
  return {
    line: { x, y },
    pieces: pieces.map(({ from, to, lost }) => ({ first: indexOf(from), end: indexOf(to), lost })),
    most: scaleOf(pieces),
  };
});
