import { beforeEach, expect, it } from 'vitest';
import { held, holdKey, keyLock, ramp, releaseAll, type Stick, stick } from './manual';

const CENTRE: Stick = { steer: 0, throttle: 0 };
const DT = 1 / 30;

function drive(from: Stick, seconds: number, speed = 0): Stick {
  let now = from;
  for (let i = 0; i < Math.round(seconds / DT); ++i) now = ramp(now, DT, speed);
  return now;
}

beforeEach(releaseAll);

it('turns a held key into a ramp, and back to the middle when it is let go', () => {
  expect(holdKey('ArrowLeft', true)).toBe(true);
  const early = drive(CENTRE, 0.1);
  expect(early.steer).toBeGreaterThan(0.1);
  expect(early.steer).toBeLessThan(0.4);
  expect(drive(CENTRE, 1).steer).toBe(1);
  holdKey('ArrowLeft', false);
  expect(drive({ steer: 1, throttle: 0 }, 1).steer).toBe(0);
});

it('brakes and drives, left and right', () => {
  holdKey('ArrowDown', true);
  holdKey('ArrowRight', true);
  expect(drive(CENTRE, 1)).toEqual({ steer: -1, throttle: -1 });
  holdKey('ArrowUp', true); // both pedals: neither
  expect(drive({ steer: 0, throttle: -1 }, 1).throttle).toBe(0);
});

it('steers less the faster the car is', () => {
  const locks = [1, 1, 0.25, 0.03, 1].map((lock) => expect.closeTo(lock, 12));
  expect([0, 8, 16, 50, NaN].map(keyLock)).toEqual(locks);
  holdKey('ArrowLeft', true);
  expect(drive(CENTRE, 2, 16).steer).toBeCloseTo(0.25, 12);
});

it('lets the pad win', () => {
  holdKey('ArrowLeft', true);
  held.pad = { steer: -0.5, throttle: 0.75 };
  expect(ramp(CENTRE, DT, 0)).toEqual({ steer: -0.5, throttle: 0.75 });
});

it('takes no other keys, and lets all go at once', () => {
  expect(holdKey('a', true)).toBe(false);
  holdKey('ArrowUp', true);
  stick.value = { steer: 1, throttle: 1 };
  releaseAll();
  expect(stick.value).toEqual(CENTRE);
  expect(drive(CENTRE, 1)).toEqual(CENTRE);
});
