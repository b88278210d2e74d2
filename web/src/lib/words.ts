import { REASON, RUNG, STATUS } from '../protocol/messages';
import type { Frame } from '../protocol/topics';

export type Severity = 'good' | 'warning' | 'bad' | 'unknown';

export interface Sentence {
  readonly severity: Severity;
  readonly text: string;
}

/** What the guard found, by Frame.guard_reason. */
export function reasonInWords(reason: number): string {
  switch (reason) {
    case REASON.NONE:
      return 'nothing found';
    case REASON.NO_ANSWER:
      return 'the controller has no answer';
    case REASON.NOT_MEASURED:
      return 'nothing is measured';
    case REASON.FROZEN:
      return 'measurements repeat although it moves';
    case REASON.SPEED_MISMATCH:
      return 'measured speed and place contradict each other';
    case REASON.HEADING_JUMP:
      return 'the measured yaw jumped';
    case REASON.POSITION_JUMP:
      return 'the measured place jumped';
    case REASON.NO_WAY_TO_STOP:
      return 'after the command there would be no way to stop';
    case REASON.FAR_FROM_ROAD:
      return 'the road that is known is far away';
    case REASON.TOO_FAST_FOR_SILENCE:
      return 'it is too fast for a lost link';
    default:
      return `unknown reason ${reason}`;
  }
}

/** Who drives: a person, or what Frame.rung says. */
export const driverInWords = (frame: Pick<Frame, 'is_manual' | 'rung' | 'guard_reason'>): Sentence =>
  frame.is_manual
    ? {
        severity: 'good',
        text: `A person drives; the controller ${frame.rung === RUNG.CONTROLLER ? 'plans beside' : 'has no plan here'}`,
      }
    : rungInWords(frame.rung, frame.guard_reason);

/** The source of the command, by Frame.rung. */
export function rungInWords(rung: number, reason = 0): Sentence {
  switch (rung) {
    case RUNG.CONTROLLER:
      return reason === REASON.TOO_FAST_FOR_SILENCE
        ? { severity: 'warning', text: `The controller drives; ${reasonInWords(reason)}` }
        : { severity: 'good', text: 'The controller drives' };
    case RUNG.SHIFTED_PLAN:
      return { severity: 'warning', text: 'No new answer: following the last plan' };
    case RUNG.HOLD_AND_BRAKE:
      return { severity: 'bad', text: 'No answer: following the last plan, braking gently' };
    case RUNG.BRAKE:
      return { severity: 'bad', text: 'No answer: following the last plan, braking fully' };
    case RUNG.RETURN_TO_ROAD:
      return { severity: 'warning', text: 'Returning to the road at walking pace' };
    case RUNG.GUARD_STOP:
      return { severity: 'bad', text: `The guard stops the car on the road: ${reasonInWords(reason)}` };
    case RUNG.STOP_ON_ROAD:
      return { severity: 'bad', text: 'No plan in time: stopping along the road' };
    default:
      return { severity: 'bad', text: `Unknown rung ${rung}` };
  }
}

/** How the solve ended, by Frame.solve_status. */
export function statusInWords(status: number): Sentence {
  switch (status) {
    case STATUS.OPTIMAL:
      return { severity: 'good', text: 'Optimal' };
    case STATUS.BUDGET_SPENT:
      return { severity: 'good', text: 'Good enough: stopped at its limit of time or iterations, within tolerance' };
    case STATUS.STALLED:
      return { severity: 'bad', text: 'Did not converge' };
    case STATUS.INFEASIBLE:
      return { severity: 'bad', text: 'Infeasible: not all constraints can hold' };
    case STATUS.NOT_FINITE:
      return { severity: 'bad', text: 'Invalid number (NaN) in the problem' };
    default:
      return { severity: 'bad', text: `Unknown status ${status}` };
  }
}

export const gateInWords = (isGated: boolean): Sentence =>
  isGated
    ? { severity: 'warning', text: 'Changed the command' }
    : { severity: 'good', text: 'Passed the command unchanged' };

/** Where the car is relative to the road. An external simulator does not report it: the distance is unknown. */
export function roadInWords(frame: Pick<Frame, 'is_off_track' | 'edge_distance_m' | 'off_track_events'>): Sentence {
  if (Number.isNaN(frame.edge_distance_m))
    return { severity: 'unknown', text: 'Unknown: the simulator does not report it' };
  if (frame.is_off_track) return { severity: 'bad', text: 'Off the road' };
  const events = frame.off_track_events;
  if (events > 0)
    return { severity: 'warning', text: `On the road, left it ${events === 1 ? 'once' : `${events} times`}` };
  return { severity: 'good', text: 'On the road, never left it' };
}

/** How much road ahead the controller knows: from its map, or from the waypoints received. */
export function sightInWords(hasMap: boolean, metres: number): Sentence {
  const sight = metres > 0 ? `${Math.round(metres)} m` : 'no road';
  return { severity: 'good', text: hasMap ? `Track known, uses ${sight} of it` : `Sees ${sight} ahead` };
}

/** What limits the speed, by Frame.speed_limiter: headline, reason, and short name for charts. */
export const LIMITERS: readonly { readonly title: string; readonly why: string; readonly short: string }[] = [
  { title: 'Not known', why: 'The controller does not report what limits the speed.', short: 'unknown' },
  { title: 'Reference speed', why: 'The car may drive no faster than its speed reference.', short: 'reference' },
  {
    title: 'Grip in the bend',
    why: 'Any faster, and the bend would take more of the grip than the plan may use.',
    short: 'grip',
  },
  {
    title: 'Braking for a bend',
    why: 'Any faster, and the car could not brake in time for the bend.',
    short: 'braking',
  },
  { title: 'Power', why: 'Full throttle gives no more.', short: 'power' },
  { title: 'Sight', why: 'The road is not known far enough ahead to drive faster.', short: 'sight' },
];

export const limiterInWords = (limiter: number): (typeof LIMITERS)[number] =>
  LIMITERS[limiter] ?? {
    title: `Limit ${limiter}`,
    why: 'This version of the dashboard does not know this limit.',
    short: `${limiter}`,
  };

/** snake_case to words, with abbreviations in capitals. */
export const nameInWords = (name: string): string =>
  name
    .replace(/[_.-]+/g, ' ')
    .trim()
    .replace(/\b(mpc|pid|gps)\b/g, (short) => short.toUpperCase())
    .replace(/\bnan\b/g, 'NaN');

/** The constraint violated most in a solution; null when all hold to `tolerance`. */
export function worstInWords(
  frame: Pick<Frame, 'violation' | 'worst_stage' | 'worst_constraint'>,
  names: readonly string[],
  tolerance = 1e-6,
): string | null {
  const { violation, worst_stage: stage, worst_constraint: index } = frame;
  if (!(violation > tolerance) || index < 0) return null;
  const name = nameInWords(names[index] ?? `constraint ${index + 1}`);
  return `${name} exceeded by ${violation.toPrecision(2)} at step ${stage} of the plan`;
}
