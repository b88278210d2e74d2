import { expect, it } from 'vitest';
import { hasBit } from '../lib/bits';
import type { Plan } from '../protocol/topics';
import { COLUMN_COUNT, Column } from './columns';
import { planOf, shareOf } from './explain';
import { History } from './history';

function history(rows: { time: number; limiter: number }[]): History {
  const all = new History(COLUMN_COUNT, 100);
  for (const each of rows) {
    const row = new Array<number>(COLUMN_COUNT).fill(NaN);
    row[Column.time_s] = each.time;
    row[Column.speed_limiter] = each.limiter;
    all.push(row);
  }
  return all;
}

it('tells for how much of the time the speed was limited by what', () => {
  const all = history([0, 1, 2, 3, 4].map((time) => ({ time, limiter: time < 3 ? 2 : 4 })));
  const share = (limiter: number, seconds: number) =>
    shareOf(all, Column.speed_limiter, seconds, (value) => value === limiter);
  expect([share(2, 100), share(4, 100), share(3, 100)]).toEqual([expect.closeTo(0.6), expect.closeTo(0.4), 0]);
  expect([share(2, 1), share(4, 1)]).toEqual([0, 1]);
});

it('finds the plan of a second ago', () => {
  const plans = [1, 1.5, 2, 2.5].map((time) => ({ stamp: { sec: Math.floor(time), nsec: (time % 1) * 1e9 } }) as Plan);
  expect(planOf(plans, 2.5, 1)).toBe(plans[1]);
  expect(planOf(plans, 2.4, 1)).toBe(plans[0]);
  expect(planOf(plans, 1.2, 1)).toBe(plans[0]);
  expect(planOf([], 1, 1)).toBeNull();
});

it('reads sets of 32 bits', () => {
  expect(hasBit(0x80000000, 31)).toBe(true);
  expect(hasBit(0xffffffff, 32)).toBe(false);
});
