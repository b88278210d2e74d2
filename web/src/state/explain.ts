// Evaluations of the history: shares of time, and the plan of a moment ago.
import { firstSince } from '../lib/math';
import { type Plan, timeOf } from '../protocol/topics';
import { Column } from './columns';
import type { History } from './history';

/** Share of the rows of the last `seconds` whose value in a column satisfies `is`, in [0, 1]. */
export function shareOf(history: History, column: number, seconds: number, is: (value: number) => boolean): number {
  const times = history.column(Column.time_s);
  const values = history.column(column).subarray(firstSince(times, (times.at(-1) ?? 0) - seconds));
  return values.reduce((count, value) => count + Number(is(value)), 0) / Math.max(1, values.length);
}

/**
 * The newest plan that is at least `age` seconds old at `now`; the oldest when all are newer; null without plans.
 */
export function planOf(plans: readonly Plan[], now: number, age: number): Plan | null {
  return plans.filter((plan) => timeOf(plan) <= now - age + 1e-9).at(-1) ?? plans[0] ?? null;
}
