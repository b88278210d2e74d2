import { beforeEach, describe, expect, it } from 'vitest';
import { store } from '../lib/store';
import type { Frame } from '../protocol/topics';
import { events, noteChange, noteEvents, noteNotices, setFaultNames } from './event_log';

const frame = (change: Partial<Frame>): Frame =>
  ({
    time_s: 0,
    rung: 0,
    solve_status: 0,
    is_gated: false,
    is_off_track: false,
    is_manual: false,
    active_faults: 0,
    ...change,
  }) as Frame;

let before: Frame | null = null;
function see(change: Partial<Frame>): void {
  const now = frame(change);
  noteEvents(now, before);
  before = now;
}

beforeEach(() => {
  store.reset('moment');
  before = null;
});

describe('event log', () => {
  it('tells when something began and how long it took', () => {
    see({ time_s: 1 });
    see({ time_s: 2, is_gated: true });
    expect(events.value).toMatchObject([{ text: 'The gate changed the command', time: 2, duration: null }]);
    see({ time_s: 3, is_gated: true });
    see({ time_s: 4.5 });
    expect(events.value).toMatchObject([{ time: 2, duration: 2.5 }]);
  });

  it('takes another rung for another event, newest first', () => {
    see({ time_s: 1, rung: 1 });
    see({ time_s: 2, rung: 3 });
    see({ time_s: 3 });
    expect(events.value.map(({ time, duration, severity }) => [time, duration, severity])).toEqual([
      [2, 1, 'bad'],
      [1, 1, 'warning'],
    ]);
  });

  it('names faults that come and go', () => {
    setFaultNames(['link_lost', 'half_grip']);
    see({ time_s: 1 });
    see({ time_s: 2, active_faults: 2 });
    see({ time_s: 5, active_faults: 0 });
    expect(events.value).toMatchObject([{ text: 'Fault: half grip', time: 2, duration: 3 }]);
  });

  it('lists changed settings, but not those of driving by hand', () => {
    noteChange({ stamp: { sec: 3, nsec: 500_000_000 }, cycle: 90n, name: 'latency_ms', value: '150.00000000000003' });
    noteChange({ stamp: { sec: 4, nsec: 0 }, cycle: 91n, name: 'manual.steer', value: '0.1' });
    expect(events.value).toMatchObject([{ text: 'latency_ms set to 150', time: 3.5 }]);
    noteChange({ stamp: { sec: 5, nsec: 0 }, cycle: 92n, name: 'run.racing_line', value: '0.87' });
    expect(events.value[0]?.text).toBe('Races by a new lap, planned with 87 % of the grip');
    noteChange({ stamp: { sec: 6, nsec: 0 }, cycle: 93n, name: 'run.racing_line', value: '0.97, slides' });
    expect(events.value[0]?.text).toBe('Races by a new lap, planned with 97 % of the grip, and to slide');
    noteChange({ stamp: { sec: 7, nsec: 0 }, cycle: 94n, name: 'run.racing_line', value: '1, slip 0.65' });
    expect(events.value[0]?.text).toBe('Races by a new lap, planned with 100 % of the grip, 65 % of the slip');
  });

  it('lists once what was assumed as the run began', () => {
    see({ time_s: 1 });
    see({ time_s: 2, is_gated: true });
    noteNotices(['a.csv:1: width: not in the file, 4.5 m left and 4.5 m right assumed']);
    noteNotices(['a.csv:1: width: not in the file, 4.5 m left and 4.5 m right assumed']);
    expect(events.value).toMatchObject([
      { text: 'The gate changed the command' },
      { text: 'a.csv:1: width: not in the file, 4.5 m left and 4.5 m right assumed', time: 0, severity: 'warning' },
    ]);
  });

  it('does not grow', () => {
    for (let i = 0; i < 500; ++i) see({ time_s: i, is_gated: i % 2 === 1 });
    expect(events.value.length).toBe(60);
    expect(events.value[0]?.time).toBe(499);
  });
});
