import { describe, expect, it } from 'vitest';
import { hasBit } from '../lib/bits';
import type { Plan } from '../protocol/topics';
import { COLUMN_COUNT, Column } from './columns';
import { bitSharesOf, planOf, sharesOf } from './explain';
import { History } from './history';

function history(rows: { time: number; limiter?: number; activeNow?: number }[]): History {
  const all = new History(COLUMN_COUNT, 100);
  for (const each of rows) {
    const row = new Array<number>(COLUMN_COUNT).fill(NaN);
    row[Column.time_s] = each.time;
    row[Column.speed_limiter] = each.limiter ?? 0;
    row[Column.active_now] = each.activeNow ?? 0;
    row[Column.prediction_error_m] = NaN;
    all.push(row);
  }
  return all;
}

describe('explaining', () => {
  it('tells for how much of the time the speed was limited by what', () => {
    const rows = [0, 1, 2, 3, 4].map((time) => ({ time, limiter: time < 3 ? 2 : 4 }));
    expect(sharesOf(history(rows), Column.speed_limiter, 6, 100)).toEqual([
      0,
      0,
      expect.closeTo(0.6),
      0,
      expect.closeTo(0.4),
      0,
    ]);
    expect(sharesOf(history(rows), Column.speed_limiter, 6, 1)).toEqual([0, 0, 0, 0, 1, 0]);
  });

  it('tells for how much of the time each constraint was active', () => {
    const shares = bitSharesOf(
      history([
        { time: 0, activeNow: 1 },
        { time: 1, activeNow: 0b101 },
      ]),
      Column.active_now,
      3,
      10,
    );
    expect(shares).toEqual([1, 0, 0.5]);
  });

  it('finds the plan of a second ago', () => {
    const plans = [1, 1.5, 2, 2.5].map(
      (time) => ({ stamp: { sec: Math.floor(time), nsec: (time % 1) * 1e9 } }) as Plan,
    );
    expect(planOf(plans, 2.5, 1)).toBe(plans[1]);
    expect(planOf(plans, 2.4, 1)).toBe(plans[0]);
    expect(planOf(plans, 1.2, 1)).toBe(plans[0]);
    expect(planOf([], 1, 1)).toBeNull();
  });

  it('reads sets of 32 bits', () => {
    expect(hasBit(0x80000000, 31)).toBe(true);
    expect(hasBit(0xffffffff, 32)).toBe(false);
  });
});
