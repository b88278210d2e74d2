import { computed, signal } from '@preact/signals';
import type { Run } from '../protocol/topics';

/** Track, car, controller and state of the run; null until the program has sent it. */
export const run = signal<Run | null>(null);

export const isPaused = computed(() => run.value?.is_paused ?? false);

export function receiveRun(message: Run): void {
  run.value = message;
}
