// View of the plots over time: window, hold, zoom, cursor and mark.
import { persisted } from '../lib/persisted';
import { store } from '../lib/store';
import { COLUMN_COUNT, Column } from './columns';
import { History } from './history';
import { LONGEST_WINDOW_S, live } from './live';

/** Lengths of the time axis that can be chosen [s]. */
export const WINDOWS_S = [10, 20, 60] as const;

/** How far back plots reach while they follow the run [s]. */
export const windowSeconds = persisted<number>('plots.window', 20, (value) =>
  (WINDOWS_S as readonly unknown[]).includes(value),
);
/** Whether the plots are held while the run goes on. */
export const isFrozen = store.signal('page', false);
/** The time range zoomed into [s]; the plots are then held. */
export const zoomed = store.signal<readonly [number, number] | null>('page', null);
/** Time under the cursor of any plot [s]; null when it is over none. */
export const cursorTime = store.signal<number | null>('page', null);

/** Time of the mark that a click sets, the second cursor [s]; null: none. Plots then show differences from it. */
export const markTime = store.signal<number | null>('page', null);

/** Sets the mark where the cursor is, or takes it away. */
export function toggleMark(): void {
  markTime.value = markTime.value === null ? (cursorTime.value ?? newestTime()) : null;
}

/** A place on a lap that is compared, under the cursor: the lap from 0, and metres along the road; null: over none. */
export const cursorPlace = store.signal<{ readonly lap: number; readonly place: number } | null>('page', null);

/** The history at the moment the plots were held. */
const frozen = store.data('page', () => ({ history: null as History | null }));

/** The history that plots draw: the live one, or a copy from the moment they were held. */
export const plotted = (): History => (isFrozen.value && frozen.history) || live.plots;

/** Time of the newest row that is plotted [s]; null without any. */
function newestTime(): number | null {
  const newest = plotted().newest(Column.time_s);
  return Number.isFinite(newest) ? newest : null;
}

/** Holds the plots as they are now. */
export function freeze(): void {
  if (isFrozen.value) return;
  frozen.history ??= new History(COLUMN_COUNT, live.plots.capacity);
  frozen.history.copyFrom(live.plots);
  isFrozen.value = true;
}

/** Lets the plots follow the run again, without zoom, cursor and mark. */
export function thaw(): void {
  isFrozen.value = false;
  zoomed.value = null;
  cursorTime.value = null;
  markTime.value = null;
}

/** Holds the plots, or lets them follow. */
export const toggleFrozen = (): void => (isFrozen.value ? thaw() : freeze());

/** Zooms into a time range [s]; ranges up to 50 ms are ignored. */
export function zoomTo(from: number, to: number): void {
  if (!(to - from > 0.05)) return;
  freeze();
  zoomed.value = [from, to];
}

/** First and last time of the axis [s]. */
export function timeRange(): [number, number] {
  if (zoomed.value) return [zoomed.value[0], zoomed.value[1]];
  const newest = plotted().newest(Column.time_s);
  const end = Number.isFinite(newest) ? newest : 0;
  return [end - Math.min(windowSeconds.value, LONGEST_WINDOW_S), end];
}
