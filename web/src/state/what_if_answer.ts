import { mix } from '../lib/math';

// Two futures of a run from one moment on, as GET /what_if.json gives them (docs/viewer_laps.md).

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
export type TraceColumn = (typeof TRACE_COLUMNS)[number];
export type Trace = Readonly<Record<TraceColumn, readonly number[]>>;

/** The end of a third of a lap. */
export interface Passage {
  readonly lap: number;
  readonly sector: number;
  readonly time: number; // since the branch [s]
}

export interface Future {
  readonly duration: number; // [s]
  readonly lapTimes: readonly number[]; // [s]
  readonly largestError: number; // [m]
  readonly leastEdge: number; // [m]
  readonly meanSpeed: number; // [m/s]
  readonly topSpeed: number; // [m/s]
  readonly offTrack: number; // times
  readonly interventions: number; // control steps
  readonly passages: readonly Passage[];
  readonly trace: Trace;
}

/** The simulator of ours that stood in for a car that another program simulates. */
export interface StandIn {
  readonly plant: string;
  /** For so long before the moment ours drove from the same place, to be compared [s]. */
  readonly compared: number;
  /** And came so far from the car that was driven [m]. */
  readonly apart: number;
}

export interface WhatIfAnswer {
  readonly id: number;
  /** The moment of the branch, on the run's time line [s]. */
  readonly at: number;
  /** Up to here the first future is what was driven; beyond, what would be without the change [s]. */
  readonly knownUntil: number;
  /** Whether the run came out the same, bit for bit, when it was computed again. */
  readonly isExact: boolean;
  /** Why the second future ended early; empty when it did not. */
  readonly endReason: string;
  /** Null where the run's own car drove both futures. */
  readonly standIn: StandIn | null;
  readonly was: Future;
  readonly branch: Future;
}

/** What the program says of a question: being computed, answered, or failed. */
export type WhatIfState =
  | { readonly kind: 'computing'; readonly id: number; readonly share: number }
  | { readonly kind: 'failed'; readonly id: number; readonly why: string }
  | { readonly kind: 'done'; readonly id: number; readonly answer: WhatIfAnswer };

type Fields = Readonly<Record<string, unknown>>;
const fields = (value: unknown): Fields => (typeof value === 'object' && value !== null ? (value as Fields) : {});
const list = (value: unknown): readonly unknown[] => (Array.isArray(value) ? value : []);
const number = (value: unknown): number => (typeof value === 'number' ? value : NaN);

function readFuture(value: unknown): Future {
  const all = fields(value);
  const trace = fields(all.trace);
  return {
    duration: number(all.duration_s),
    lapTimes: list(all.lap_times_s).map(number),
    largestError: number(all.max_abs_lateral_error_m),
    leastEdge: number(all.min_edge_distance_m),
    meanSpeed: number(all.mean_speed_mps),
    topSpeed: number(all.top_speed_mps),
    offTrack: number(all.off_track_events),
    interventions: number(all.interventions),
    passages: list(all.passages)
      .map(fields)
      .map((each) => ({ lap: number(each.lap), sector: number(each.sector), time: number(each.time_s) })),
    trace: Object.fromEntries(TRACE_COLUMNS.map((name) => [name, list(trace[name]).map(number)])) as unknown as Trace,
  };
}

function readStandIn(value: unknown): StandIn | null {
  const { plant, compared_s, apart_m } = fields(value);
  return typeof plant === 'string' ? { plant, compared: number(compared_s), apart: number(apart_m) } : null;
}

/** Reads a parsed /what_if.json; null for one without a question. */
export function readWhatIf(json: unknown): WhatIfState | null {
  const all = fields(json);
  const id = number(all.id);
  if (all.state === 'computing') return { kind: 'computing', id, share: number(all.share) };
  if (all.state === 'failed') return { kind: 'failed', id, why: String(all.why) };
  if (all.state !== 'done') return null;
  const answer = {
    id,
    at: number(all.at_s),
    knownUntil: number(all.known_until_s),
    isExact: all.is_exact === true,
    standIn: readStandIn(all.stand_in),
    endReason: typeof all.end_reason === 'string' ? all.end_reason : '',
    was: readFuture(all.was),
    branch: readFuture(all.branch),
  };
  return { kind: 'done', id, answer };
}

/** The last row whose value of an ascending column is not above `value`; −1 before the first. */
function rowAt(column: readonly number[], value: number): number {
  let [low, high] = [-1, column.length];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((column[middle] ?? NaN) <= value) low = middle;
    else high = middle;
  }
  return low;
}

/** A column of a trace at a distance along the road; not-a-number where it was not driven. */
export function atDistance(trace: Trace, name: TraceColumn, distance: number): number {
  const places = trace.distance_m;
  const row = rowAt(places, distance);
  const [here, next] = [places[row] ?? NaN, places[row + 1] ?? NaN];
  const values = trace[name];
  if (here === distance) return values[row] ?? NaN;
  return next > here ? mix(values[row] ?? NaN, values[row + 1] ?? NaN, (distance - here) / (next - here)) : NaN;
}

/** Distances at which both futures are drawn [m]. */
export function placesOf({ was, branch }: WhatIfAnswer, count = 600): number[] {
  const first = was.trace.distance_m[0] ?? 0;
  const last = Math.max(was.trace.distance_m.at(-1) ?? first, branch.trace.distance_m.at(-1) ?? first);
  return Array.from({ length: count }, (_, i) => first + ((last - first) * i) / (count - 1));
}

/** How much later the second future is at the same place [s]; negative where it is ahead. */
export const gapAt = ({ was, branch }: WhatIfAnswer, distance: number): number =>
  atDistance(branch.trace, 'time_s', distance) - atDistance(was.trace, 'time_s', distance);

/** A stretch between two passages, or from the branch on; not-a-number where a future did not drive it whole. */
export interface Stretch {
  readonly lap: number;
  readonly sector: number;
  /** Whether it is a whole third of the lap. */
  readonly isWhole: boolean;
  readonly was: number; // [s]
  readonly branch: number; // [s]
}

/** The thirds of laps that either future has driven, in order. */
export function stretchesOf({ was, branch }: WhatIfAnswer): Stretch[] {
  const longer = was.passages.length >= branch.passages.length ? was : branch;
  const spent = (future: Future, i: number): number =>
    (future.passages[i]?.time ?? NaN) - (i > 0 ? (future.passages[i - 1]?.time ?? NaN) : 0);
  return longer.passages.map(({ lap, sector }, i) => ({
    lap,
    sector,
    isWhole: i > 0,
    was: spent(was, i),
    branch: spent(branch, i),
  }));
}

/** The gap at the last place that both have come to [s]. */
export function finalGap(answer: WhatIfAnswer): number {
  const end = Math.min(answer.was.trace.distance_m.at(-1) ?? NaN, answer.branch.trace.distance_m.at(-1) ?? NaN);
  return gapAt(answer, end);
}

/** Whose car drove both futures, and how far it is to be trusted, for a car that another program simulates. */
export function trustOf({ plant, compared, apart }: StandIn): string {
  const whose = `Both futures are driven by our own car (${plant}), from where your simulator's car was.`;
  if (!(compared >= 1)) return `${whose} The run is too young to say how well it stands in.`;
  const over = `Over the ${compared.toFixed(0)} s before, from the same place`;
  return `${whose} ${over}, it came up to ${apart.toFixed(2)} m from yours.`;
}

/** What the change comes to, in one sentence. */
export function verdictOf(answer: WhatIfAnswer): string {
  const { was, branch } = answer;
  const gap = finalGap(answer);
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
