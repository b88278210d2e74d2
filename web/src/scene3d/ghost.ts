import { lapTime } from '../lib/format';
import { wrapAngle } from '../lib/math';
import { paintSize } from '../lib/paint_size';
import type { Frame } from '../protocol/topics';
import { run } from '../state/run';
import { LONGEST_SILENCE_S } from '../state/silence';

/** Pose and steering angle of another car at a time of the lap. */
export interface GhostPose {
  x: number;
  y: number;
  yaw: number;
  steer: number;
}

/**
 * Another drive round the same track, by lap time: the best lap of this session, a lap of a log, another controller's.
 */
export interface GhostSource {
  /** Label for the legend, e.g. "best lap 0:26.60". */
  readonly label: string;
  /** Time for the whole lap [s]. */
  readonly lapTime: number;
  /** Writes the pose `time` seconds into the lap; false outside of it. */
  poseAt(time: number, into: GhostPose): boolean;
  /** Its path for drawing: x, y alternating [m]; constant. */
  readonly line: Float32Array;
}

const ROW = 5; // time, x, y, yaw, steer
const CAPACITY = 30_000; // rows: 10 minutes at 50 frames a second
const LINE_SPACING_M = 1;

/** A lap kept as rows of numbers; poses between rows are interpolated. */
export class RecordedLap implements GhostSource {
  readonly line: Float32Array;
  readonly #rows: Float32Array;
  #last = 0; // row found last: the next query is nearly always close

  constructor(
    rows: Float32Array,
    readonly lapTime: number,
    readonly label: string,
  ) {
    this.#rows = rows;
    const spacing = LINE_SPACING_M * (run.value ? paintSize(run.value) : 1);
    const line: number[] = [];
    for (let i = 0; i + ROW <= rows.length; i += ROW) {
      const [x, y] = [rows[i + 1] ?? NaN, rows[i + 2] ?? NaN];
      const far = Math.hypot(x - (line.at(-2) ?? Infinity), y - (line.at(-1) ?? Infinity)) >= spacing;
      if (far) line.push(x, y);
    }
    this.line = new Float32Array(line);
  }

  /** The same lap under another name. */
  named(label: string): RecordedLap {
    return new RecordedLap(this.#rows, this.lapTime, label);
  }

  poseAt(time: number, into: GhostPose): boolean {
    const rows = this.#rows;
    const count = rows.length / ROW;
    const at = (row: number, column: number): number => rows[row * ROW + column] ?? NaN;
    if (count < 2 || !(time >= 0) || time > this.lapTime) return false;
    let row = this.#last;
    if (row > count - 2 || at(row, 0) > time) row = 0;
    while (row < count - 2 && at(row + 1, 0) <= time) ++row;
    this.#last = row;
    const span = at(row + 1, 0) - at(row, 0);
    const share = span > 0 ? Math.min(Math.max((time - at(row, 0)) / span, 0), 1) : 0;
    const mix = (column: number): number => at(row, column) + (at(row + 1, column) - at(row, column)) * share;
    into.x = mix(1);
    into.y = mix(2);
    into.yaw = at(row, 3) + wrapAngle(at(row + 1, 3) - at(row, 3)) * share;
    into.steer = mix(4);
    return true;
  }
}

/** Records frames and keeps the best complete lap, in fixed memory. Laps that left the road are not kept. */
export class LapRecorder {
  best: RecordedLap | null = null;
  readonly #rows = new Float32Array(CAPACITY * ROW);
  #count = 0;
  #isWhole = false;
  #lap = NaN; // none yet
  #offTrackEvents = 0;
  #time = -Infinity;

  /** Clears everything, for another run. */
  clear(): void {
    this.best = null;
    this.#begin(NaN, false, 0);
    this.#time = -Infinity;
  }

  push(frame: Frame): void {
    if (frame.time_s === this.#time) return;
    if (frame.time_s < this.#time) this.#reset();
    if (frame.time_s - this.#time > LONGEST_SILENCE_S) this.#isWhole = false;
    this.#time = frame.time_s;
    if (!Number.isFinite(frame.lap_time_s)) return;
    if (frame.lap !== this.#lap) {
      const isNext = frame.lap === this.#lap + 1;
      if (isNext && this.#isWhole) this.#finish(frame);
      // A lap is complete only if it was recorded from the line on.
      this.#begin(frame.lap, isNext || frame.lap_time_s < 0.5, frame.off_track_events);
    }
    this.#add(frame);
  }

  /** A reset discards the lap in progress; the best lap stays, but the run's own count begins again. */
  #reset(): void {
    this.#begin(NaN, false, 0);
    if (this.best) this.best = this.best.named(`best lap before the reset ${lapTime(this.best.lapTime, 3)}`);
  }

  #begin(lap: number, isWhole: boolean, events: number): void {
    this.#lap = lap;
    this.#isWhole = isWhole;
    this.#count = 0;
    this.#offTrackEvents = events;
  }

  #add(frame: Frame): void {
    if (this.#count >= CAPACITY) this.#isWhole = false; // an endless lap
    if (!this.#isWhole) return;
    this.#rows.set([frame.lap_time_s, frame.x_m, frame.y_m, frame.yaw_rad, frame.steer_applied_rad], this.#count * ROW);
    ++this.#count;
  }

  #finish(frame: Frame): void {
    const time = frame.last_lap_time_s;
    const isClean = frame.off_track_events === this.#offTrackEvents;
    if (!(time > 0) || !isClean || this.#count < 2 || (this.best && time >= this.best.lapTime)) return;
    this.best = new RecordedLap(this.#rows.slice(0, this.#count * ROW), time, `best lap ${lapTime(time, 3)}`);
  }
}
