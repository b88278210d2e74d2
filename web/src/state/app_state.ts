import { computed, signal } from '@preact/signals';
import type { Point } from '../lib/math';
import { degrees } from '../lib/math';
import { MPH } from '../lib/format';
import type { Frame, Path, Plan, Run, TopicName, Topics } from '../protocol/topics';
import { History } from './history';

// ---- What the page's text shows: signals, renewed about ten times a second ----

export type Link = 'connecting' | 'live' | 'lost';

export const link = signal<Link>('connecting');
export const attempt = signal(0);
export const run = signal<Run | null>(null);
export const services = signal<ReadonlySet<string>>(new Set());
export const shown = signal<Frame | null>(null);
export const bestLap = signal(NaN);
/** Whole seconds since the last frame of a run that is not paused. */
export const silence = signal(0);
/** The last sentence from the server; null when read. */
export const notice = signal<string | null>(null);

export const isPaused = computed(() => run.value?.is_paused ?? false);

// ---- What is drawn: plain data, read by the drawing loop at its own pace ----

/** Columns of `plots`. */
export const Column = { time: 0, speed: 1, speedWanted: 2, lateralError: 3, steerAsked: 4, steerApplied: 5, stepTime: 6 } as const;

export const WINDOW_S = 20;
const FRAMES_PER_SECOND = 60; // the server sends no more
const TRACE_SPACING_M = 0.75;

export interface Road {
  left: Point[];
  right: Point[];
  centre: Point[];
}

export const live = {
  frame: null as Frame | null,
  receivedAt: 0, // performance.now() of the newest frame [ms]
  plan: null as Plan | null,
  reference: [] as Point[],
  road: { left: [], right: [], centre: [] } as Road,
  roadVersion: 0,
  topSpeed: 0, // fastest seen or planned [m/s]
  plots: new History(7, WINDOW_S * FRAMES_PER_SECOND),
  trace: new History(2, 4000),
};

/** Where the car has been and what was plotted belongs to the run before. */
export function forget(): void {
  live.plots.clear();
  live.trace.clear();
  live.topSpeed = 0;
  live.plan = null;
  bestLap.value = NaN;
}

/** The row of `plots` for a frame, in the units of the axes. */
export const plotRow = (frame: Frame): number[] => [
  frame.time_s,
  frame.speed_mps * MPH,
  frame.speed_reference_mps * MPH,
  frame.lateral_error_m,
  degrees(frame.steer_asked_rad),
  degrees(frame.steer_applied_rad),
  frame.step_time_us / 1000,
];

function receiveFrame(frame: Frame, now: number): void {
  const before = live.frame;
  if (before && frame.time_s < before.time_s) forget();
  live.frame = frame;
  live.receivedAt = now;
  if (!before || frame.time_s !== before.time_s) live.plots.push(plotRow(frame));
  const [x, y] = [live.trace.newest(0), live.trace.newest(1)];
  if (!(Math.hypot(frame.x_m - x, frame.y_m - y) < TRACE_SPACING_M)) live.trace.push([frame.x_m, frame.y_m]);
  if (frame.speed_mps > live.topSpeed) live.topSpeed = frame.speed_mps;
  if (frame.last_lap_time_s > 0 && !(frame.last_lap_time_s >= bestLap.value)) bestLap.value = frame.last_lap_time_s;
}

function receivePlan(plan: Plan): void {
  live.plan = plan;
  for (const speed of plan.speed_mps) if (speed > live.topSpeed) live.topSpeed = speed;
}

const pointsOf = (path: Path): Point[] => path.poses.map(({ pose }) => pose.position);

/** Takes one message in. `now` as of performance.now(). */
export function receive<T extends TopicName>(topic: T, message: Topics[T], now: number): void {
  switch (topic) {
    case '/chicane/frame':
      return receiveFrame(message as Frame, now);
    case '/chicane/plan':
      return receivePlan(message as Plan);
    case '/chicane/run':
      run.value = message as Run;
      return;
    case '/reference':
      live.reference = pointsOf(message as Path);
      return;
    default: {
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
