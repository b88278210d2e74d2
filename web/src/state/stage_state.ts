// State of the run in the header: its word, the one button that Space presses, and remarks on what is unusual.
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

/** The button of the header, by the state of the run. */
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

/** Frames of the past still to come above which they are mentioned: fewer come within a moment; chosen. */
const SOON = 400;

/** Remarks on what is not normal in the run, in a few words each. */
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
