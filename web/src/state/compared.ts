import { computed, signal } from '@preact/signals';
import type { Lap } from '../protocol/topics';
import { type Corner, cornersOf } from './corners';
import type { LapChannel, LapSamples } from './lap_samples';
import { bestsOf, type LapBests } from './lap_table';
import { lapSamples, laps, sampledLaps } from './laps';
import { limit, limitChannel } from './limit';
import { road } from './road';
import type { Losses, MarkedCorner } from './road_marks';
import { run } from './run';
import { miniSectors, numbered, type Stretch, type TwoLaps } from './time_won';

// The two laps that are compared, and what is known of both along the road.

/** Number of the limit, the fastest possible lap, beside those of laps, which count from 1. */
export const LIMIT = 0;

/** The laps to compare, by number; null for the default: the newest against the best. */
export const chosen = signal<readonly [number | null, number | null]>([null, null]);

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
    (lap === LIMIT && limit.value !== null) || all.some((each) => each.lap === lap);
  return [isKnown(chosen.value[0]) ? chosen.value[0] : newest, isKnown(chosen.value[1]) ? chosen.value[1] : other];
}

export const pair = computed<readonly [number, number]>(() => {
  void sampledLaps.value;
  return pairOf(laps.value, bestsOf(laps.value));
});

/** A channel of a lap, or of the limit, from the start line on; null where this page has not seen it. */
export const samplesOf = (lap: number, name: LapChannel): Float64Array | null =>
  lap !== LIMIT ? lapSamples.channel(lap - 1, name) : limit.value && limitChannel(limit.value, lapSamples, name);

const timeOf = (number: number): number =>
  number === LIMIT
    ? (limit.value?.lap_time_s ?? NaN)
    : (laps.value.find(({ lap }) => lap === number)?.lap_time_s ?? NaN);

/** Both laps along the road; null where one of them is not known, or both are the same. */
export const twoLaps = computed<TwoLaps | null>(() => {
  void sampledLaps.value;
  const [a, b] = pair.value;
  if (a === b) return null;
  const [times, speeds] = (['time_s', 'speed_mps'] as const).map((name) => [samplesOf(a, name), samplesOf(b, name)]);
  const [[timeA, timeB], [speedA, speedB]] = [times ?? [], speeds ?? []];
  if (!timeA || !timeB || !speedA || !speedB) return null;
  return {
    s: Float64Array.from({ length: lapSamples.points }, (_, point) => lapSamples.s(point)),
    length: lapSamples.length,
    time: [timeA, timeB],
    speed: [speedA, speedB],
    total: timeOf(a) - timeOf(b),
  };
});

let known: { readonly of: object; readonly corners: readonly Corner[] } | null = null;

/** The corners of the road, found once for each road. */
export function roadCorners(): readonly Corner[] {
  const { centre } = road.lines;
  if (known?.of !== centre) known = { of: centre, corners: cornersOf(centre) };
  return known.corners;
}

/** Where laps begin, along the centre line [m]; its first point as long as no lap has begun. */
export function startLine(samples: LapSamples = lapSamples): number {
  const place = samples.place(0) - samples.s(0);
  return Number.isFinite(place) ? place : 0;
}

let marked: { of: readonly Corner[]; line: number; corners: MarkedCorner[] } | null = null;

/** The corners with their numbers, by distance from the start line. */
export function markedCorners(): readonly MarkedCorner[] {
  const [corners, line] = [roadCorners(), startLine()];
  if (marked?.of !== corners || marked.line !== line) {
    const length = run.value?.track_length_m ?? NaN;
    const all = length > 0 ? numbered(corners, line, length) : [];
    marked = { of: corners, line, corners: all.map((corner, i) => ({ ...corner, number: i + 1 })) };
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
  const known = twoLaps.value;
  const [x, y] = (['x_m', 'y_m'] as const).map((name) => samplesOf(pair.value[0], name));
  if (!known || !x || !y) return null;
  const pieces = miniSectors(known);
  const indexOf = (place: number): number => Math.round((place / known.length) * x.length);
  return {
    line: { x, y },
    pieces: pieces.map(({ from, to, lost }) => ({ first: indexOf(from), end: indexOf(to), lost })),
    most: scaleOf(pieces),
  };
});
