import { beforeEach, expect, it } from 'vitest';
import { store } from '../lib/store';
import { UNKNOWN_FRAME } from '../protocol/messages';
import { cursorMark, pointAt, timeNear } from './cursor';
import { keepFrame } from './live';
import { cursorTime, isFrozen, thaw } from './plot_view';

/** Two times round a circle of 100 m, 40 s each. */
function drive(): void {
  for (let i = 0; i < 800; ++i) {
    const angle = (2 * Math.PI * i) / 400;
    const frame = { time_s: i * 0.1, x_m: 100 * Math.cos(angle), y_m: 100 * Math.sin(angle), s_m: (i % 400) * 1.57 };
    keepFrame({ ...UNKNOWN_FRAME, ...frame, yaw_rad: angle + Math.PI / 2 }, 0, true);
  }
}

beforeEach(() => {
  store.reset('moment');
  thaw();
  cursorTime.value = null;
  drive();
});

it('stands where the car was at its time', () => {
  expect(cursorMark()).toBeNull();
  cursorTime.value = 10;
  expect(cursorMark()?.x).toBeCloseTo(0, 6);
  expect(cursorMark()?.y).toBeCloseTo(100, 6);
});

it('finds the newest time at a point of the road, and nothing far from it', () => {
  expect(timeNear(0, 103)).toBeCloseTo(50, 0);
  expect(timeNear(0, 0)).toBeNull();
});

it('holds the plots where the road was clicked', () => {
  expect(pointAt(0, -99)).toBeCloseTo(70, 0);
  expect(isFrozen.value).toBe(true);
  expect(cursorMark()?.y).toBeLessThan(-98);
});
