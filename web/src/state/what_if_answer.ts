import { columns, type Fields, fields, list, number, text } from '../lib/json';
import { firstSince, mix } from '../lib/math';
import type { Course } from './comparison';
import type { LapChannel } from './lap_samples';

// Two futures of a run from one moment on, as GET /what_if.json gives them (docs/viewer.md).

/** Columns of a future. */
export const TRACE_COLUMNS = [
  'time_s',
  'distance_m',
  'x_m',
  'y_m',
  'yaw_rad',
  'steer_rad',
  'speed_mps',
  'throttle',
  'lateral_error_m',
  'edge_distance_m',
] as const;
type TraceColumn = (typeof TRACE_COLUMNS)[number];
export type Trace = Readonly<Record<TraceColumn, readonly number[]>>;

/** A future as it is read. */
type Future = Readonly<ReturnType<typeof readFuture>>;

export type WhatIfAnswer = Readonly<ReturnType<typeof readAnswer>>;

/** State of a question: being computed, answered, or failed. */
export type WhatIfState =
  | { readonly kind: 'computing'; readonly id: number; readonly share: number }
  | { readonly kind: 'failed'; readonly id: number; readonly why: string }
  | { readonly kind: 'done'; readonly id: number; readonly answer: WhatIfAnswer };

/** One future; passages are the ends of thirds of laps, by the time since the branch [s]. */
const readFuture = ({ min_edge_distance_m, interventions, passages, trace }: Fields) => ({
  leastEdge: number(min_edge_distance_m), // [m]
  interventions: number(interventions), // control steps
  passages: list(passages)
    .map(fields)
    .map((each) => ({ lap: number(each.lap), sector: number(each.sector), time: number(each.time_s) })),
  trace: columns(trace, TRACE_COLUMNS),
});

/**
 * Our simulator, used in place of the car of an external simulator: it drove the last `compared` seconds before the
 * moment again, and came `apart` metres from the car. Null where the run's own car drove both futures.
 */
const readStandIn = ({ plant, compared_s, apart_m }: Fields) =>
  typeof plant === 'string' ? { plant, compared: number(compared_s), apart: number(apart_m) } : null;

/** Reads an answer. */
const readAnswer = (all: Fields) => ({
  at: number(all.at_s), // the moment of the branch, on the run's time line [s]
  isExact: all.is_exact === true, // the run came out the same, bit for bit, when it was computed again
  endReason: text(all.end_reason), // why the second future ended early; empty when it did not
  standIn: readStandIn(fields(all.stand_in)),
  was: readFuture(fields(all.was)),
  branch: readFuture(fields(all.branch)),
});

/** Reads a parsed /what_if.json; null for one without a question. */
export function readWhatIf(json: unknown): WhatIfState | null {
  const all = fields(json);
  const id = number(all.id);
  if (all.state === 'computing') return { kind: 'computing', id, share: number(all.share) };
  if (all.state === 'failed') return { kind: 'failed', id, why: String(all.why) };
  return all.state === 'done' ? { kind: 'done', id, answer: readAnswer(all) } : null;
}

/** A column of a trace at a distance along the road; not-a-number where it was not driven. */
function atDistance(trace: Trace, name: TraceColumn, distance: number): number {
  const places = trace.distance_m;
  const values = trace[name];
  const next = firstSince(places, distance);
  const [before, behind] = [places[next - 1] ?? NaN, places[next] ?? NaN];
  if (behind === distance) return values[next] ?? NaN;
  return mix(values[next - 1] ?? NaN, values[next] ?? NaN, (distance - before) / (behind - before));
}

/** The points at which futures are compared; `driven`: a lap of the run, as far as it is known. */
export interface FutureGrid {
  readonly length: number; // of the lap [m]
  readonly points: number;
  s(point: number): number;
  driven(lap: number, name: LapChannel): Float64Array | null;
}

const isColumn = (name: string): name is TraceColumn & LapChannel =>
  (TRACE_COLUMNS as readonly string[]).includes(name);

/** Time since the branch at which a future ends a lap [s]; not-a-number where it does not. */
const endOf = ({ passages }: Future, lap: number): number =>
  passages.find((each) => each.lap === lap && each.sector === 3)?.time ?? NaN;

/**
 * One lap of both futures: the one they branch in, behind what was driven of it, or the next where both come to its end
 * and only there. `names`: of both in a sentence.
 */
export function futureCourses(
  { was, branch, at }: WhatIfAnswer,
  grid: FutureGrid,
  names: readonly [string, string],
): Course[] {
  const begin = was.trace.distance_m[0] ?? NaN;
  if (!(grid.length > 0) || !Number.isFinite(begin)) return [];
  const first = was.passages[0]?.lap ?? branch.passages[0]?.lap ?? 1;
  const isWhole = (lap: number): boolean => [was, branch].every((each) => Number.isFinite(endOf(each, lap)));
  const driven = grid.driven(first, 'time_s');
  const firstPoint = Math.ceil((begin / grid.length) * grid.points);
  const isSeen = firstPoint < 2 || Number.isFinite(driven?.[Math.min(firstPoint, grid.points) - 1] ?? NaN);
  const lap = !(isSeen && isWhole(first)) && isWhole(first + 1) ? first + 1 : first;
  const ahead = (lap - first) * grid.length;
  return [was, branch].map((future, which): Course => {
    const { trace } = future;
    // The lap begins here, on the time line of the run [s].
    const line =
      lap > first
        ? at + endOf(future, first)
        : firstPoint < 2 || !isSeen
          ? at
          : at -
            (driven?.[firstPoint - 1] ?? NaN) -
            (begin - grid.s(firstPoint - 1)) / (was.trace.speed_mps[0] || Infinity);
    const name = `lap ${lap} ${names[which]}`;
    return {
      id: which === 0 ? 'as it is' : 'what if',
      name,
      total: at + endOf(future, lap) - line,
      isStanding: false,
      channel(channel) {
        if (!isColumn(channel)) return null;
        const before = lap === first ? grid.driven(first, channel) : null;
        return Float64Array.from({ length: grid.points }, (_, point) => {
          const place = grid.s(point) + ahead;
          if (place < begin) return before?.[point] ?? NaN;
          return atDistance(trace, channel, place) - (channel === 'time_s' ? line : 0);
        });
      },
    };
  });
}

/**
 * Sentences on our simulator in place of an external one: that it drove both futures, and how far it is to be trusted.
 */
export function trustOf({ plant, compared, apart }: NonNullable<WhatIfAnswer['standIn']>): string {
  const whose = `Both futures are driven by our own car (${plant}), from where your simulator's car was.`;
  if (!(compared >= 1)) return `${whose} The run is too young to say how well it stands in.`;
  const over = `Over the ${compared.toFixed(0)} s before, from the same place`;
  return `${whose} ${over}, it came up to ${apart.toFixed(2)} m from yours.`;
}

/** Effect of the change in one sentence; `gap`: time by which the second future is later at the end [s]. */
export function verdictOf({ was, branch }: WhatIfAnswer, gap: number): string {
  const pace =
    Math.abs(gap) < 0.005
      ? 'As fast as before'
      : `${Math.abs(gap).toFixed(2)} s ${gap < 0 ? 'faster' : 'slower'} to the same place`;
  const room = branch.leastEdge - was.leastEdge;
  const edge =
    branch.leastEdge < 0
      ? `${(-branch.leastEdge).toFixed(2)} m off the road`
      : Math.abs(room) < 0.01
        ? 'with the same room to the edge'
        : `with ${Math.abs(room).toFixed(2)} m ${room > 0 ? 'more' : 'less'} room to the edge`;
  const helped = branch.interventions - was.interventions;
  const steps =
    helped === 0
      ? ''
      : `; ${Math.abs(helped)} ${helped > 0 ? 'more' : 'fewer'} control steps were changed by the guard`;
  return `${pace}, ${edge}${steps}.`;
}
