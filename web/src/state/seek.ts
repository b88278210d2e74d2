import { store } from '../lib/store';

/** Jumps to a time of the recording that is shown [s]; null in a live run. */
export const seekTo = store.signal<((time: number) => void) | null>('page', null);
