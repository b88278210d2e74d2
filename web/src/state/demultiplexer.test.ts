import { beforeEach, describe, expect, it, vi } from 'vitest';
import type { Change, Frame, Lap, Limit, Run } from '../protocol/topics';
import { Column, costColumn } from './columns';
import { beginSession, frameListeners, receive, rewind } from './demultiplexer';
import { events } from './event_log';
import { laps } from './laps';
import { gapToLimit, limit, whyNoLimit } from './limit';
import { live } from './live';
import { road } from './road';
import { run } from './run';
import { shown } from './shown';
import { frameWith, lapWith, pathOf, planWith, runWith } from './test_messages';

const see = (change: Partial<Frame>): void => receive('/chicane/frame', frameWith(change), 0);

beforeEach(() => {
  beginSession();
  run.value = null;
});

describe('a message', () => {
  it('goes where its topic is kept', () => {
    receive('/chicane/run', runWith({ track: 'lakeside', fault_names: ['fault.half_grip'] }), 0);
    receive('/chicane/plan', planWith({ speed_mps: Float64Array.of(44) }), 0);
    receive('/chicane/lap', lapWith(1, 30), 0);
    receive('/chicane/limit', { is_known: false, why_not: 'the road is open' } as Limit, 0);
    receive('/reference', pathOf([5, 5]), 0);
    receive('/track/left', pathOf([0, 1]), 0);
    receive('/track/right', pathOf([0, -1]), 0);
    receive('/track/centre', pathOf([0, 0]), 0);
    const stamp = { sec: 1, nsec: 0 };
    receive('/chicane/change', { stamp, name: 'latency_ms', value: '150' } as Change, 0);
    see({ time_s: 2, active_faults: 1 });
    expect(run.value?.track).toBe('lakeside');
    expect(live.plan?.speed_mps[0]).toBe(44);
    expect(laps.value).toHaveLength(1);
    expect(whyNoLimit.value).toBe('the road is open');
    expect(road.reference).toEqual([{ x: 5, y: 5 }]);
    expect([road.lines.left, road.lines.right, road.lines.centre].map(([first]) => first?.y)).toEqual([1, -1, 0]);
    expect(events.value.map(({ text }) => text)).toEqual(['Fault: half grip', 'latency_ms set to 150']);
  });

  it('has unknown values for fields that an older program does not send', async () => {
    receive('/chicane/frame', { time_s: 1 } as Frame, 0);
    expect(live.frame).toMatchObject({
      time_s: 1,
      steer_sent_rad: NaN,
      cost_terms: new Float64Array(),
      active_now: 0,
      is_manual: false,
    });
    expect(live.plots.newest(Column.speed_limit_mps)).toBeNaN();
    expect(live.plots.newest(costColumn(0))).toBeNaN();
    receive('/chicane/run', { track: 'oval' } as Run, 0);
    const names = { cost_term_names: [], constraint_names: [], fault_names: [] };
    expect(run.value).toMatchObject({ ...names, track: 'oval', mode: '', kerb_width_m: 0 });
    receive('/chicane/limit', { is_known: false } as Limit, 0);
    expect(whyNoLimit.value).toBe('');
    receive('/chicane/limit', { is_known: true, lap_time_s: 20 } as Limit, 0);
    receive('/chicane/lap', { lap: 1, lap_time_s: 22, sector_times_s: Float64Array.of(5, 6, 11) } as Lap, 0);
    await vi.waitFor(() => expect(laps.value.map((lap) => gapToLimit(lap, limit.value))).toEqual([expect.closeTo(10)]));
  });
});

it('a frame counts once, however often a paused run repeats it; listeners are called for each', () => {
  const heard: number[] = [];
  const listener = (_: Frame, now: number): void => void heard.push(now);
  frameListeners.add(listener);
  receive('/chicane/frame', frameWith({ time_s: 3, is_gated: true }), 0);
  receive('/chicane/frame', frameWith({ time_s: 3, is_gated: true }), 5);
  frameListeners.delete(listener);
  expect([live.plots.length, events.value.length]).toEqual([1, 1]);
  expect(heard).toEqual([0, 5]);
});

describe('what is cleared', () => {
  beforeEach(() => {
    receive('/chicane/limit', { is_known: true, lap_time_s: 20 } as Limit, 0);
    receive('/chicane/lap', lapWith(1, 30), 0);
    receive('/chicane/plan', planWith(), 0);
    see({ time_s: 3, is_gated: true });
    shown.value = live.frame;
  });
  const lengths = () => [live.plots.length, live.trace.length, laps.value.length, events.value.length];

  it('where the run begins anew: history, laps and events; the frame that came stays, and the limit', () => {
    receive('/chicane/frame', frameWith({ time_s: 0.5 }), 0);
    expect(lengths()).toEqual([1, 1, 0, 0]);
    expect([live.frame?.time_s, limit.value?.lap_time_s]).toEqual([0.5, 20]);
  });

  it('at a jump in a recording: the newest frame too, so that an earlier one is not taken for a new run', () => {
    rewind();
    expect(lengths()).toEqual([0, 0, 0, 0]);
    expect([live.frame, shown.value?.time_s, limit.value?.lap_time_s]).toEqual([null, 3, 20]);
  });

  it('with another run: the limit and the frame shown too', () => {
    beginSession();
    expect(lengths()).toEqual([0, 0, 0, 0]);
    expect([live.frame, live.plan, shown.value, limit.value]).toEqual([null, null, null, null]);
  });
});
