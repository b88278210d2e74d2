import { signal } from '@preact/signals';
import { clamp } from '../lib/math';

/** Where the stick stands: both in [−1, 1], left and drive positive. */
export interface Stick {
  readonly steer: number;
  readonly throttle: number;
}

/** The keys and the pad of a person who drives; plain data, read by the ramp. */
export const held = { left: false, right: false, up: false, down: false, pad: null as Stick | null };
/** What is sent, for the indicator. */
export const stick = signal<Stick>({ steer: 0, throttle: 0 });

const STEER_RATE = 2.2; // of the full way per second, when a key is held
const RETURN_RATE = 4; // when it is let go
const PEDAL_RATE = 3;

/**
 * The share of the steering lock that a held key goes to. Keys know only all or nothing, and all of the lock at speed
 * spins any car: full lock up to 8 m/s, then falling with the square of the speed, as the curvature does that tyres can
 * hold.
 */
export const keyLock = (speed: number): number =>
  clamp((8 / Math.max(8, Number.isFinite(speed) ? speed : 0)) ** 2, 0.03, 1);

const towards = (value: number, target: number, step: number): number => value + clamp(target - value, -step, step);

/** The stick `seconds` later. */
export function ramp(now: Stick, seconds: number, speed: number): Stick {
  if (held.pad) {
    const lock = Math.max(keyLock(speed) * 2, 0.06);
    return { steer: held.pad.steer * Math.min(1, lock), throttle: held.pad.throttle };
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

const KEYS: Readonly<Record<string, 'left' | 'right' | 'up' | 'down'>> = {
  arrowleft: 'left',
  arrowright: 'right',
  arrowup: 'up',
  arrowdown: 'down',
};

/** Takes a key press or release; true when it was one of the driver's. */
export function holdKey(key: string, isDown: boolean): boolean {
  const which = KEYS[key.toLowerCase()];
  if (!which) return false;
  held[which] = isDown;
  return true;
}

export function letGo(): void {
  held.left = held.right = held.up = held.down = false;
  held.pad = null;
  stick.value = { steer: 0, throttle: 0 };
}
