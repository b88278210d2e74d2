import { computed, signal } from '@preact/signals';
import type { Point } from '../lib/math';
import type { Change, Frame, Lap, Limit, Path, Plan, Run, TopicName, Topics } from '../protocol/topics';
import { COLUMN_COUNT, plotRow } from './columns';
import { forgetEvents, noteChange, noteEvents, setFaultNames } from './event_log';
import { Histogram } from './histogram';
import { History } from './history';
import { LapSamples } from './lap_samples';
import { bestsOf } from './lap_table';
import { completeFrame, completeRun } from './message_fields';

// ---- What the page's text shows: signals, renewed about ten times a second ----

export type Link = 'connecting' | 'live' | 'lost';

export const link = signal<Link>('connecting');
export const attempt = signal(0);
export const run = signal<Run | null>(null);
export const services = signal<ReadonlySet<string>>(new Set());
export const shown = signal<Frame | null>(null);
export const bestLap = signal(NaN);
/** Completed laps as the server tells them, rising. */
export const laps = signal<readonly Lap[]>([]);
/** The fastest lap possible on this road with this car; null while nobody has told. */
export const limit = signal<Limit | null>(null);
/** Why nobody has, in one sentence; empty while that is not told either. */
export const whyNoLimit = signal('');
/** Whole seconds since the last frame of a run that is not paused. */
export const silence = signal(0);
/** The last sentence from the server; null when read. */
export const notice = signal<string | null>(null);

export const isPaused = computed(() => run.value?.is_paused ?? false);

// ---- What is drawn: plain data, read by the drawing loop at its own pace ----

/** How far back plots can reach [s]. */
export const LONGEST_WINDOW_S = 60;
const FRAMES_PER_SECOND = 60; // the server sends no more
const TRACE_SPACING_M = 0.75;
const LAPS_KEPT = 1000;
const PLANS_KEPT = 96; // more than one second of them at 60 a second

export interface Road {
  left: Point[];
  right: Point[];
  centre: Point[];
}

export const live = {
  frame: null as Frame | null,
  receivedAt: 0, // performance.now() of the newest frame [ms]
  plan: null as Plan | null,
  pastPlans: [] as Plan[], // oldest first
  reference: [] as Point[],
  road: { left: [], right: [], centre: [] } as Road,
  roadVersion: 0,
  topSpeed: 0, // fastest seen or planned [m/s]
  plots: new History(COLUMN_COUNT, LONGEST_WINDOW_S * FRAMES_PER_SECOND),
  trace: new History(2, 4000),
  stepTimes: new Histogram(1, 6), // [µs], to 1 s
  lapSamples: new LapSamples(),
};

const row: number[] = new Array<number>(COLUMN_COUNT).fill(NaN);

/** Called with each frame as it comes, also while the page is hidden; `now` as of performance.now(). */
export const frameListeners = new Set<(frame: Frame, now: number) => void>();

/** All laps of a recording are known from its beginning, so no moment of it adds to them or takes them away. */
let hasAllLaps = false;
export function keepAllLaps(): void {
  hasAllLaps = true;
}

/** Where the car has been and what was plotted belongs to the run before. */
export function forget(): void {
  live.plots.clear();
  live.trace.clear();
  live.stepTimes.clear();
  if (!hasAllLaps) live.lapSamples.clear();
  live.topSpeed = 0;
  live.plan = null;
  live.pastPlans = [];
  bestLap.value = NaN;
  laps.value = [];
  forgetEvents();
}

/** Another run: what belonged to the one before goes, its last frame included. */
export function beginSession(): void {
  forget();
  limit.value = null;
  whyNoLimit.value = '';
  live.frame = null;
  shown.value = null;
}

/** Another moment of the same run: what was shown goes, and comes again. */
export function rewind(): void {
  forget();
  live.frame = null;
}

function receiveFrame(message: Frame, now: number): void {
  const frame = completeFrame(message);
  const before = live.frame;
  if (before && frame.time_s < before.time_s) forget();
  live.frame = frame;
  live.receivedAt = now;
  if (!before || frame.time_s !== before.time_s) takeSample(frame, before);
  if (frame.speed_mps > live.topSpeed) live.topSpeed = frame.speed_mps;
  if (frame.last_lap_time_s > 0 && !(frame.last_lap_time_s >= bestLap.value)) bestLap.value = frame.last_lap_time_s;
  for (const listener of frameListeners) listener(frame, now);
}

function takeSample(frame: Frame, before: Frame | null): void {
  live.plots.push(plotRow(frame, row));
  live.stepTimes.push(frame.step_time_us);
  noteEvents(frame, before && before.time_s < frame.time_s ? before : null);
  const [x, y] = [live.trace.newest(0), live.trace.newest(1)];
  if (!(Math.hypot(frame.x_m - x, frame.y_m - y) < TRACE_SPACING_M)) live.trace.push([frame.x_m, frame.y_m]);
  if (!hasAllLaps) sampleLap(frame);
}

/** Adds a frame to the laps as functions of the distance. */
export function sampleLap(frame: Frame): void {
  live.lapSamples.setLength(run.value?.track_length_m ?? NaN);
  live.lapSamples.push(
    frame.lap,
    {
      s_m: frame.s_m,
      time_s: frame.lap_time_s,
      speed_mps: frame.speed_mps,
      lateral_error_m: frame.lateral_error_m,
      steer_rad: frame.steer_applied_rad,
      throttle: frame.throttle_applied,
      x_m: frame.x_m,
      y_m: frame.y_m,
    },
    frame.last_lap_time_s,
  );
}

function receivePlan(plan: Plan): void {
  live.plan = plan;
  live.pastPlans.push(plan);
  if (live.pastPlans.length > PLANS_KEPT) live.pastPlans.shift();
  for (const speed of plan.speed_mps) if (speed > live.topSpeed) live.topSpeed = speed;
}

/** The newest laps, and the best one. */
function receiveLap(lap: Lap): void {
  const all = [...laps.value.filter((each) => each.lap !== lap.lap), lap].sort((a, b) => a.lap - b.lap);
  const best = all.length > LAPS_KEPT ? bestsOf(all).lap : NaN;
  laps.value = all.filter((each, i) => i >= all.length - LAPS_KEPT || each.lap === best);
}

const pointsOf = (path: Path): Point[] => path.poses.map(({ pose }) => pose.position);

/** Takes one message in. `now` as of performance.now(). */
export function receive<T extends TopicName>(topic: T, message: Topics[T], now: number): void {
  switch (topic) {
    case '/chicane/frame':
      receiveFrame(message as Frame, now);
      return;
    case '/chicane/plan':
      receivePlan(message as Plan);
      return;
    case '/chicane/run':
      run.value = completeRun(message as Run);
      setFaultNames(run.value.fault_names);
      return;
    case '/chicane/lap':
      receiveLap(message as Lap);
      return;
    case '/chicane/limit':
      limit.value = (message as Limit).is_known ? (message as Limit) : null;
      whyNoLimit.value = limit.value ? '' : ((message as Limit).why_not ?? '');
      return;
    case '/chicane/change':
      noteChange(message as Change);
      return;
    case '/reference':
      live.reference = pointsOf(message as Path);
      return;
    case '/track/left':
    case '/track/right':
    case '/track/centre': {
      const edge = topic.slice('/track/'.length) as keyof Road;
      live.road = { ...live.road, [edge]: pointsOf(message as Path) };
      ++live.roadVersion;
    }
  }
}

/** Brings what the text shows up to date. */
export function refreshText(now: number): void {
  shown.value = live.frame;
  const quiet = link.value === 'live' && live.frame !== null && !isPaused.value;
  silence.value = quiet ? Math.max(0, Math.floor((now - live.receivedAt) / 1000)) : 0;
}
