import { expect, it } from 'vitest';
import type { Plan } from '../protocol/topics';
import { COLUMN_COUNT, Column } from './columns';
import { hindsight } from './hindsight';
import { History } from './history';
import { planWith } from './test_messages';

/** Straight on along x at 10 m/s, made at `time` and acting 0.1 s later. */
const plan = (time: number): Plan => {
  const times = [0.1, 0.6, 1.1, 1.6].map((ahead) => time + ahead);
  const columns = { time_s: Float64Array.from(times), x_m: Float64Array.from(times, (each) => 10 * each) };
  const turn = { y_m: Float64Array.of(0, 0, 1, 2), yaw_rad: Float64Array.of(0, 0, 0.2, 0.4) };
  return planWith({ stamp: { sec: Math.floor(time), nsec: (time % 1) * 1e9 }, ...columns, ...turn });
};

function driven(until: number): History {
  const all = new History(COLUMN_COUNT, 100);
  for (let i = 0; i <= Math.round(until * 10); ++i) {
    const row = new Array<number>(COLUMN_COUNT).fill(NaN);
    [row[Column.time_s], row[Column.x_m], row[Column.y_m]] = [i / 10, i, 0.5];
    all.push(row);
  }
  return all;
}

it('compares the plan of a second ago with the path driven since', () => {
  const plans = [0, 0.5, 1, 1.5, 2].map(plan);
  const seen = hindsight(plans, driven(2), 2);
  expect(seen?.plan).toBe(plans[2]);
  expect([...(seen?.drivenX ?? [])]).toEqual([10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20]);
  expect(seen?.predicted).toMatchObject({ x: expect.closeTo(20), y: expect.closeTo(0.8), yaw: expect.closeTo(0.16) });
});

it('is nothing before there is a plan', () => expect(hindsight([], driven(1), 1)).toBeNull());
