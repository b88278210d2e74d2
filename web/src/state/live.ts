import { paintSize } from '../lib/paint_size';
import { store } from '../lib/store';
import type { Frame, Plan } from '../protocol/topics';
import { COLUMN_COUNT, plotRow } from './columns';
import { History } from './history';
import { run } from './run';

/** How far back plots can reach [s]. */
export const LONGEST_WINDOW_S = 60;
const FRAMES_PER_SECOND = 60; // the server sends no more
const TRACE_SPACING_M = 0.75;
const PLANS_KEPT = 96; // more than one second of them at 60 a second

/**
 * The newest frame and plan, and their history in fixed memory: plain data, read by the drawing loop at its own pace.
 */
export const live = {
  frame: null as Frame | null,
  receivedAt: 0, // performance.now() of the newest frame [ms]
  plan: null as Plan | null,
  pastPlans: [] as Plan[], // oldest first
  plots: new History(COLUMN_COUNT, LONGEST_WINDOW_S * FRAMES_PER_SECOND),
  trace: new History(2, 4000),
};

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

export function keepPlan(plan: Plan, isShown = true): void {
  if (isShown) live.plan = plan;
  live.pastPlans.push(plan);
  if (live.pastPlans.length > PLANS_KEPT) live.pastPlans.shift();
}
