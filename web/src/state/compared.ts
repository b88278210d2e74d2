// The comparison on the page: the choice of A and B among laps, futures, recordings and the limit, and its cursor.
import { computed } from '@preact/signals';
import { store } from '../lib/store';
import {
  byCost,
  type ComparedRoad,
  type Comparison,
  type Course,
  compare,
  numbered,
  scaleOf,
  stretches,
} from './comparison';
import { type Corner, cornersOf } from './corners';
import { lapCourse, limitCourse, recordedCourse } from './courses';
import { bestOf } from './lap_table';
import { lapSamples, laps, sampledLaps } from './laps';
import { limit } from './limit';
import { isSameRoad, otherLaps } from './other_laps';
import { cursorPlace } from './plot_view';
import { raceCourses } from './rival';
import { road } from './road';
import type { Losses, MarkedCorner } from './road_marks';
import { run } from './run';
import { answer, futureNames } from './what_if';
import { type FutureGrid, futureCourses } from './what_if_answer';

/** The courses chosen as A and B, by id; null: the newest lap, and the limit. */
export const chosen = store.signal<readonly [string | null, string | null]>('run', [null, null]);

const LIMIT = 'limit'; // id of its course

/**
 * Points at which futures are sampled: those of the laps; before the start line is known, from the centre line's first
 * point.
 */
function gridNow(): FutureGrid {
  const isLineKnown = Number.isFinite(lapSamples.s(0));
  const { points } = lapSamples;
  const length = run.value?.track_length_m ?? NaN;
  return {
    length,
    points,
    s: (point) => (isLineKnown ? lapSamples.s(point) : (point * length) / points),
    driven: (lap, name) => lapSamples.channel(lap - 1, name) ?? (isLineKnown ? lapSamples.present(name) : null),
  };
}

/** Both futures of the newest answer. */
const futuresNow = (): Course[] => (answer.value ? futureCourses(answer.value, gridNow(), futureNames()) : []);

/** Both futures of the newest question, the run as it is against the changed one; null without an answer. */
export const futures = computed<Comparison | null>(() => {
  const [was, branch] = futuresNow();
  return was && branch ? compare(was, branch, roadNow()) : null;
});

/** Everything that can be compared here: laps of the run, the newest first, other futures, recordings, the limit. */
export const courses = computed<readonly Course[]>(() => {
  void sampledLaps.value;
  const known = new Set(lapSamples.laps);
  const own = laps.value.filter(({ lap }) => known.has(lap - 1)).map((lap) => lapCourse(lap, lapSamples));
  const recorded = otherLaps.value
    .filter(({ samples }) => isSameRoad(samples, lapSamples))
    .map((each) => recordedCourse(each, lapSamples));
  const fastest = limit.value && lapSamples.length > 0 ? [limitCourse(limit.value, lapSamples)] : [];
  return [...own.reverse(), ...futuresNow(), ...raceCourses(lapSamples), ...recorded, ...fastest];
});

/** A by default is the newest lap; B the limit, where it holds for A, else the best other lap. */
export const pair = computed<readonly [Course | null, Course | null]>(() => {
  const all = courses.value;
  const find = (id: string | null): Course | undefined => all.find((each) => each.id === id);
  const a = find(chosen.value[0]) ?? all.find(({ id }) => id.startsWith('lap ')) ?? null;
  const chosenB = find(chosen.value[1]);
  if (chosenB || !a) return [a, chosenB ?? null];
  const lap = laps.value.find((each) => `lap ${each.lap}` === a.id)?.lap ?? Infinity;
  const fastest = lap >= (limit.value?.first_lap ?? Infinity) ? find(LIMIT) : undefined;
  const best = bestOf(laps.value.filter((each) => each.lap !== lap && find(`lap ${each.lap}`)))?.lap;
  return [a, fastest ?? find(`lap ${best}`) ?? find(LIMIT) ?? null];
});

/** The corners of the newest road, and its centre line. */
const found = store.data('page', () => ({ of: null as object | null, corners: [] as readonly Corner[] }));

/** The corners of the road, found once for each road. */
function roadCorners(): readonly Corner[] {
  const { centre } = road.lines;
  if (found.of !== centre) Object.assign(found, { of: centre, corners: cornersOf(centre) });
  return found.corners;
}

/** The road, as comparisons need it. */
const roadNow = (): ComparedRoad => ({ samples: gridNow(), corners: roadCorners(), line: lapSamples.line });

/** A against B along the road; null where one of them is not known, or both are the same. */
export const comparison = computed<Comparison | null>(() => {
  void sampledLaps.value;
  const [a, b] = pair.value;
  return a && b && a.id !== b.id ? compare(a, b, roadNow()) : null;
});

/** The corners with their numbers, for a road and a start line. */
const marked = store.data('page', () => ({
  of: null as readonly Corner[] | null,
  line: NaN,
  corners: [] as readonly MarkedCorner[],
}));

/** The corners with their numbers, by distance from the start line. */
export function markedCorners(): readonly MarkedCorner[] {
  const [corners, { line }] = [roadCorners(), lapSamples];
  if (marked.of !== corners || marked.line !== line) {
    const length = run.value?.track_length_m ?? NaN;
    const all = length > 0 ? numbered(corners, line, length) : [];
    Object.assign(marked, { of: corners, line, corners: all.map((corner, i) => ({ ...corner, number: i + 1 })) });
  }
  return marked.corners;
}

const PIECE_M = 25; // length of a piece with one colour; chosen

/** The line of the newest flying lap, coloured by the time lost to the limit; null where one of them is not known. */
export const lossesToLimit = computed<Losses | null>(() => {
  void sampledLaps.value;
  const newest = laps.value.filter(({ lap }) => lap > 1 && lapSamples.laps.includes(lap - 1)).at(-1);
  const a = newest && lapCourse(newest, lapSamples);
  const both = a && limit.value && compare(a, limitCourse(limit.value, lapSamples), roadNow());
  const [x, y] = (['x_m', 'y_m'] as const).map((name) => a?.channel(name));
  if (!both || !x || !y) return null;
  const pieces = stretches(both, PIECE_M);
  const indexOf = (place: number): number => Math.round((place / both.length) * x.length);
  return {
    line: { x, y },
    pieces: pieces.map(({ from, to, lost }) => ({ first: indexOf(from), end: indexOf(to), lost })),
    most: scaleOf(pieces),
  };
});

/** Where the cursor was placed, from the start line [m]; null: nowhere yet. */
const placed = store.signal<number | null>('run', null);

/** Where the cursor of the comparison stands, from the start line [m]: at first in the corner that decides it. */
export const cursorAlong = computed<number>(() => {
  const both = comparison.value;
  return placed.value ?? (both && byCost(both)[0]?.apex) ?? 0;
});

/** Puts the cursor on a place of the lap; the pictures mark where A was there. */
export function moveCursor(along: number): void {
  const both = comparison.value;
  if (!both) return;
  placed.value = Math.min(both.length, Math.max(0, along));
  const lap = Number(/^lap (\d+)$/.exec(both.a.id)?.[1] ?? NaN);
  const place = (lapSamples.line + placed.value) % both.length;
  cursorPlace.value = Number.isFinite(lap) ? { lap: lap - 1, place } : null;
}
