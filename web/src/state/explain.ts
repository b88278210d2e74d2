import { hasBit } from '../lib/bits';
import { firstSince } from '../lib/math';
import { type Plan, timeOf } from '../protocol/topics';
import { Column } from './columns';
import type { History } from './history';

/** Index of the first row that is not older than `seconds`. */
export const rowsSince = (history: History, seconds: number): number => {
  const times = history.column(Column.time_s);
  return firstSince(times, (times.at(-1) ?? 0) - seconds);
};

/** For a column of small integers: the share of the last `seconds` in which it had each value. */
export function sharesOf(history: History, column: number, values: number, seconds: number): number[] {
  const from = rowsSince(history, seconds);
  const numbers = history.column(column);
  const shares = new Array<number>(values).fill(0);
  const count = numbers.length - from;
  for (let i = from; i < numbers.length; ++i) {
    const value = numbers[i] ?? 0;
    shares[value] = (shares[value] ?? 0) + 1 / count;
  }
  return shares;
}

/** For a column of bit sets: the share of the last `seconds` in which each bit was set. */
export function bitSharesOf(history: History, column: number, bits: number, seconds: number): number[] {
  const from = rowsSince(history, seconds);
  const sets = history.column(column);
  const shares = new Array<number>(bits).fill(0);
  const count = sets.length - from;
  for (let i = from; i < sets.length; ++i) {
    for (let bit = 0; bit < bits; ++bit) if (hasBit(sets[i] ?? 0, bit)) shares[bit] = (shares[bit] ?? 0) + 1 / count;
  }
  return shares;
}

/**
 * The newest plan that is at least `age` seconds old at `now`; the oldest when all are newer; null without plans.
 */
export function planOf(plans: readonly Plan[], now: number, age: number): Plan | null {
  return plans.filter((plan) => timeOf(plan) <= now - age + 1e-9).at(-1) ?? plans[0] ?? null;
}
