import { computed } from '@preact/signals';
import { tidy } from '../lib/scale';
import { faultsInWords } from './faults';
import { link, pastLeft, services } from './link';
import { call, can, retry } from './operate';
import { endReplay, replayLeft } from './replay';
import { isPaused, run } from './run';
import { runEnd } from './run_end';
import { settings } from './settings';
import { behind, shown, silence } from './shown';

// What the header says of the run, and the one button that Space presses.

/** The state of the run in one or two words. */
export const stateWord = computed<string>(() => {
  const end = run.value?.end ?? '';
  if (replayLeft.value !== null) return `Replay, ${replayLeft.value} s left`;
  if (link.value === 'lost') return end === '' ? 'Not connected' : 'Program ended';
  if (link.value === 'connecting' || !run.value) return 'Connecting';
  if (run.value.mode === 'replay') return isPaused.value ? 'Recording' : 'Recording plays';
  if (isPaused.value) return 'Paused';
  if (run.value.building !== '') return 'Planning';
  if (end !== '') return 'Finished';
  if (silence.value > 0) return `No data for ${silence.value} s`;
  return behind.value > 0 ? `${behind.value} s behind` : 'Live';
});

/** Whether the picture is old: stage and strip are dimmed. */
export const isStale = computed(
  () => (run.value?.end ?? '') === '' && replayLeft.value === null && (link.value === 'lost' || silence.value > 0),
);

/** The button of the header; null where there is nothing to press. */
export interface OneButton {
  readonly label: string;
  readonly isPossible: boolean;
  act(): void;
}

export const oneButton = computed<OneButton | null>(() => {
  if (replayLeft.value !== null) return { label: 'End the replay', isPossible: true, act: endReplay };
  if (link.value === 'lost') return { label: 'Connect now', isPossible: true, act: retry };
  if (run.value?.mode === 'replay') {
    return services.value.has('/pause')
      ? { label: isPaused.value ? 'Play' : 'Pause', isPossible: true, act: () => call('/pause', !isPaused.value) }
      : null;
  }
  if (runEnd.value) {
    // A program that waits for the limit, or ends, begins nothing any more.
    const isPossible = can('/reset') && (isPaused.value || silence.value === 0);
    return isPossible ? { label: 'Drive again', isPossible, act: () => call('/reset') } : null;
  }
  if (!services.value.has('/pause')) return null;
  const label = isPaused.value ? 'Resume' : 'Pause';
  return { label, isPossible: can('/pause'), act: () => call('/pause', !isPaused.value) };
});

/** So many frames come within a moment on any line but a slow one. */
const SOON = 400;

/** What is not normal, in a few words each; of a run that is watched or shown again. */
export const pills = computed<readonly string[]>(() => {
  if (link.value === 'lost') return [];
  const frame = shown.value;
  const asked = settings.value.get('run.pace'); // a paused recording has no frame with a new pace
  const pace = typeof asked === 'number' ? asked : (frame?.pace ?? NaN);
  const laps = Number(settings.value.get('laps')); // 0: until it is stopped
  const next = (run.value?.building ?? '').replace(/\w+ = /g, ''); // "preset = race"
  const isLast = laps > 0 && run.value?.mode === 'drive' && run.value.end === '' && frame?.lap === laps - 1;
  return [
    ...(isLast ? ['Last lap'] : []),
    ...(next === '' ? [] : [`Next: ${next} …`]),
    ...(frame?.is_manual ? ['By hand'] : []),
    ...(frame ? faultsInWords(frame, run.value?.fault_names ?? []) : []),
    ...(pastLeft.value > SOON ? [`Loading the past: ${pastLeft.value} frames`] : []),
    ...(Number.isFinite(pace) && Math.abs(pace - 1) > 1e-6 ? [`${tidy(pace)}× speed`] : []),
  ];
});
