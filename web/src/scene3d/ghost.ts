// Ghost cars: drives that are shown beside the car, and the recorder of the best lap.
import { lapTime } from '../lib/format';
import { clamp } from '../lib/math';
import { paintSize } from '../lib/paint_size';
import { type Pose, type Poses, poseAt } from '../lib/poses';
import type { Frame } from '../protocol/topics';
import { run } from '../state/run';
import { LONGEST_SILENCE_S } from '../state/silence';

/**
 * Another drive round the same track, by lap time: the best lap of this session, a lap of a log, another controller's.
 */
export interface GhostSource {
  /** Label for the legend, e.g. "best lap 0:26.60". */
  readonly label: string;
  /** Time for the whole lap [s]. */
  readonly lapTime: number;
  /** Writes the pose `time` seconds into the lap; false outside of it. */
  poseAt(time: number, into: Pose): boolean;
  /** Its path for drawing: x, y alternating [m]; constant. */
  readonly line: Float32Array;
}

const CAPACITY = 30_000; // rows: 10 minutes at 50 frames a second
const LINE_SPACING_M = { lap: 1, drive: 2 } as const; // of the drawn path; chosen

/** A drive that was recorded: by the time of the lap, or, where it has a clock, by that. */
export class RecordedDrive implements GhostSource {
  readonly line: Float32Array;

  constructor(
    readonly label: string,
    readonly poses: Poses,
    readonly lapTime = Infinity,
    readonly clock?: () => number, // time of the poses that is shown [s]
  ) {
    const spacing = (clock ? LINE_SPACING_M.drive : LINE_SPACING_M.lap) * (run.value ? paintSize(run.value) : 1);
    const line: number[] = [];
    for (let i = 0; i < poses.time_s.length; ++i) {
      const [x, y] = [poses.x_m[i] ?? NaN, poses.y_m[i] ?? NaN];
      if (Math.hypot(x - (line.at(-2) ?? Infinity), y - (line.at(-1) ?? Infinity)) >= spacing) line.push(x, y);
    }
    this.line = new Float32Array(line);
  }

  poseAt(lapTime: number, into: Pose): boolean {
    if (this.clock) return poseAt(this.poses, this.clock(), into);
    const times = this.poses.time_s;
    if (!(lapTime >= 0) || lapTime > this.lapTime) return false;
    return poseAt(this.poses, clamp(lapTime, times[0] ?? NaN, times[times.length - 1] ?? NaN), into);
  }
}

/** The poses of frames, by the time of their recording. */
export const posesOf = (frames: readonly { readonly time: number; readonly frame: Frame }[]): Poses => ({
  time_s: frames.map(({ time }) => time),
  x_m: frames.map(({ frame }) => frame.x_m),
  y_m: frames.map(({ frame }) => frame.y_m),
  yaw_rad: frames.map(({ frame }) => frame.yaw_rad),
  steer_rad: frames.map(({ frame }) => frame.steer_applied_rad),
});

/** Columns that are recorded of a lap. */
const POSE_COLUMNS = ['time_s', 'x_m', 'y_m', 'yaw_rad', 'steer_rad'] as const;

/** Records frames and keeps the best complete lap, in fixed memory. Laps that left the road are not kept. */
export class LapRecorder {
  best: RecordedDrive | null = null;
  readonly #rows = POSE_COLUMNS.map(() => new Float32Array(CAPACITY));
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
    if (!this.best) return;
    const { poses, lapTime: time } = this.best;
    this.best = new RecordedDrive(`best lap before the reset ${lapTime(time, 3)}`, poses, time);
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
    [frame.lap_time_s, frame.x_m, frame.y_m, frame.yaw_rad, frame.steer_applied_rad].forEach((value, column) => {
      const rows = this.#rows[column];
      if (rows) rows[this.#count] = value;
    });
    ++this.#count;
  }

  #finish(frame: Frame): void {
    const time = frame.last_lap_time_s;
    const isClean = frame.off_track_events === this.#offTrackEvents;
    if (!(time > 0) || !isClean || this.#count < 2 || (this.best && time >= this.best.lapTime)) return;
    const columns = POSE_COLUMNS.map((name, i) => [name, this.#rows[i]?.slice(0, this.#count)]);
    this.best = new RecordedDrive(`best lap ${lapTime(time, 3)}`, Object.fromEntries(columns) as Poses, time);
  }
}
