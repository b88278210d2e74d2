import { signal } from '@preact/signals';
import { firstSince } from '../draw/axis';
import { mix } from '../lib/math';
import type { Lap, Limit } from '../protocol/topics';
import type { LapChannel, LapSamples } from './lap_samples';

/** The fastest lap possible on this road with this car; null while it is not known. */
export const limit = signal<Limit | null>(null);
/** Why it is not known, in one sentence; empty while the program gives no reason. */
export const whyNoLimit = signal('');

export function receiveLimit(message: Limit): void {
  limit.value = message.is_known ? message : null;
  whyNoLimit.value = message.is_known ? '' : message.why_not;
}

export function forgetLimit(): void {
  limit.value = null;
  whyNoLimit.value = '';
}

/** Columns of the limit that correspond to channels of a driven lap. */
const COLUMNS: Partial<Record<LapChannel, 'time_s' | 'speed_mps' | 'n_m' | 'x_m' | 'y_m'>> = {
  time_s: 'time_s',
  speed_mps: 'speed_mps',
  lateral_error_m: 'n_m',
  x_m: 'x_m',
  y_m: 'y_m',
};

const gap = (time: number, limit: number | undefined): number => 100 * (time / (limit ?? NaN) - 1);

/**
 * How much slower a lap and its sectors were than the limit [%]: as sent with the lap, or computed where the limit was
 * found later.
 */
export function gapsToLimit(lap: Lap, limit: Limit | null): { lap: number; sectors: readonly number[] } {
  const of = limit && lap.lap >= limit.first_lap ? limit : null;
  const known = (told: number | undefined, computed: number): number =>
    Number.isFinite(told) ? (told ?? NaN) : computed;
  return {
    lap: known(lap.gap_to_limit_percent, gap(lap.lap_time_s, of?.lap_time_s)),
    sectors: [0, 1, 2].map((i) =>
      known(lap.sector_gaps_to_limit_percent[i], gap(lap.sector_times_s[i] ?? NaN, of?.sector_times_s[i])),
    ),
  };
}

/** Time of the fastest possible lap at a distance along the road [s]; not-a-number outside of it. */
export function limitTimeAt({ s_m: places, time_s: times }: Limit, s: number): number {
  if (places.length < 2 || !Number.isFinite(s)) return NaN;
  // Points are in the order of the lap, whose start need not be where s is 0.
  for (let i = 1; i < places.length; ++i) {
    const [from, to] = [places[i - 1] ?? NaN, places[i] ?? NaN];
    if (!(s >= from && s <= to)) continue;
    return mix(times[i - 1] ?? NaN, times[i] ?? NaN, to > from ? (s - from) / (to - from) : 0);
  }
  return NaN;
}

/**
 * A column of the limit at the points where laps are sampled, from the start line on; null for channels it does not
 * have.
 */
export function limitChannel(limit: Limit, samples: LapSamples, name: LapChannel): Float64Array | null {
  const column = COLUMNS[name];
  if (!column || limit.s_m.length < 2 || !Number.isFinite(samples.place(0))) return null;
  const [values, places, times] = [limit[column], limit.s_m, limit.time_s];
  return Float64Array.from({ length: samples.points }, (_, point) => {
    const s = samples.place(point);
    const above = Math.min(Math.max(1, firstSince(places, s)), places.length - 1);
    const at = (row: ArrayLike<number>, i: number): number => row[i] ?? NaN;
    const isOverTheLine = at(times, above) < at(times, above - 1);
    const share = (s - at(places, above - 1)) / (at(places, above) - at(places, above - 1));
    return isOverTheLine && column === 'time_s' ? NaN : mix(at(values, above - 1), at(values, above), share);
  });
}
