// The fastest possible lap ("the limit"), and its comparison with driven laps.
import { firstSince, mix, mod } from '../lib/math';
import { store } from '../lib/store';
import type { Lap, Limit } from '../protocol/topics';
import type { LapChannel, LapSamples } from './lap_samples';

/** The fastest lap possible on this road with this car; null while it is not known. */
export const limit = store.signal<Limit | null>('run', null);
/** Why it is not known, in one sentence; empty while the program gives no reason. */
export const whyNoLimit = store.signal('run', '');

/** Stores the limit, or why it is not known. */
export function receiveLimit(message: Limit): void {
  limit.value = message.is_known ? message : null;
  whyNoLimit.value = message.is_known ? '' : message.why_not;
}

/** Columns of the limit that correspond to channels of a driven lap. */
const COLUMNS: Partial<Record<LapChannel, 'time_s' | 'speed_mps' | 'n_m' | 'x_m' | 'y_m'>> = {
  time_s: 'time_s',
  speed_mps: 'speed_mps',
  lateral_error_m: 'n_m',
  x_m: 'x_m',
  y_m: 'y_m',
};

/** How much slower a lap was than the limit [%]: as sent with it, or computed where the limit was found later. */
export function gapToLimit(lap: Lap, limit: Limit | null): number {
  if (Number.isFinite(lap.gap_to_limit_percent)) return lap.gap_to_limit_percent;
  return limit && lap.lap >= limit.first_lap ? 100 * (lap.lap_time_s / limit.lap_time_s - 1) : NaN;
}

/** Distances to the points of each limit, computed once. */
const drivenTo = new WeakMap<Limit, Float64Array>();

/**
 * Distance from the start line to each point of the limit [m]. Points are in the order of the lap, which may begin
 * anywhere along the road: `s_m` starts again from 0 on the way.
 */
function drivenDistances(limit: Limit, length: number): Float64Array {
  const known = drivenTo.get(limit);
  if (known) return known;
  const distances = new Float64Array(limit.s_m.length);
  for (let i = 1; i < distances.length; ++i)
    distances[i] = (distances[i - 1] ?? NaN) + mod((limit.s_m[i] ?? NaN) - (limit.s_m[i - 1] ?? NaN), length);
  drivenTo.set(limit, distances);
  return distances;
}

/** A column of the limit at a place along the centre line, from its origin [m]; NaN where the limit does not reach. */
function valueAt(limit: Limit, column: ArrayLike<number>, length: number, place: number): number {
  if (limit.s_m.length < 2 || !(length > 0) || !Number.isFinite(place)) return NaN;
  const distances = drivenDistances(limit, length);
  const driven = mod(place - (limit.s_m[0] ?? NaN), length);
  if (driven > (distances.at(-1) ?? NaN) + 1e-3) return NaN; // 1 mm: the lap is closed up to rounding
  const next = Math.min(Math.max(1, firstSince(distances, driven)), distances.length - 1);
  const [from, to] = [distances[next - 1] ?? NaN, distances[next] ?? NaN];
  const share = to > from ? Math.min(1, (driven - from) / (to - from)) : 0;
  return mix(column[next - 1] ?? NaN, column[next] ?? NaN, share);
}

/**
 * Time of the fastest possible lap at a place along a road of this length [s]; not-a-number outside of it. `elapsed`:
 * of the lap that is compared with it; no lap is half a lap ahead of the limit, so just before and behind the line it
 * decides between the end of a lap and its beginning.
 */
export function limitTimeAt(limit: Limit, length: number, place: number, elapsed: number): number {
  const time = valueAt(limit, limit.time_s, length, place);
  return time - elapsed > limit.lap_time_s / 2 ? time - limit.lap_time_s : time;
}

/**
 * A column of the limit at the points where laps are sampled, from the start line on; null for channels it does not
 * have.
 */
export function limitChannel(limit: Limit, samples: LapSamples, name: LapChannel): Float64Array | null {
  const column = COLUMNS[name];
  if (!column || limit.s_m.length < 2 || !Number.isFinite(samples.place(0))) return null;
  return Float64Array.from({ length: samples.points }, (_, point) => {
    const value = valueAt(limit, limit[column], samples.length, samples.place(point));
    if (column !== 'time_s') return value;
    // Lines that were found from frames lie up to a few centimetres beside the limit's.
    const expected = (limit.lap_time_s * samples.s(point)) / samples.length;
    return value - limit.lap_time_s * Math.round((value - expected) / limit.lap_time_s);
  });
}
