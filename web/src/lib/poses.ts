import { firstSince, mix, wrapAngle } from './math';

/** Where a car is and how it steers; of its centre of mass, in W [m, rad]. */
export interface Pose {
  x: number;
  y: number;
  yaw: number;
  steer: number;
}

/** Poses by ascending time, as columns. */
export interface Poses {
  readonly time_s: ArrayLike<number>;
  readonly x_m: ArrayLike<number>;
  readonly y_m: ArrayLike<number>;
  readonly yaw_rad: ArrayLike<number>;
  readonly steer_rad?: ArrayLike<number>;
}

/** Writes the pose at a time, linear between two rows; false before the first and after the last. */
export function poseAt({ time_s: times, x_m, y_m, yaw_rad, steer_rad = [] }: Poses, time: number, into: Pose): boolean {
  const next = firstSince(times, time);
  if (!(time >= (times[0] ?? NaN)) || next >= times.length) return false;
  const row = Math.max(0, next - 1);
  const at = (column: ArrayLike<number>, i: number): number => column[i] ?? NaN;
  const span = at(times, next) - at(times, row);
  const share = span > 0 ? (time - at(times, row)) / span : 0;
  const between = (column: ArrayLike<number>): number => mix(at(column, row), at(column, next), share);
  into.x = between(x_m);
  into.y = between(y_m);
  into.yaw = at(yaw_rad, row) + wrapAngle(at(yaw_rad, next) - at(yaw_rad, row)) * share;
  into.steer = between(steer_rad);
  return true;
}
