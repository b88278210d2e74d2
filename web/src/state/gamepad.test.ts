import { expect, it } from 'vitest';
import { asksForWheel, firstGamepad, stickOf } from './gamepad';

const button = (value: number): GamepadButton => ({ value, pressed: value > 0.5, touched: value > 0 });
function pad(axis: number, left = 0, right = 0, start = 0, mapping: GamepadMappingType = 'standard') {
  const buttons = Array.from({ length: 17 }, () => button(0));
  [buttons[6], buttons[7], buttons[9]] = [button(left), button(right), button(start)];
  return { axes: [axis, 0, 0, 0], buttons, mapping, connected: true, id: 'a pad' };
}

it('steers to the side of its stick, drives and brakes with its triggers', () => {
  expect(stickOf(pad(-1))).toEqual({ steer: 1, throttle: 0 });
  expect(stickOf(pad(1, 0, 1))).toEqual({ steer: -1, throttle: 1 });
  expect(stickOf(pad(0.54, 1, 0))?.steer).toBeCloseTo(-0.5);
  expect(stickOf(pad(0, 1, 0))).toEqual({ steer: 0, throttle: -1 });
});

it('asks for nothing while it is let go, a little off the middle included', () => {
  for (const axis of [0.05, -0.08]) expect(stickOf(pad(axis))).toBeNull();
});

it('is one with the standard mapping, and takes the wheel by Start', () => {
  const odd = pad(0, 0, 0, 0, '');
  expect(firstGamepad([null, odd])).toBeNull();
  expect(firstGamepad([null, odd, pad(0)])?.mapping).toBe('standard');
  expect([0, 1].map((start) => asksForWheel(pad(0, 0, 0, start)))).toEqual([false, true]);
});
