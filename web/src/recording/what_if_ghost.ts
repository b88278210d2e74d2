// Futures of Drive both in the picture: the second one as a ghost beside the car, or beside the first one when both are
// watched.
import { effect } from '@preact/signals';
import { complete } from '../protocol/topics';
import { RecordedDrive } from '../scene3d/ghost';
import { ghosts } from '../state/ghost_shown';
import { live } from '../state/live';
import { type Moment, showAgain } from '../state/replay';
import { answer } from '../state/what_if';
import type { Trace, WhatIfAnswer } from '../state/what_if_answer';

/** A value of a trace. */
const column = (trace: Trace, name: keyof Trace, row: number): number => trace[name][row] ?? NaN;

/** The second future as a drive by the time of the run. */
const ghostOf = ({ trace }: WhatIfAnswer['branch']): RecordedDrive =>
  new RecordedDrive('what if', trace, Infinity, () => live.frame?.time_s ?? NaN);

/** The first future as frames of a replay. */
export function momentsOf({ was: { trace } }: WhatIfAnswer): Moment[] {
  const start = trace.time_s[0] ?? 0;
  return trace.time_s.map((time, i) => ({
    plan: null,
    frame: complete('/chicane/frame', {
      time_s: time,
      lap_time_s: time - start,
      has_truth: true,
      x_m: column(trace, 'x_m', i),
      y_m: column(trace, 'y_m', i),
      yaw_rad: column(trace, 'yaw_rad', i),
      vx_mps: column(trace, 'speed_mps', i),
      vy_mps: 0,
      yaw_rate_radps: 0,
      speed_mps: column(trace, 'speed_mps', i),
      steer_applied_rad: column(trace, 'steer_rad', i),
      throttle_applied: column(trace, 'throttle', i),
      lateral_error_m: column(trace, 'lateral_error_m', i),
      edge_distance_m: column(trace, 'edge_distance_m', i),
    }),
  }));
}

/** Shows both futures on the picture, from their first moment on. */
export const watchBoth = (found: WhatIfAnswer): void => showAgain(momentsOf(found));

effect(() => {
  ghosts.whatIf = answer.value && ghostOf(answer.value.branch);
});
