import { store } from '../lib/store';
import type { Frame } from '../protocol/topics';
import { ageAtArrival, link } from './link';
import { live } from './live';
import { isPaused } from './run';
import { showSituation } from './situation';

/** The frame that the page's text shows, renewed about ten times a second. */
export const shown = store.signal<Frame | null>('run', null);
/** Whole seconds since the last frame of a run that is not paused. */
export const silence = store.signal('page', 0);
/** Whole seconds by which the newest frame is older than the run, that is not paused, has come to. */
export const behind = store.signal('page', 0);

/** Brings what the text shows up to date; `now` as of performance.now(). */
export function refreshText(now: number): void {
  shown.value = live.frame;
  showSituation(live.frame);
  const isExpected = link.value === 'live' && live.frame !== null && !isPaused.value;
  const since = isExpected ? Math.max(0, (now - live.receivedAt) / 1000) : 0;
  silence.value = Math.floor(since);
  behind.value = isExpected ? Math.floor(since + ageAtArrival.value) : 0;
}
