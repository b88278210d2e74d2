import { store } from '../lib/store';
import type { Sentence } from '../lib/words';
import { type Frame, type Situation, timeOf } from '../protocol/topics';
import { REPLAY_S } from './replay';

// The situation of the run in each control cycle, as the program words it; the page only shows it.

/** The situation of the frame that the page's text shows; null before the program has sent one. */
export const situation = store.signal<Situation | null>('run', null);

const MOST_KEPT = 1200; // chosen
/**
 * Time for which an alarm stays after its last cycle [s]: that of telemetry::kAlarmPause, by which events are counted.
 */
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
 * Shows the situation of a frame, else the newest one before it. An alarm stays for ALARM_HELD_S: a guard that stops
 * and releases the car in turn raises one alarm. Driving by hand ends it.
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
