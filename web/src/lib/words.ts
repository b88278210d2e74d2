// Words for what messages report of guard, solver, gate, road and constraints; and small functions on texts.
import { REASON, REASON_WORDS, RUNG, RUNG_WORDS, type SPEED_LIMITER, STATUS_WORDS } from '../protocol/messages';
import type { Frame } from '../protocol/topics';

/** How bad a state is. */
export type Severity = 'good' | 'warning' | 'bad' | 'unknown';

/** A text about a state, with its severity. */
export interface Sentence {
  readonly severity: Severity;
  readonly text: string;
}

/** The text with a capital. */
export const capital = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

/** A text with a capital and a full stop; an empty text stays empty. */
export const sentenceOf = (text: string): string =>
  text === '' ? '' : `${capital(text)}${text.endsWith('.') ? '' : '.'}`;

/** Message of a value that was thrown. */
export const reasonOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

/** What the guard found, by Frame.guard_reason. */
export const reasonInWords = (reason: number): string => REASON_WORDS[reason]?.text ?? `unknown reason ${reason}`;

/**
 * The source of the command, by Frame.rung, and why. A reason explains every source but the controller, and that one
 * where it holds the car back.
 */
export function rungInWords(rung: number, reason: number = REASON.NONE): Sentence {
  const source = RUNG_WORDS[rung];
  if (!source) return { severity: 'bad', text: `Unknown rung ${rung}` };
  const text = capital(source.text);
  const why = REASON_WORDS[reason]?.severity ?? 'bad';
  const isReplaced = rung !== RUNG.CONTROLLER;
  const isHeldBack = !isReplaced && why === 'warning';
  if (reason === REASON.NONE || !(isReplaced || isHeldBack)) return { severity: source.severity, text };
  return { severity: isHeldBack ? why : source.severity, text: `${text}: ${reasonInWords(reason)}` };
}

/** How the solve ended, by Frame.solve_status. */
export function statusInWords(status: number): Sentence {
  const words = STATUS_WORDS[status];
  return words
    ? { severity: words.severity, text: capital(words.text) }
    : { severity: 'bad', text: `Unknown status ${status}` };
}

/** What became of the controller's command, by Frame.rung and Frame.is_gated. */
export function gateInWords({ rung, is_gated }: Pick<Frame, 'rung' | 'is_gated'>): Sentence {
  if (rung !== RUNG.CONTROLLER) return { severity: 'warning', text: 'Sent another command' };
  return is_gated
    ? { severity: 'warning', text: 'Changed the command' }
    : { severity: 'good', text: 'Passed the command unchanged' };
}

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

/** What limits the speed, as charts call it; the sentences are the program's (road/reference_line.hpp). */
const LIMITER_NAMES: Readonly<Record<keyof typeof SPEED_LIMITER, string>> = {
  NONE: 'not said',
  ASKED: 'asked for',
  CURVATURE: 'grip',
  BRAKING: 'braking',
  POWER: 'power',
  SIGHT: 'sight',
  PART_THROTTLE: 'part throttle',
  STEER_RATE: 'steering',
  EDGE: 'edge',
  PLAN: 'planned lap',
};

/** What limits the speed, by Frame.speed_limiter. */
export const LIMITERS: readonly string[] = Object.values(LIMITER_NAMES);

/** The last part of a key: "latency" of `a.b.latency`. */
export const lastPart = (key: string): string => key.split('.').at(-1) ?? key;

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
