// Laps of the run: the table that the program sends, and samples along the road.
import { computed } from '@preact/signals';
import { store } from '../lib/store';
import type { Frame, Lap } from '../protocol/topics';
import { LapSamples, momentOf } from './lap_samples';
import { bestOf } from './lap_table';
import { run } from './run';

const LAPS_KEPT = 1000; // chosen
/** Least time between updates of `laps` [ms]: a page that is opened late receives a thousand laps at once; chosen. */
const PUBLISHED_EVERY_MS = 100;

/** Completed laps as the server sends them, by number: the newest ones and the best. */
export const laps = store.signal<readonly Lap[]>('moment', []);
/** The fastest lap time that a frame has reported [s], for runs that report no details of their laps. */
const bestSeen = store.signal('moment', NaN);
/** Time of the best lap [s], the same everywhere on the page; not-a-number before the first lap. */
export const bestLap = computed(() => bestOf(laps.value)?.lap_time_s ?? bestSeen.value);
/** Laps as functions of the distance, sampled from frames. */
export const lapSamples = new LapSamples();

/** Counts the laps that have been sampled to their end: views that show samples read it, and follow. */
export const sampledLaps = store.signal('page', 0);

/** Laps that were received, and whether they are all of a recording, or wait for the next update of `laps`. */
const table = store.data('page', () => ({ hasAllLaps: false, kept: [] as readonly Lap[], isHeldBack: false }));

/** Keeps the laps and samples of a recording, which are read as a whole, whatever moment of it is shown. */
export function keepAllLaps(): void {
  table.hasAllLaps = true;
  publish(); // at once: all of them are sampled next
}

/** Updates `laps` at once, or after the last update has been long enough ago. */
function publish(): void {
  if (table.hasAllLaps) laps.value = table.kept; // a moment of a recording is shown as a whole
  if (table.hasAllLaps || table.isHeldBack) return;
  table.isHeldBack = true;
  laps.value = table.kept;
  setTimeout(() => {
    table.isHeldBack = false;
    if (laps.peek() !== table.kept) publish();
  }, PUBLISHED_EVERY_MS);
}

/** Clears all laps; the samples of a recording stay. */
export function forgetLaps(): void {
  table.kept = [];
  table.isHeldBack = false;
  laps.value = table.kept;
  bestSeen.value = NaN;
  if (!table.hasAllLaps) lapSamples.clear();
}

store.onReset('moment', forgetLaps);

/** Clears the samples of laps, which are made of frames; the table of laps stays. */
export function forgetSamples(): void {
  if (!table.hasAllLaps) lapSamples.clear();
}

/** Stores a completed lap. */
export function receiveLap(lap: Lap): void {
  const before = table.kept;
  const isNext = before.length === 0 || (before.at(-1)?.lap ?? 0) < lap.lap;
  const all = isNext
    ? [...before, lap]
    : [...before.filter((each) => each.lap !== lap.lap), lap].sort((a, b) => a.lap - b.lap);
  lapSamples.complete(lap.lap - 1, lap.lap_time_s); // after the last lap no frame says so
  sampledLaps.value = lapSamples.completed;
  const best = all.length > LAPS_KEPT ? bestOf(all) : undefined;
  table.kept = all.filter((each, i) => i >= all.length - LAPS_KEPT || each === best);
  publish();
}

/** Adds a frame to the samples of its lap. */
export function sampleLap(frame: Frame): void {
  lapSamples.setLength(run.value?.track_length_m ?? NaN);
  lapSamples.push(frame.lap, momentOf(frame), frame.last_lap_time_s);
  sampledLaps.value = lapSamples.completed;
}

/** Updates samples and best time by a frame. */
export function noteLap(frame: Frame): void {
  if (!table.hasAllLaps) sampleLap(frame);
  if (frame.last_lap_time_s > 0 && !(frame.last_lap_time_s >= bestSeen.value)) bestSeen.value = frame.last_lap_time_s;
}
