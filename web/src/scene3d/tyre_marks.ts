// Tyre marks on the road.
import { clamp } from '../lib/math';
import type { Motion } from './motion';
import { RibbonRing } from './ribbon';

/** Places and widths of the wheels [m]. */
export interface WheelBase {
  readonly front: number; // axle in front of the centre of mass [m]
  readonly rear: number; // behind it
  readonly halfTrack: number;
  readonly tyreWidth: number;
  readonly spacing: number; // of the pieces of a mark
}

const CAPACITY = 6000; // pieces of all four wheels; chosen
const SLIDE_RAD = 0.13; // slip angle that leaves marks where the use of grip is unknown; chosen

/** Opacity in [0, 1] of the mark of a tyre that uses `use` of its grip; with NaN the slip angle decides. */
export function markStrength(use: number, slipAngle: number): number {
  if (Number.isFinite(use)) return clamp((use - 1) * 4 + 0.25, 0, 1) * (use > 1 ? 1 : 0);
  return Number.isFinite(slipAngle) && Math.abs(slipAngle) > SLIDE_RAD ? clamp(Math.abs(slipAngle) * 3, 0, 1) : 0;
}

/** Tyre marks on the road where the tyres slid. */
export class TyreMarks {
  readonly ring = new RibbonRing(CAPACITY, 4);
  #x = NaN;
  #y = NaN;

  clear(): void {
    this.ring.clear();
    this.#x = NaN;
  }

  /** Ends all marks, after the car was placed elsewhere. */
  lift(): void {
    for (let wheel = 0; wheel < 4; ++wheel) this.ring.lift(wheel);
    this.#x = NaN;
  }

  push(motion: Motion, car: WheelBase): void {
    if (Math.hypot(motion.x - this.#x, motion.y - this.#y) < car.spacing) return;
    [this.#x, this.#y] = [motion.x, motion.y];
    const [cos, sin] = [Math.cos(motion.yaw), Math.sin(motion.yaw)];
    const isMoving = motion.vx > 3;
    const slip = (x: number, steer: number): number =>
      isMoving ? Math.atan2(motion.vy + x * motion.yawRate, motion.vx) - steer : 0;
    const axles = [
      { x: car.front, strength: markStrength(motion.frontUse, slip(car.front, motion.steer)) },
      { x: -car.rear, strength: markStrength(motion.rearUse, slip(-car.rear, 0)) },
    ];
    axles.forEach(({ x, strength }, axle) => {
      for (const side of [1, -1]) {
        const track = 2 * axle + (side > 0 ? 0 : 1);
        if (!(strength > 0 && motion.speed > 1)) {
          this.ring.lift(track);
          continue;
        }
        const place = (y: number): [number, number] => [motion.x + x * cos - y * sin, motion.y + x * sin + y * cos];
        const middle = side * car.halfTrack;
        this.ring.push(track, ...place(middle + car.tyreWidth / 2), ...place(middle - car.tyreWidth / 2), strength);
      }
    });
  }
}
