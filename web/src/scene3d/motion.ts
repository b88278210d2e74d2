// Smooth motion of the car from frames that arrive irregularly.
import { clamp, extrapolate, wrapAngle } from '../lib/math';
import type { Frame } from '../protocol/topics';

/** The fields of a frame that drawing the car needs. SI, radians, W; not-a-number for unknown. */
const FIELDS = {
  time: 'time_s', // of the run
  x: 'x_m',
  y: 'y_m',
  yaw: 'yaw_rad', // unwrapped within a Playout
  vx: 'vx_mps', // in the car's axes
  vy: 'vy_mps',
  yawRate: 'yaw_rate_radps',
  speed: 'speed_mps',
  steer: 'steer_applied_rad',
  throttle: 'throttle_applied',
  ax: 'longitudinal_acceleration_mps2',
  ay: 'lateral_acceleration_mps2',
  lapTime: 'lap_time_s',
  frontUse: 'front_tire_use', // share of the tyres' grip
  rearUse: 'rear_tire_use',
} as const;
export type Motion = Record<keyof typeof FIELDS, number>;

/** The motion of the car in a frame. */
export const motionOf = (frame: Frame): Motion =>
  Object.fromEntries(Object.entries(FIELDS).map(([name, field]) => [name, frame[field]])) as Motion;

/** The value; 0 where it is unknown. */
const known = (value: number): number => (Number.isFinite(value) ? value : 0);
const mix = (a: number, b: number, u: number): number => known(a) + (known(b) - known(a)) * u;

/** The cubic with values a, b and slopes p, q (per second) at the ends of `span` seconds, at share u. */
function hermite(a: number, p: number, b: number, q: number, span: number, u: number): number {
  const [u2, u3] = [u * u, u * u * u];
  return (2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * span * p + (3 * u2 - 2 * u3) * b + (u3 - u2) * span * q;
}

/** Velocity in W [m/s]. */
const worldVelocity = (m: Motion): [number, number] => {
  const [cos, sin] = [Math.cos(m.yaw), Math.sin(m.yaw)];
  const [vx, vy] = [known(m.vx), known(m.vy)];
  return [vx * cos - vy * sin, vx * sin + vy * cos];
};

/** Values that are interpolated linearly. */
const MIXED = ['vx', 'vy', 'yawRate', 'speed', 'steer', 'ax', 'ay'] as const;

/** The motion at `time` in [a.time, b.time]: position and velocity agree with both. */
export function interpolate(a: Motion, b: Motion, time: number): Motion {
  const span = b.time - a.time;
  const u = span > 0 ? clamp((time - a.time) / span, 0, 1) : 1;
  const [[ax, ay], [bx, by]] = [worldVelocity(a), worldVelocity(b)];
  const hasRates = Number.isFinite(a.yawRate) && Number.isFinite(b.yawRate);
  const step = wrapAngle(b.yaw - a.yaw);
  const mixed = MIXED.map((name) => [name, mix(a[name], b[name], u)]);
  return {
    ...b,
    ...Object.fromEntries(mixed),
    time,
    x: hermite(a.x, ax, b.x, bx, span, u),
    y: hermite(a.y, ay, b.y, by, span, u),
    yaw: a.yaw + (hasRates ? hermite(0, a.yawRate, step, b.yawRate, span, u) : step * u),
    lapTime: b.lapTime >= a.lapTime ? mix(a.lapTime, b.lapTime, u) : b.lapTime - (b.time - time),
  };
}

/** Whether the car was placed elsewhere between two frames instead of driving there. */
export function isJump(a: Motion, b: Motion): boolean {
  const span = b.time - a.time;
  if (!(span > 0) || span > 2) return true;
  const reach = 3 + 1.6 * Math.max(known(a.speed), known(b.speed)) * span;
  return !(Math.hypot(b.x - a.x, b.y - a.y) <= reach);
}

/** Frames that are kept; chosen: half a second of them. */
const KEPT = 32;
/** Longest delay of the picture behind the newest frame [ms]; chosen: it is not noticed. */
const LONGEST_DELAY_MS = 50;
/** Longest time of the run by which the newest frame is extrapolated [s]; chosen. */
const LONGEST_LEAD_S = 0.12;
/** Time constant with which the shown time approaches the intended one [s]; chosen. */
const SLEW_S = 0.25;
/**
 * A burst, that is, past frames that are sent at once: so many in a row, each within this time of the last [ms];
 * chosen.
 */
const BURST_MS = 2;
const BURST = 6;

/**
 * Turns frames that arrive irregularly into smooth motion. It shows the run about one frame late, at the pace at which
 * frames arrive, so that there is nearly always a frame before and one after the time shown. The delay is bounded: with
 * fewer frames the newest one is extrapolated with constant speed and yaw rate.
 */
export class Playout {
  #frames: Motion[] = [];
  #arrivals: number[] = []; // of each [ms]
  #shown = NaN; // run time [s]
  #at = NaN; // of the last advance [ms]
  #close = 0; // frames in a row that arrived close together
  /** Counts how often the car was placed elsewhere; users restart their smoothing. */
  jumps = 0;

  /** Takes a frame that arrived at `now` [ms]. */
  push(frame: Motion, now: number): void {
    const last = this.#frames.at(-1);
    if (last && frame.time === last.time && frame.x === last.x && frame.y === last.y) return;
    this.#close = now - (this.#arrivals.at(-1) ?? -Infinity) < BURST_MS ? this.#close + 1 : 0;
    // In a burst the pace of arrival says nothing: only the newest frame counts.
    if (this.#close >= BURST) this.#forget();
    else if (last && isJump(last, frame)) this.clear();
    this.#frames.push(frame);
    this.#arrivals.push(now);
    if (this.#frames.length > KEPT) {
      this.#frames.shift();
      this.#arrivals.shift();
    }
  }

  clear(): void {
    this.#forget();
    ++this.jumps;
  }

  /** Drops all frames; the next one is shown as it is. */
  #forget(): void {
    this.#frames = [];
    this.#arrivals = [];
    this.#shown = NaN;
  }

  /** Run time per clock time, from the arrival of the frames; 1 before two have arrived. */
  pace(): number {
    const n = this.#frames.length;
    if (n < 2) return 1;
    const run = (this.#frames[n - 1]?.time ?? 0) - (this.#frames[0]?.time ?? 0);
    const wall = ((this.#arrivals[n - 1] ?? 0) - (this.#arrivals[0] ?? 0)) / 1000;
    return wall > 0 ? clamp(run / wall, 0.02, 50) : 1;
  }

  /** Intended delay of the picture behind the newest frame [ms]. */
  #delay(): number {
    const n = this.#frames.length;
    if (n < 2) return 0;
    const apart = ((this.#arrivals[n - 1] ?? 0) - (this.#arrivals[0] ?? 0)) / (n - 1);
    return Math.min(apart, LONGEST_DELAY_MS);
  }

  /**
   * The motion to show at `now` [ms]; null before the first frame. While the run is held, the newest frame unchanged.
   */
  advance(now: number, isHeld: boolean): Motion | null {
    const newest = this.#frames.at(-1);
    if (!newest) return null;
    const elapsed = Number.isFinite(this.#at) ? clamp((now - this.#at) / 1000, 0, 0.25) : 0;
    this.#at = now;
    const pace = this.pace();
    const age = (now - (this.#arrivals.at(-1) ?? now)) / 1000;
    const aim = isHeld
      ? newest.time
      : Math.min(newest.time + (age - this.#delay() / 1000) * pace, newest.time + LONGEST_LEAD_S);
    const steady = this.#shown + elapsed * pace;
    const off = aim - steady;
    if (!Number.isFinite(this.#shown) || Math.abs(off) > Math.max(0.3, 0.6 * pace)) this.#shown = aim;
    else if (isHeld) this.#shown = Math.min(newest.time, this.#shown + elapsed * Math.max(pace, 1));
    else this.#shown = steady + off * (1 - Math.exp(-elapsed / SLEW_S));
    if (isHeld && this.#shown > newest.time - 1e-9) this.#shown = newest.time;
    return this.#sample(this.#shown, newest);
  }

  /** The motion at a time of the run: between two frames, or extrapolated from the newest one. */
  #sample(time: number, newest: Motion): Motion {
    if (time >= newest.time) {
      const lead = Math.min(time - newest.time, LONGEST_LEAD_S);
      if (lead === 0) return newest;
      const pose = extrapolate(newest, { vx: newest.vx, vy: newest.vy, yawRate: newest.yawRate }, lead);
      return { ...newest, ...pose, time: newest.time + lead, lapTime: newest.lapTime + lead };
    }
    for (let i = this.#frames.length - 1; i > 0; --i) {
      const [a, b] = [this.#frames[i - 1] as Motion, this.#frames[i] as Motion];
      if (time >= a.time) return interpolate(a, b, time);
    }
    return this.#frames[0] as Motion;
  }
}
