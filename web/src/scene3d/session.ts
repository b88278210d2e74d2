// Memory of the run for drawing: motion, best lap, tyre marks, trace and brake points.
import { paintSize } from '../lib/paint_size';
import { store } from '../lib/store';
import type { Frame } from '../protocol/topics';
import { frameListeners, rebuildListeners } from '../state/demultiplexer';
import { ghostShown } from '../state/ghost_shown';
import { replayListeners } from '../state/replay';
import { run } from '../state/run';
import { type GhostSource, LapRecorder } from './ghost';
import { type Motion, motionOf, Playout } from './motion';
import { RibbonRing } from './ribbon';
import { TyreMarks } from './tyre_marks';

/**
 * Sizes for a full-size car: spacing and width of the trace, lengths of a brake mark and of a piece of a tyre mark;
 * chosen.
 */
const TRACE_SPACING_M = 0.8;
const TRACE_WIDTH_M = 0.16;
const BRAKE_MARK_M = 0.35;
const TYRE_MARK_M = 0.35;

/**
 * What drawing keeps of the run, in fixed memory: the last frames, the best lap, tyre marks, the driven line, and the
 * brake points. It listens to frames also while nothing is drawn.
 */
export class Session {
  readonly playout = new Playout();
  readonly laps = new LapRecorder();
  readonly marks = new TyreMarks();
  readonly trace = new RibbonRing(4000, 1);
  readonly brakes = new RibbonRing(256, 1);
  #last: Motion | null = null; // motion in the newest frame
  #jumps = 0; // of the playout, so far
  #tracePoint = { x: NaN, y: NaN };

  /** The ghost: the rival if there is one, else the best lap of this session. */
  get ghost(): GhostSource | null {
    return ghostShown() ?? this.laps.best;
  }

  /** Takes a frame that arrived at `now` [ms]. */
  take(frame: Frame, now: number): void {
    const motion = motionOf(frame);
    if (this.#last && motion.time < this.#last.time) this.#forgetMarks();
    this.playout.push(motion, now);
    if (this.playout.jumps !== this.#jumps) {
      this.#jumps = this.playout.jumps;
      this.marks.lift();
      this.trace.lift(0);
    }
    this.laps.push(frame);
    const car = run.value;
    const size = car ? paintSize(car) : 1;
    this.#trace(motion, size);
    if (car) {
      const wheels = {
        front: car.front_axle_m,
        rear: car.rear_axle_m,
        halfTrack: car.track_width_m / 2,
        tyreWidth: Math.max(car.tire_width_m, 0.2 * size),
        spacing: TYRE_MARK_M * size,
      };
      this.marks.push(motion, wheels);
    }
    const wasBraking = (this.#last?.throttle ?? 0) < -0.05;
    if (motion.throttle < -0.05 && !wasBraking && motion.speed > 3)
      this.#markBrake(motion, car?.track_width_m ?? 1.6, size);
    this.#last = motion;
  }

  /** Clears everything, for another track. */
  forget(): void {
    this.playout.clear();
    this.laps.clear();
    this.#forgetMarks();
    this.#last = null;
  }

  #forgetMarks(): void {
    this.marks.clear();
    this.trace.clear();
    this.brakes.clear();
    this.#tracePoint = { x: NaN, y: NaN };
  }

  #trace({ x, y, yaw }: Motion, size: number): void {
    if (Math.hypot(x - this.#tracePoint.x, y - this.#tracePoint.y) < TRACE_SPACING_M * size) return;
    this.#tracePoint = { x, y };
    const [dx, dy] = [(-Math.sin(yaw) * TRACE_WIDTH_M * size) / 2, (Math.cos(yaw) * TRACE_WIDTH_M * size) / 2];
    this.trace.push(0, x + dx, y + dy, x - dx, y - dy, 1);
  }

  /** A mark across the road where braking began. */
  #markBrake({ x, y, yaw }: Motion, width: number, size: number): void {
    const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
    const half = width / 2;
    this.brakes.lift(0);
    for (const ahead of [0, BRAKE_MARK_M * size]) {
      const [px, py] = [x + ahead * cos, y + ahead * sin];
      this.brakes.push(0, px - half * sin, py + half * cos, px + half * sin, py - half * cos, 1);
    }
  }
}

/** The one session of the page. */
export const session = new Session();

/** Track of the newest frame. */
const seen = store.data('page', () => ({ track: '' }));
rebuildListeners.add(() => session.forget());
// What is shown again moves the car and leaves no marks.
replayListeners.add((frame, now) => session.playout.push(motionOf(frame), now));
frameListeners.add((frame, now) => {
  const name = `${run.value?.track} ${run.value?.track_length_m}`;
  if (run.value && name !== seen.track) {
    if (seen.track !== '') session.forget();
    seen.track = name;
  }
  session.take(frame, now);
});
