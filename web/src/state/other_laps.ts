import { mod } from '../lib/math';
import { store } from '../lib/store';
import type { Lap } from '../protocol/topics';
import type { LapChannel, LapSamples } from './lap_samples';

// Laps of other recordings on the same road, for comparison with the laps of the run.

/** A lap of another recording. */
export interface OtherLap {
  readonly recording: string;
  /** As the recording counts. */
  readonly lap: number;
  readonly time: number; // [s]
  readonly samples: LapSamples;
}

/** Laps that can be compared with those of the run. */
export const otherLaps = store.signal<readonly OtherLap[]>('page', []);

/** Difference in length up to which two roads are the same [m]; chosen. */
const SAME_LENGTH_M = 0.5;

/** Whether laps were driven on the same road. */
export const isSameRoad = (a: LapSamples, b: LapSamples): boolean => Math.abs(a.length - b.length) <= SAME_LENGTH_M;

/** Adds the sampled laps of a recording, which replaces one of that name. */
export function addOtherLaps(recording: string, laps: readonly Lap[], samples: LapSamples): void {
  const kept = otherLaps.value.filter((each) => each.recording !== recording);
  const known = laps.filter(({ lap }) => samples.laps.includes(lap - 1));
  otherLaps.value = [...kept, ...known.map(({ lap, lap_time_s: time }) => ({ recording, lap, time, samples }))];
}

/** Removes them all. */
export function removeOtherLaps(): void {
  otherLaps.value = [];
}

/** Points by which two start lines found from frames may differ though they are the same; chosen. */
const SAME_LINE = 2;

/**
 * The lap's time at its point `first`, where the other line is [s]. A lap that was recorded in part is not known there:
 * between two findings of the same line it has the speed of its end.
 */
function timeAtLine({ lap, samples }: OtherLap, first: number): number {
  const known = samples.channel(lap - 1, 'time_s')?.[first] ?? NaN;
  if (Number.isFinite(known) || first > SAME_LINE) return known;
  const speeds = samples.channel(lap - 1, 'speed_mps')?.filter(Number.isFinite);
  return (first * samples.length) / samples.points / (speeds?.at(-1) ?? NaN);
}

/**
 * A channel of a lap at the points of `onto`, whose laps may begin elsewhere along the same road: the lap is then
 * closed, its end before its beginning, and its time counts from the line of `onto`.
 */
export function channelOnto(other: OtherLap, name: LapChannel, onto: LapSamples): Float64Array | null {
  const { lap, time, samples } = other;
  const values = samples.channel(lap - 1, name);
  if (!values || !isSameRoad(samples, onto)) return null;
  const { points } = samples;
  const pointOf = (each: LapSamples): number => Math.round((each.place(0) / each.length) * points);
  const first = mod(pointOf(onto) - pointOf(samples), points);
  if (!Number.isFinite(first)) return null;
  if (first === 0) return values;
  const begin = name === 'time_s' ? timeAtLine(other, first) : 0;
  const lapTime = name === 'time_s' ? time : 0;
  return values.map((_, i) => {
    const at = i + first;
    return (values[at % points] ?? NaN) - begin + (at >= points ? lapTime : 0);
  });
}
