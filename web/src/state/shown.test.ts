import { beforeEach, expect, it } from 'vitest';
import { link } from './link';
import { keepFrame, live } from './live';
import { receiveRun } from './run';
import { refreshText, shown, silence } from './shown';
import { frameWith, runWith } from './test_messages';

beforeEach(() => {
  link.value = 'live';
  receiveRun(runWith({ is_paused: false }));
  keepFrame(frameWith(), 1000, true);
});

it('shows the newest frame when it is refreshed', () => {
  refreshText(1100);
  expect(shown.value).toBe(live.frame);
  keepFrame(frameWith({ time_s: 1 }), 1150, true);
  expect(shown.value?.time_s).toBe(0);
  refreshText(1200);
  expect(shown.value?.time_s).toBe(1);
});

it('counts whole seconds of silence', () => {
  refreshText(1999);
  expect(silence.value).toBe(0);
  refreshText(4200);
  expect(silence.value).toBe(3);
});

it('takes neither a pause nor a lost connection for silence', () => {
  receiveRun(runWith({ is_paused: true }));
  refreshText(9000);
  expect(silence.value).toBe(0);
  receiveRun(runWith({ is_paused: false }));
  link.value = 'lost';
  refreshText(9000);
  expect(silence.value).toBe(0);
});
