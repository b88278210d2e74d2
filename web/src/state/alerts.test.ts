import { describe, expect, it } from 'vitest';
import { UNKNOWN_FRAME, UNKNOWN_RUN } from '../protocol/messages';
import type { Frame } from '../protocol/topics';
import { alertsOf } from './alerts';
import { COLUMN_COUNT, plotRow } from './columns';
import { History } from './history';
import { run } from './run';

function alerts(...frames: Partial<Frame>[]): string[] {
  const history = new History(COLUMN_COUNT, 100);
  const all = frames.map((frame) => ({ ...UNKNOWN_FRAME, rung: 0, is_off_track: false, ...frame }));
  for (const frame of all) history.push(plotRow(frame, []));
  return alertsOf(all.at(-1) as Frame, history, ['half_grip', 'fault.link_lost']).map(
    ({ severity, text }) => `${severity}: ${text}`,
  );
}

describe('alerts on the picture', () => {
  it('are none while all is well', () => {
    expect(alerts({ time_s: 1, edge_distance_m: 2, front_tire_use: 0.9, rear_tire_use: 0.8 })).toEqual([]);
  });

  it('say how far the car is off the road', () => {
    expect(alerts({ time_s: 1, is_off_track: true, edge_distance_m: -55.2 })).toEqual([
      'bad: Off the road, 55.2 m beyond the edge',
    ]);
  });

  it('name what helps, far off the road, where it can be done', () => {
    const far = { ...UNKNOWN_FRAME, rung: 0, is_off_track: true, edge_distance_m: -326.7 };
    const said = (canReset: boolean) => alertsOf(far, new History(COLUMN_COUNT, 100), [], canReset)[0]?.text;
    expect(said(true)).toBe('Off the road, 326.7 m beyond the edge: Reset brings it back');
    expect(said(false)).toBe('Off the road, 326.7 m beyond the edge');
  });

  it('do not say of a car that a person drives what the controller would do', () => {
    expect(alerts({ time_s: 1, is_manual: true, rung: 2 })).toEqual(['unknown: A person drives']);
  });

  it('name a near edge and sliding long enough to be read', () => {
    const sliding = { time_s: 1, edge_distance_m: 0.12, front_tire_use: 1.08, rear_tire_use: 0.7 };
    const well = { edge_distance_m: 1, front_tire_use: 0.6, rear_tire_use: 0.7 };
    const said = ['warning: 0.12 m to the edge', 'warning: Sliding: 108 % of the grip'];
    expect(alerts(sliding, { ...well, time_s: 1.5 })).toEqual(said);
    expect(alerts(sliding, { ...well, time_s: 2 })).toEqual([]);
  });

  it('call near to the edge what is near for the size of the car', () => {
    const model = { ...UNKNOWN_RUN, body_length_m: 0.45 };
    run.value = model;
    expect(alerts({ time_s: 1, edge_distance_m: 0.12 })).toEqual([]);
    expect(alerts({ time_s: 1, edge_distance_m: 0.02 })).toEqual(['warning: 0.02 m to the edge']);
    run.value = null;
  });

  it('name who drives, and faults', () => {
    expect(alerts({ time_s: 1, is_manual: true, active_faults: 3 })).toEqual([
      'bad: Fault: half grip',
      'bad: Fault: link lost',
      'unknown: A person drives',
    ]);
  });

  it('name a car that stands although it should drive, and what frees it', () => {
    const stands = (seconds: number, more: Partial<Frame> = {}) =>
      Array.from({ length: 10 * seconds + 1 }, (_, i) => ({
        time_s: i / 10,
        speed_mps: 0.4,
        speed_reference_mps: 30,
        edge_distance_m: 2,
        ...more,
      }));
    expect(alerts(...stands(4))).toEqual(['bad: The car stands and should drive']);
    expect(alerts(...stands(4, { active_faults: 1 }))[0]).toBe(
      'bad: The car stands and should drive: it may go on when the fault ends',
    );
    expect(alerts(...stands(2))).toEqual([]);
    expect(alerts(...stands(4, { speed_reference_mps: 0 }))).toEqual([]);
    expect(alerts(...stands(4, { speed_mps: 2 }))).toEqual([]);
  });
});
