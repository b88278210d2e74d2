// Words for pedal and solver, as they stand beside the numbers.
import { fixed } from '../lib/format';
import { type Sentence, statusInWords } from '../lib/words';
import { REASON, RUNG, STATUS } from '../protocol/messages';
import type { Frame } from '../protocol/topics';

/** The pedal in words: "drive 40 %", "brake 100 %"; of full braking, which is the throttle −`fullBrake`. */
export function pedalInWords(throttle: number, fullBrake: number): string {
  if (!Number.isFinite(throttle)) return '–';
  if (throttle >= 0) return `drive ${fixed(throttle * 100, 0)} %`;
  return `brake ${fixed(Math.min(1, brakeShare(throttle, fullBrake)) * 100, 0)} %`;
}

/** The share of full braking that a negative throttle is. */
export const brakeShare = (throttle: number, fullBrake: number): number => -throttle / (fullBrake > 0 ? fullBrake : 1);

/** How the solve ended. Without a road or measurements there is nothing to solve, and no number is wrong. */
export function solverInWords(frame: Frame): Sentence {
  const isWithoutRoad = frame.is_off_track || frame.rung === RUNG.RETURN_TO_ROAD;
  if (frame.solve_status === STATUS.NOT_FINITE && isWithoutRoad)
    return { severity: 'warning', text: 'The controller has no plan off the road' };
  if (frame.solve_status === STATUS.NOT_FINITE && frame.guard_reason === REASON.NOT_MEASURED)
    return { severity: 'warning', text: 'The controller has no plan without measurements' };
  return statusInWords(frame.solve_status);
}
