import { computed } from '@preact/signals';
import { plural } from '../lib/format';
import { type Severity, sentenceOf } from '../lib/words';
import { attempt, link } from './link';
import { run } from './run';

/** Why the run is not going on, as a card says it; null while it goes on. */
export interface RunEnd {
  readonly kind: 'finished' | 'stopped' | 'failed' | 'lost';
  readonly severity: Severity;
  readonly title: string;
  readonly why: string;
}

/** Attempts to reconnect up to which a lost connection is not called an end; chosen. */
const HICCUPS = 3;

/** The end of the run; null while it goes on, or for a recording. */
export const runEnd = computed<RunEnd | null>(() => {
  const now = run.value;
  if (!now || now.mode === 'replay') return null;
  if (now.end !== '') return endOf(now.end, now.end_reason);
  if (link.value !== 'lost' || attempt.value < HICCUPS) return null;
  return {
    kind: 'lost',
    severity: 'bad',
    title: 'Connection lost',
    why:
      'The program said no goodbye: it crashed, was killed, or the network between is cut. ' +
      `Trying again (${plural(attempt.value, 'attempt')}).`,
  };
});

/** Words for an end that the program reports. */
function endOf(kind: string, reason: string): RunEnd {
  if (kind === 'finished') return { kind, severity: 'good', title: 'Finished', why: 'All laps that were asked for.' };
  if (kind === 'stopped') {
    const why = sentenceOf(reason.replace(/^stopped /, ''));
    return { kind, severity: 'unknown', title: 'Stopped', why };
  }
  const isOff = /left the road/.test(reason);
  return { kind: 'failed', severity: 'bad', title: isOff ? 'Off the road' : 'Not finished', why: sentenceOf(reason) };
}
