import { wrapAngle } from '../lib/math';
import type { Frame } from '../protocol/topics';
import type { GhostPose, GhostSource } from '../scene3d/ghost';

const ROW = 5; // time, x, y, yaw, steer
const LINE_SPACING_M = 2;

/**
 * The poses of a recorded drive by time: a branch or another controller, shown as a ghost beside the recording played.
 */
export class RecordedDrive implements GhostSource {
  readonly label: string;
  readonly lapTime = Infinity;
  readonly line: Float32Array;
  readonly #rows: Float64Array;
  readonly #clock: () => number;

  /** `clock`: the time shown, since the recording's first message [s]. */
  constructor(label: string, rows: Float64Array, clock: () => number) {
    this.label = label;
    this.#rows = rows;
    this.#clock = clock;
    const line: number[] = [];
    for (let i = 0; i + ROW <= rows.length; i += ROW) {
      const [x, y] = [rows[i + 1] ?? NaN, rows[i + 2] ?? NaN];
      if (Math.hypot(x - (line.at(-2) ?? Infinity), y - (line.at(-1) ?? Infinity)) >= LINE_SPACING_M) line.push(x, y);
    }
    this.line = new Float32Array(line);
  }

  static from(label: string, frames: readonly { time: number; frame: Frame }[], clock: () => number): RecordedDrive {
    const rows = new Float64Array(frames.length * ROW);
    frames.forEach(({ time, frame }, i) =>
      rows.set([time, frame.x_m, frame.y_m, frame.yaw_rad, frame.steer_applied_rad], i * ROW),
    );
    return new RecordedDrive(label, rows, clock);
  }

  /** Ignores the lap time: both drives share one clock. */
  poseAt(_lapTime: number, into: GhostPose): boolean {
    const time = this.#clock();
    const count = this.#rows.length / ROW;
    const at = (row: number, column: number): number => this.#rows[row * ROW + column] ?? NaN;
    if (count < 2 || !(time >= at(0, 0)) || time > at(count - 1, 0)) return false;
    let [low, high] = [0, count - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (at(middle, 0) <= time) low = middle;
      else high = middle;
    }
    const span = at(high, 0) - at(low, 0);
    const share = span > 0 ? (time - at(low, 0)) / span : 0;
    const mix = (column: number): number => at(low, column) + (at(high, column) - at(low, column)) * share;
    into.x = mix(1);
    into.y = mix(2);
    into.yaw = at(low, 3) + wrapAngle(at(high, 3) - at(low, 3)) * share;
    into.steer = mix(4);
    return true;
  }
}
