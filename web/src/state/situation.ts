import { store } from '../lib/store';
import type { Sentence } from '../lib/words';
import { type Frame, type Situation, timeOf } from '../protocol/topics';
import { REPLAY_S } from './replay';

// What the program says of the run in each control cycle. The page shows it, and decides nothing.

/** Of the frame that the page's text shows; null before the program has said anything. */
export const situation = store.signal<Situation | null>('run', null);

const MOST_KEPT = 1200;
/** An alarm stays for so long after its last cycle, as the program counts events (telemetry::kAlarmPause) [s]. */
const ALARM_HELD_S = 1;
const kept = store.data('moment', () => ({ recent: [] as Situation[] }));

/** Keeps the situations of the last seconds, which may be shown again. */
export function receiveSituation(message: Situation): void {
  const last = kept.recent.at(-1);
  if (last && timeOf(message) < timeOf(last)) kept.recent = [];
  kept.recent.push(message);
  const isOld = timeOf(message) - timeOf(kept.recent[0] ?? message) > 2 * REPLAY_S;
  if (isOld || kept.recent.length > MOST_KEPT) kept.recent.splice(0, kept.recent.length / 2);
}

/**
 * Shows the one of a frame; without one yet, the newest before it. An event is one alarm, also where the guard stops
 * the car and lets it go in turn; who takes the wheel ends it.
 */
export function showSituation(frame: Frame | null): void {
  const time = (frame?.time_s ?? NaN) + 1e-6;
  const now = kept.recent.findLast((each) => timeOf(each) <= time) ?? null;
  const isEvent = (each: Situation): boolean => {
    const age = time - timeOf(each);
    return each.severity === 'alarm' && age >= 0 && age <= ALARM_HELD_S;
  };
  situation.value = now?.driver === 'person' ? now : (kept.recent.findLast(isEvent) ?? now);
}

const SEVERITY = { normal: 'good', notice: 'warning', alarm: 'bad' } as const;

/** "The guard stops the car: the controller has no answer" */
export const situationInWords = ({ severity, sentence, reason }: Situation): Sentence => ({
  severity: SEVERITY[severity as keyof typeof SEVERITY] ?? 'unknown',
  text: reason === '' ? sentence : `${sentence}: ${reason}`,
});
