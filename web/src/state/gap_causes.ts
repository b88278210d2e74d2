import type { Limit } from '../protocol/topics';
import type { CornerTime } from './time_won';

// What each cause takes of a lap's gap to the limit: the lap beside those that were driven again without it.

/** A corner, or the whole lap. */
export interface CausedGap {
  readonly name: string;
  readonly gap: number; // to the limit [s]
  /** What each of Limit.without takes of it [s]; not-a-number where it is not known. */
  readonly taken: readonly number[];
  readonly rest: number; // that none of them takes [s]
}

function causedGap(name: string, time: number, fastest: number, without: readonly number[]): CausedGap {
  const taken = without.map((other) => time - other);
  const known = taken.filter(Number.isFinite).reduce((a, b) => a + b, 0);
  return { name, gap: time - fastest, taken, rest: time - fastest - known };
}

/**
 * The gap of a lap by cause, for each corner and the whole lap; empty where the run was not driven again. `corners`:
 * what the lap lost to the limit in each; `lost`: in all [s].
 */
export function gapCauses(limit: Limit, corners: readonly CornerTime[], lost: number): CausedGap[] {
  const count = limit.corner_times_s.length;
  if (limit.without.length === 0 || corners.length !== count) return [];
  const rows = corners.map((corner, i) => {
    const fastest = limit.corner_times_s[i] ?? NaN;
    const without = limit.without.map((_, cause) => limit.without_corner_times_s[cause * count + i] ?? NaN);
    return causedGap(`T${corner.number}`, fastest + corner.lost, fastest, without);
  });
  const laps = Array.from(limit.without_lap_times_s);
  return [...rows, causedGap('Lap', limit.lap_time_s + lost, limit.lap_time_s, laps)];
}
