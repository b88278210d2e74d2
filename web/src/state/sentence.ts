import { fixed } from '../lib/format';
import {
  driverInWords,
  limiterInWords,
  reasonInWords,
  rungInWords,
  type Sentence,
  type Severity,
  statusInWords,
} from '../lib/words';
import { REASON, REASON_WORDS, RUNG, STATUS } from '../protocol/messages';
import type { Frame } from '../protocol/topics';

// The one sentence that a state of the run has, and the numbers that may stand beside it. The words are the program's
// (messages.ts); here is which of them holds. The order is that of weight: who drives, what is stuck, what the guard
// does, what limits the speed.

/** What the page knows beside a frame. */
export interface Circumstances {
  /** The car has stood for seconds although it should drive. */
  readonly isStuck: boolean;
  /** The run can be put back to its start. */
  readonly canReset: boolean;
}

/** A headline, and the sentence behind it. */
export interface StateSentence {
  readonly severity: Severity;
  readonly title: string;
  readonly text: string;
  /** Of the speed, by Frame.speed_limiter; null while something else than the controller's plan decides. */
  readonly limiter: number | null;
}

const capital = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

/** Whether the controller's own plan is what drives the car. */
export const drivesByPlan = (frame: Frame, { isStuck }: Circumstances): boolean =>
  !frame.is_manual && !isStuck && frame.rung === RUNG.CONTROLLER;

/** What frees a car that stands; empty where nobody on this page can. */
export function helpOf(frame: Frame, { canReset }: Circumstances): string {
  if (frame.active_faults !== 0) return 'it may go on when the fault ends';
  return canReset ? 'Reset frees it' : '';
}

/** What the guard does while the controller goes on driving, by its reason. */
const WARNING_TITLES: Record<number, string> = {
  [REASON.TOO_FAST_FOR_SILENCE]: 'The guard holds the car back',
  [REASON.STUCK]: 'The car stands and should drive',
};

function splitAt({ severity, text }: Sentence): StateSentence {
  const [title = '', reason = ''] = text.split(': ');
  return { severity, title, text: reason === '' ? '' : `${capital(reason)}.`, limiter: null };
}

/** Who drives, what is stuck, what the guard does, or what limits the speed. */
export function stateSentence(frame: Frame, circumstances: Circumstances): StateSentence {
  if (frame.is_manual) return splitAt(driverInWords(frame));
  if (circumstances.isStuck) {
    return {
      severity: 'bad',
      title: 'The car stands and should drive',
      text: helpOf(frame, circumstances) === '' ? '' : `${capital(helpOf(frame, circumstances))}.`,
      limiter: null,
    };
  }
  if (frame.rung !== RUNG.CONTROLLER) return splitAt(rungInWords(frame.rung, frame.guard_reason));
  if (REASON_WORDS[frame.guard_reason]?.severity === 'warning') {
    return {
      severity: 'warning',
      title: WARNING_TITLES[frame.guard_reason] ?? 'The guard makes up for what it found',
      text: `${capital(reasonInWords(frame.guard_reason))}.`,
      limiter: null,
    };
  }
  const { title, why } = limiterInWords(frame.speed_limiter);
  return { severity: 'good', title, text: why, limiter: frame.speed_limiter };
}

/** The speed that the controller aims at [m/s]; NaN where it means nothing, because something else decides. */
export const aimOf = (frame: Frame, circumstances: Circumstances): number =>
  drivesByPlan(frame, circumstances) && frame.speed_reference_mps > 0 ? frame.speed_reference_mps : NaN;

/** The speed that is planned where the next command acts [m/s]; NaN where there is no plan that drives. */
export const plannedOf = (frame: Frame, circumstances: Circumstances): number =>
  drivesByPlan(frame, circumstances) && frame.speed_limit_mps > 0 ? frame.speed_limit_mps : NaN;

/** The pedal in words: "drive 40 %", "brake 100 %"; of full braking, which is the throttle −`fullBrake`. */
export function pedalInWords(throttle: number, fullBrake: number): string {
  if (!Number.isFinite(throttle)) return '–';
  if (throttle >= 0) return `drive ${fixed(throttle * 100, 0)} %`;
  return `brake ${fixed(Math.min(1, brakeShare(throttle, fullBrake)) * 100, 0)} %`;
}

/** The share of full braking that a negative throttle is. */
export const brakeShare = (throttle: number, fullBrake: number): number => -throttle / (fullBrake > 0 ? fullBrake : 1);

/** How the solve ended. A controller that is off its road has nothing to solve: that is no fault of a number. */
export function solverInWords(frame: Frame): Sentence {
  const isWithoutRoad = frame.is_off_track || frame.rung === RUNG.RETURN_TO_ROAD;
  if (frame.solve_status === STATUS.NOT_FINITE && isWithoutRoad)
    return { severity: 'warning', text: 'The controller has no plan off the road' };
  if (frame.solve_status === STATUS.NOT_FINITE && frame.guard_reason === REASON.NOT_MEASURED)
    return { severity: 'warning', text: 'The controller has no plan without measurements' };
  return statusInWords(frame.solve_status);
}
