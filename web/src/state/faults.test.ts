import { beforeEach, expect, it } from 'vitest';
import { store } from '../lib/store';
import { UNKNOWN_FRAME } from '../protocol/messages';
import { readSchema } from '../protocol/schema';
import { faultMarks, noteFaultChange, noteFaultMarks, secondsLeft } from './faults';
import { schema } from './settings';

const change = (value: string, sec: number) =>
  noteFaultChange({ stamp: { sec, nsec: 500_000_000 }, cycle: 0n, name: 'fault.half_grip', value });

beforeEach(() => {
  store.reset('moment');
  schema.value = readSchema([{ key: 'fault.half_grip', kind: 'bool', fault: { group: 'road', duration_s: 5 } }]);
});

it('count down: for their own time, or the time that was asked for', () => {
  expect(secondsLeft('fault.half_grip', 3)).toBeNaN();
  change('true', 2);
  expect(secondsLeft('fault.half_grip', 3)).toBeCloseTo(4.5, 9);
  change('+1.5*0.25', 4);
  expect(secondsLeft('fault.half_grip', 5)).toBeCloseTo(1, 9);
  expect(secondsLeft('fault.half_grip', 6.1)).toBeNaN();
  change('false', 5);
  expect(secondsLeft('fault.half_grip', 5)).toBeNaN();
});

it('leave a mark where they began', () => {
  const well = { ...UNKNOWN_FRAME, active_faults: 0 };
  const ill = { ...well, active_faults: 2, time_s: 4, x_m: 10, y_m: 20 };
  noteFaultMarks(well, null);
  noteFaultMarks(ill, well);
  noteFaultMarks({ ...ill, time_s: 5 }, ill);
  expect(faultMarks.value).toEqual([{ x: 10, y: 20 }]);
});
