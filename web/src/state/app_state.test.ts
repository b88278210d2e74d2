import { beforeEach, describe, expect, it } from 'vitest';
import type { Frame, Lap, Limit, Path, Plan, Run } from '../protocol/topics';
import {
  beginSession,
  bestLap,
  forget,
  isPaused,
  laps,
  limit,
  link,
  live,
  receive,
  refreshText,
  run,
  shown,
  silence,
  whyNoLimit,
} from './app_state';
import { COST_TERMS, Column, costColumn } from './columns';

const frame = (change: Partial<Frame>): Frame =>
  ({
    time_s: 0,
    x_m: 0,
    y_m: 0,
    speed_mps: 10,
    speed_reference_mps: 12,
    lateral_error_m: 0.5,
    steer_asked_rad: 0.1,
    steer_applied_rad: -0.1,
    step_time_us: 1500,
    last_lap_time_s: 0,
    ...change,
  }) as Frame;
const path = (...points: [number, number][]): Path => ({
  poses: points.map(([x, y]) => ({ pose: { position: { x, y } } })),
});

beforeEach(() => {
  forget();
  live.frame = null;
  run.value = null;
});

describe('app state', () => {
  it('plots a frame in the units of the axes', () => {
    receive('/chicane/frame', frame({ time_s: 3 }), 0);
    expect(live.plots.newest(Column.time)).toBe(3);
    expect(live.plots.newest(Column.speed)).toBe(10);
    expect(live.plots.newest(Column.lateralError)).toBe(0.5);
    expect(live.plots.newest(Column.steerAsked)).toBeCloseTo(5.7296, 4);
    expect(live.plots.newest(Column.steerApplied)).toBeCloseTo(-5.7296, 4);
    expect(live.plots.newest(Column.stepTime)).toBe(1.5);
  });

  it('knows nothing of what an older program does not tell', () => {
    receive('/chicane/frame', frame({}), 0);
    expect(live.frame).toMatchObject({
      steer_sent_rad: NaN,
      cost_terms: new Float64Array(),
      active_now: 0,
      is_manual: false,
    });
    expect(live.plots.newest(Column.speedLimit)).toBeNaN();
    expect(live.plots.newest(costColumn(0))).toBeNaN();
    receive('/chicane/run', {} as Run, 0);
    expect(run.value).toMatchObject({ constraint_names: [], mode: '' });
  });

  it('says why there is no limit until there is one, and forgets it with the run', () => {
    receive('/chicane/limit', { is_known: false, why_not: 'the road is open' } as Limit, 0);
    expect([limit.value, whyNoLimit.value]).toEqual([null, 'the road is open']);
    receive('/chicane/limit', { is_known: true, lap_time_s: 20, why_not: '' } as Limit, 0);
    expect([limit.value?.lap_time_s, whyNoLimit.value]).toEqual([20, '']);
    receive('/chicane/limit', { is_known: false } as Limit, 0); // an older program
    expect([limit.value, whyNoLimit.value]).toEqual([null, '']);
    receive('/chicane/limit', { is_known: false, why_not: 'nobody told' } as Limit, 0);
    beginSession();
    expect(whyNoLimit.value).toBe('');
  });

  it('stacks the terms of the cost, the last layer taking what is too many', () => {
    const terms = new Float64Array(COST_TERMS + 2).fill(1);
    terms[1] = -5; // no layer
    receive('/chicane/frame', { ...frame({}), cost_terms: terms } as unknown as Frame, 0);
    expect([0, 1, 2].map((term) => live.plots.newest(costColumn(term)))).toEqual([1, 1, 2]);
    expect(live.plots.newest(costColumn(COST_TERMS - 1))).toBe(COST_TERMS + 1);
  });

  it('keeps laps by number', () => {
    const lap = (number: number, time: number) => ({ lap: number, lap_time_s: time });
    for (const each of [lap(2, 27), lap(1, 30), lap(2, 27)]) receive('/chicane/lap', each as Lap, 0);
    expect(laps.value.map(({ lap: number }) => number)).toEqual([1, 2]);
    beginSession();
    expect(laps.value).toEqual([]);
    expect(live.frame).toBeNull();
  });

  it('keeps about a second of plans', () => {
    for (let i = 0; i < 1000; ++i)
      receive('/chicane/plan', { speed_mps: [], stamp: { sec: i, nsec: 0 } } as unknown as Plan, 0);
    expect(live.pastPlans.length).toBe(96);
    expect(live.pastPlans.at(-1)).toBe(live.plan);
  });

  it('plots a repeated frame once', () => {
    receive('/chicane/frame', frame({ time_s: 3 }), 0);
    receive('/chicane/frame', frame({ time_s: 3 }), 5);
    expect(live.plots.length).toBe(1);
  });

  it('forgets when time runs backwards', () => {
    receive('/chicane/frame', frame({ time_s: 30, last_lap_time_s: 28 }), 0);
    receive('/chicane/frame', frame({ time_s: 0.04, last_lap_time_s: 0 }), 0);
    expect(live.plots.length).toBe(1);
    expect(bestLap.value).toBeNaN();
  });

  it('remembers the best lap', () => {
    for (const [i, time] of [0, 30, 28, 29].entries())
      receive('/chicane/frame', frame({ time_s: i, last_lap_time_s: time }), 0);
    expect(bestLap.value).toBe(28);
  });

  it('traces the way at a fixed spacing', () => {
    for (let i = 0; i <= 100; ++i) receive('/chicane/frame', frame({ time_s: i, x_m: i * 0.1 }), 0);
    expect(live.trace.length).toBe(13); // 0, 0.8, 1.6 … 9.6
  });

  it('keeps edges apart', () => {
    const before = live.roadVersion;
    receive('/track/left', path([0, 1]), 0);
    receive('/track/right', path([0, -1]), 0);
    expect(live.road.left).toEqual([{ x: 0, y: 1 }]);
    expect(live.road.right).toEqual([{ x: 0, y: -1 }]);
    expect(live.roadVersion).toBe(before + 2);
    receive('/reference', path([5, 5]), 0);
    expect(live.reference).toEqual([{ x: 5, y: 5 }]);
  });

  it('raises the top speed by plans too', () => {
    receive('/chicane/plan', { speed_mps: new Float64Array([20, NaN, 44]) } as unknown as Plan, 0);
    expect(live.topSpeed).toBe(44);
  });

  it('tells silence from a pause', () => {
    link.value = 'live';
    receive('/chicane/frame', frame({}), 1000);
    refreshText(4200);
    expect(shown.value).toBe(live.frame);
    expect(silence.value).toBe(3);
    receive('/chicane/run', { is_paused: true } as Run, 0);
    expect(isPaused.value).toBe(true);
    refreshText(9000);
    expect(silence.value).toBe(0);
  });
});
