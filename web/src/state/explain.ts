import { firstSince } from '../draw/axis';
import { hasBit } from '../lib/bits';
import type { Plan } from '../protocol/topics';
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
 * Root mean square of the finite values of a column over the last `seconds`; NaN without any.
 */
export function rmsOf(history: History, column: number, seconds: number): number {
  const values = history.column(column);
  let [sum, count] = [0, 0];
  for (let i = rowsSince(history, seconds); i < values.length; ++i) {
    const value = values[i] ?? NaN;
    if (!Number.isFinite(value)) continue;
    sum += value * value;
    ++count;
  }
  return count === 0 ? NaN : Math.sqrt(sum / count);
}

const timeOf = ({ stamp }: Plan): number => stamp.sec + stamp.nsec / 1e9;

/**
 * The newest plan that is at least `age` seconds old at `now`; the oldest when all are newer; null without plans.
 */
export function planOf(plans: readonly Plan[], now: number, age: number): Plan | null {
  return plans.filter((plan) => timeOf(plan) <= now - age + 1e-9).at(-1) ?? plans[0] ?? null;
}

/** A line in a car's axes: metres ahead and to the left of a pose. */
export interface LocalLine {
  readonly ahead: number[];
  readonly left: number[];
}

export function toLocal(
  xs: ArrayLike<number>,
  ys: ArrayLike<number>,
  pose: { x: number; y: number; yaw: number },
): LocalLine {
  const [cos, sin] = [Math.cos(pose.yaw), Math.sin(pose.yaw)];
  const line: LocalLine = { ahead: [], left: [] };
  for (let i = 0; i < xs.length; ++i) {
    const [dx, dy] = [(xs[i] ?? NaN) - pose.x, (ys[i] ?? NaN) - pose.y];
    line.ahead.push(cos * dx + sin * dy);
    line.left.push(-sin * dx + cos * dy);
  }
  return line;
}
