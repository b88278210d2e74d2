// The best lap, and laps as CSV.
import { csv } from '../lib/csv';
import type { Lap, Limit } from '../protocol/topics';
import { LAP_CHANNELS, type LapSamples } from './lap_samples';
import { gapToLimit } from './limit';

/** The fastest clean lap, or the fastest if none is clean. The first begins from standstill: it counts when alone. */
export function bestOf(laps: readonly Lap[]): Lap | undefined {
  const timed = laps.filter(({ lap_time_s }) => Number.isFinite(lap_time_s));
  const clean = timed.filter(({ is_clean }) => is_clean);
  const flying = clean.filter(({ lap }) => lap > 1);
  const [first, ...others] = flying.length > 0 ? flying : clean.length > 0 ? clean : timed;
  return others.reduce((a, b) => (b.lap_time_s < (a?.lap_time_s ?? NaN) ? b : a), first);
}

const SECTORS = [1, 2, 3] as const;

/** The table of laps as CSV, in SI units. */
export function lapsCsv(laps: readonly Lap[], limit: Limit | null): string {
  const rows = laps.map((lap) => ({
    lap: lap.lap,
    lap_time_s: lap.lap_time_s,
    ...Object.fromEntries(SECTORS.map((sector) => [`sector_${sector}_s`, lap.sector_times_s[sector - 1] ?? NaN])),
    is_clean: lap.is_clean,
    mean_speed_mps: lap.mean_speed_mps,
    top_speed_mps: lap.top_speed_mps,
    min_edge_distance_m: lap.min_edge_distance_m,
    rms_lateral_error_m: lap.rms_lateral_error_m,
    gap_to_limit_percent: gapToLimit(lap, limit),
    by_hand_share: lap.by_hand_share,
    settings: lap.setting_names.map((name, i) => `${name}=${lap.setting_values[i]}`).join(' '),
  }));
  return csv(
    Object.keys(rows[0] ?? {}),
    rows.map((row) => Object.values(row)),
  );
}

/** The samples of a lap along the road as CSV; `index` counts from 0. */
export function lapSamplesCsv(samples: LapSamples, index: number): string {
  const channels = LAP_CHANNELS.map((name) => samples.channel(index, name) ?? new Float64Array());
  const rows = Array.from({ length: samples.points }, (_, point) => [
    samples.s(point),
    ...channels.map((channel) => channel[point] ?? NaN),
  ]);
  return csv(['s_m', ...LAP_CHANNELS], rows);
}
