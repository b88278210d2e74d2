import { UNKNOWN_CHANGE, UNKNOWN_FRAME, UNKNOWN_LAP, UNKNOWN_PLAN, UNKNOWN_RUN } from '../protocol/messages';
import type { Change, Frame, Lap, Path, Plan, Run } from '../protocol/topics';

// Messages for tests: with the fields that a test names, and those that any frame has.

export const frameWith = (change: Partial<Frame> = {}): Frame => ({
  ...UNKNOWN_FRAME,
  time_s: 0,
  x_m: 0,
  y_m: 0,
  speed_mps: 10,
  speed_reference_mps: 12,
  lateral_error_m: 0.5,
  steer_asked_rad: 0.1,
  steer_applied_rad: -0.1,
  step_time_us: 1500,
  last_lap_time_s: 0,
  ...change,
});

export const runWith = (change: Partial<Run> = {}): Run => ({ ...UNKNOWN_RUN, ...change });

export const lapWith = (number: number, time: number, change: Partial<Lap> = {}): Lap => ({
  ...UNKNOWN_LAP,
  lap: number,
  lap_time_s: time,
  sector_times_s: Float64Array.of(1, 2, 3),
  is_clean: true,
  top_speed_mps: 40,
  ...change,
});

export const planWith = (change: Partial<Plan> = {}): Plan => ({ ...UNKNOWN_PLAN, ...change });

export const pathOf = (...points: [number, number][]): Path => ({
  poses: points.map(([x, y]) => ({ pose: { position: { x, y } } })),
});

export const changeAt = (time: number, name: string, value: string): Change => ({
  ...UNKNOWN_CHANGE,
  stamp: { sec: Math.floor(time), nsec: 0 },
  name,
  value,
});
