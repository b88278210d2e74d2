// The newest frame and plan, and their history.
import { paintSize } from '../lib/paint_size';
import { store } from '../lib/store';
import type { Frame, Plan } from '../protocol/topics';
import { COLUMN_COUNT, plotRow } from './columns';
import { History } from './history';
import { run } from './run';

/** Longest time that plots can reach back [s]; chosen. */
export const LONGEST_WINDOW_S = 60;
const FRAMES_PER_SECOND = 60; // at most, from the server
const TRACE_SPACING_M = 0.75; // for full-size cars; chosen
const PLANS_KEPT = 96; // more than one second of plans at 60 a second

/**
 * The newest frame and plan, and their history in fixed memory: plain data, read by the drawing loop at its own pace.
 */
export const live = {
  frame: null as Frame | null,
  receivedAt: 0, // performance.now() of the newest frame [ms]
  plan: null as Plan | null,
  pastPlans: [] as Plan[], // oldest first
  plots: new History(COLUMN_COUNT, LONGEST_WINDOW_S * FRAMES_PER_SECOND),
  trace: new History(2, 4000), // x and y of the driven path [m]: 3 km of it
};

/** Memory of a row, used again for each frame. */
const row: number[] = new Array<number>(COLUMN_COUNT).fill(NaN);

store.onReset('moment', () => {
  forgetRows();
  live.frame = live.plan = null;
  live.pastPlans = [];
});

/** Clears all state that is computed from frames alone. */
export function forgetRows(): void {
  live.plots.clear();
  live.trace.clear();
}

/**
 * Stores the newest frame; it enters the history only if `isNew`, that is, if its time differs from the previous one.
 * While the last seconds are replayed it is not shown (`isShown`).
 */
export function keepFrame(frame: Frame, now: number, isNew: boolean, isShown = true): void {
  if (isShown) {
    live.frame = frame;
    live.receivedAt = now;
  }
  if (!isNew) return;
  live.plots.push(plotRow(frame, row));
  const [x, y] = [live.trace.newest(0), live.trace.newest(1)];
  const spacing = TRACE_SPACING_M * (run.value ? paintSize(run.value) : 1);
  if (!(Math.hypot(frame.x_m - x, frame.y_m - y) < spacing)) live.trace.push([frame.x_m, frame.y_m]);
}

/** Stores the newest plan; while the last seconds are replayed it is not shown (`isShown`). */
export function keepPlan(plan: Plan, isShown = true): void {
  if (isShown) live.plan = plan;
  live.pastPlans.push(plan);
  if (live.pastPlans.length > PLANS_KEPT) live.pastPlans.shift();
}
