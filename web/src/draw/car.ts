// Shape of a car seen from above: its body and its steered wheels.
import { paintSize } from '../lib/paint_size';
import type { Run } from '../protocol/topics';

/** A wheel seen from above. */
export interface Wheel {
  /** Centre in the car's own axes, x forward, y left, from the centre of mass [m]. */
  readonly x: number;
  readonly y: number;
  readonly angle: number; // [rad], left positive
}

/** A car seen from above, in its own axes [m]. */
export interface CarShape {
  readonly rear: number; // of the body, along x [m]
  readonly front: number;
  readonly halfWidth: number;
  readonly wheelLength: number;
  readonly wheelWidth: number;
  readonly size: number; // scale of details; 1 for a full-size car
  readonly wheels: readonly Wheel[]; // front left, front right, rear left, rear right
}

/** Dimensions of a car [m]. */
export type CarSize = Pick<
  Run,
  'front_axle_m' | 'rear_axle_m' | 'track_width_m' | 'tire_width_m' | 'body_length_m' | 'body_width_m'
>;

/** A car seen from above. The body's overhangs are equal in front and behind; inner wheels steer more (Ackermann). */
export function carShape(car: CarSize, steer: number): CarShape {
  const wheelbase = car.front_axle_m + car.rear_axle_m;
  const overhang = Math.max(0, car.body_length_m - wheelbase) / 2;
  const half = car.track_width_m / 2;
  const size = paintSize(car);
  const tangent = Math.tan(Number.isFinite(steer) ? steer : 0);
  const ackermann = (y: number): number => Math.atan2(wheelbase * tangent, wheelbase - y * tangent);
  return {
    rear: -car.rear_axle_m - overhang,
    front: car.front_axle_m + overhang,
    halfWidth: car.body_width_m / 2,
    wheelLength: 0.68 * size,
    wheelWidth: Math.max(car.tire_width_m, 0.2 * size),
    size,
    wheels: [
      { x: car.front_axle_m, y: half, angle: ackermann(half) },
      { x: car.front_axle_m, y: -half, angle: ackermann(-half) },
      { x: -car.rear_axle_m, y: half, angle: 0 },
      { x: -car.rear_axle_m, y: -half, angle: 0 },
    ],
  };
}
