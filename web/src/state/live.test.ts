import { beforeEach, expect, it } from 'vitest';
import { store } from '../lib/store';
import { COST_TERMS, costColumn } from './columns';
import { keepFrame, keepPlan, live } from './live';
import { frameWith, planWith } from './test_messages';

const keep = (change: Parameters<typeof frameWith>[0], now = 0, isNew = true): void =>
  keepFrame(frameWith(change), now, isNew);

beforeEach(() => store.reset('moment'));

it('stacks the terms of the cost, the last layer taking the surplus', () => {
  const terms = new Float64Array(COST_TERMS + 2).fill(1);
  terms[1] = -5; // no layer
  keep({ cost_terms: terms });
  expect([0, 1, 2].map((term) => live.plots.newest(costColumn(term)))).toEqual([1, 1, 2]);
  expect(live.plots.newest(costColumn(COST_TERMS - 1))).toBe(COST_TERMS + 1);
});

it('has no layers of the cost where there is no plan', () => {
  keep({ cost_terms: new Float64Array(COST_TERMS).fill(1) });
  keep({ time_s: 1, cost_terms: new Float64Array(COST_TERMS) });
  for (let term = 0; term < COST_TERMS; ++term) expect(live.plots.newest(costColumn(term))).toBeNaN();
});

it('leaves out a frame that is no new one, and notes when it came', () => {
  keep({ time_s: 3 }, 100);
  keep({ time_s: 3 }, 200, false);
  expect(live.plots.length).toBe(1);
  expect(live.receivedAt).toBe(200);
});

it('traces the driven line at a fixed spacing', () => {
  for (let i = 0; i <= 100; ++i) keep({ time_s: i, x_m: i * 0.1 });
  expect(live.trace.length).toBe(13); // 0, 0.8, 1.6 … 9.6
});

it('keeps about a second of plans', () => {
  for (let i = 0; i < 1000; ++i) keepPlan(planWith({ stamp: { sec: i, nsec: 0 } }));
  expect(live.pastPlans.length).toBe(96);
  expect(live.pastPlans.at(-1)).toBe(live.plan);
});
