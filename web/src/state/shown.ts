import { signal } from '@preact/signals';
import type { Frame } from '../protocol/topics';
import { link } from './link';
import { live } from './live';
import { isPaused } from './run';

/** The frame that the page's text shows, renewed about ten times a second. */
export const shown = signal<Frame | null>(null);
/** Whole seconds since the last frame of a run that is not paused. */
export const silence = signal(0);

/** Brings what the text shows up to date; `now` as of performance.now(). */
export function refreshText(now: number): void {
  shown.value = live.frame;
  const isExpected = link.value === 'live' && live.frame !== null && !isPaused.value;
  silence.value = isExpected ? Math.max(0, Math.floor((now - live.receivedAt) / 1000)) : 0;
}
