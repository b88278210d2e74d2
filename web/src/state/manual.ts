// Driving by hand: keys, pad and gamepad as one stick position.
import { clamp } from '../lib/math';
import { store } from '../lib/store';

/** Position of the stick: both in [−1, 1], left and drive positive. */
export interface Stick {
  readonly steer: number;
  readonly throttle: number;
}

/** Keys, pad and gamepad as the driver holds them; plain data, read by ramp(). */
export const held = {
  left: false,
  right: false,
  up: false,
  down: false,
  pad: null as Stick | null,
  gamepad: null as Stick | null,
};
/** The stick position that is sent; shown by the indicator. */
export const stick = store.signal<Stick>('page', { steer: 0, throttle: 0 });

/** Rates of the stick, in full travels per second; chosen. */
const STEER_RATE = 2.2; // while a key is held
const RETURN_RATE = 4; // after the key is released
const PEDAL_RATE = 3;

/**
 * The share of the steering lock that a held key reaches. Keys are on or off, and full lock at speed spins any car:
 * full lock up to 8 m/s, above it falling with the square of the speed, like the curvature that the tyres can hold.
 */
export const keyLock = (speed: number): number =>
  clamp((8 / Math.max(8, Number.isFinite(speed) ? speed : 0)) ** 2, 0.03, 1);

/** `value` moved towards `target` by at most `step`. */
const towards = (value: number, target: number, step: number): number => value + clamp(target - value, -step, step);

/** The stick position `seconds` later. */
export function ramp(now: Stick, seconds: number, speed: number): Stick {
  const analogue = held.pad ?? held.gamepad;
  if (analogue) {
    const lock = Math.max(keyLock(speed) * 2, 0.06);
    return { steer: analogue.steer * Math.min(1, lock), throttle: analogue.throttle };
  }
  const side = Number(held.left) - Number(held.right);
  const pedal = Number(held.up) - Number(held.down);
  const lock = keyLock(speed);
  const steerRate = (side === 0 || side * now.steer < 0 ? RETURN_RATE : STEER_RATE) * lock;
  return {
    steer: towards(clamp(now.steer, -lock, lock), side * lock, steerRate * seconds),
    throttle: towards(now.throttle, pedal, PEDAL_RATE * seconds),
  };
}

/** Driving keys. */
const KEYS: Readonly<Record<string, 'left' | 'right' | 'up' | 'down'>> = {
  arrowleft: 'left',
  arrowright: 'right',
  arrowup: 'up',
  arrowdown: 'down',
};

/** Takes a key press or release; true for one of the driving keys. */
export function holdKey(key: string, isDown: boolean): boolean {
  const which = KEYS[key.toLowerCase()];
  if (!which) return false;
  held[which] = isDown;
  return true;
}

/** Releases everything. */
export function releaseAll(): void {
  held.left = held.right = held.up = held.down = false;
  held.pad = held.gamepad = null;
  stick.value = { steer: 0, throttle: 0 };
}
