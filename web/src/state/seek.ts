import { signal } from '@preact/signals';

/** Jumps to a time of the recording that is shown [s]; null in a live run. */
export const seekTo = signal<((time: number) => void) | null>(null);
