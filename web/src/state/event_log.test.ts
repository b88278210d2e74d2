import { beforeEach, expect, it } from 'vitest';
import { store } from '../lib/store';
import type { Frame } from '../protocol/topics';
import { events, noteChange, noteEvents, noteNotices, setFaultNames } from './event_log';
import { changeAt, frameWith } from './test_messages';

let before: Frame | null = null;
function see(change: Partial<Frame>): void {
  const now = frameWith(change);
  noteEvents(now, before);
  before = now;
}

beforeEach(() => {
  store.reset('moment');
  before = null;
});

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
  noteChange({ ...changeAt(3, 'latency_ms', '150.00000000000003'), stamp: { sec: 3, nsec: 500_000_000 } });
  noteChange(changeAt(4, 'manual.steer', '0.1'));
  expect(events.value).toMatchObject([{ text: 'latency_ms set to 150', time: 3.5 }]);
  for (const [value, words] of [
    ['0.87', '87 % of the grip'],
    ['0.97, slides', '97 % of the grip, and to slide'],
    ['1, slip 0.65', '100 % of the grip, 65 % of the slip'],
  ] as const) {
    noteChange(changeAt(5, 'run.racing_line', value));
    expect(events.value[0]?.text).toBe(`Races by a new lap, planned with ${words}`);
  }
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
