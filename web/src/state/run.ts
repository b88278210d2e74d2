import { computed } from '@preact/signals';
import { store } from '../lib/store';
import type { Run } from '../protocol/topics';

/** Track, car, controller and state of the run; null until the program has sent it. */
export const run = store.signal<Run | null>('page', null);

/** Whether the run is paused. */
export const isPaused = computed(() => run.value?.is_paused ?? false);

/** What watches over the controller: "guard on (road from track, version 2)"; empty for older recordings. */
export const guardInWords = ({ guard_mode, guard_road, guard_version }: Run): string =>
  guard_mode === '' ? '' : `guard ${guard_mode} (road from ${guard_road}, version ${guard_version})`;

/** Stores the description of the run. */
export function receiveRun(message: Run): void {
  run.value = message;
}
