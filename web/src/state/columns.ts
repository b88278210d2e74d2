import { degrees } from '../lib/math';
import type { Frame } from '../protocol/topics';

/** Most terms of a cost that are plotted; the last one takes the rest. */
export const COST_TERMS = 10;

const NAMES = [
  'time',
  'speed',
  'speedLimit',
  'speedReference',
  'lateralError',
  'headingError',
  'steerAsked',
  'steerSent',
  'steerApplied',
  'driveAsked',
  'driveSent',
  'driveApplied',
  'stepTime',
  'iterations',
  'status',
  'rung',
  'isGated',
  'frontTireUse',
  'rearTireUse',
  'predictionError',
  'limiter',
  'activeNow',
  'activeAhead',
  'lateralAcceleration',
  'longitudinalAcceleration',
  'x',
  'y',
  'isManual',
  'activeFaults',
  'cost',
] as const;

export type ColumnName = (typeof NAMES)[number];

/** Index of each column; those of the cost terms, each stacked on the one before, follow `cost`. */
export const Column = Object.fromEntries(NAMES.map((name, i) => [name, i])) as Readonly<Record<ColumnName, number>>;

export const COLUMN_COUNT = NAMES.length + COST_TERMS;

export const costColumn = (term: number): number => NAMES.length + Math.min(term, COST_TERMS - 1);

const percent = (share: number): number => share * 100;

/**
 * One row of the history for a frame, in the units of the axes but for speeds [m/s]. Written into `row`, which is
 * returned.
 */
export function plotRow(frame: Frame, row: number[]): number[] {
  row[Column.time] = frame.time_s;
  row[Column.speed] = frame.speed_mps;
  row[Column.speedLimit] = frame.speed_limit_mps;
  row[Column.speedReference] = frame.speed_reference_mps;
  row[Column.lateralError] = frame.lateral_error_m;
  row[Column.headingError] = degrees(frame.heading_error_rad);
  row[Column.steerAsked] = degrees(frame.steer_asked_rad);
  row[Column.steerSent] = degrees(frame.steer_sent_rad);
  row[Column.steerApplied] = degrees(frame.steer_applied_rad);
  row[Column.driveAsked] = percent(frame.throttle_asked);
  row[Column.driveSent] = percent(frame.throttle_sent);
  row[Column.driveApplied] = percent(frame.throttle_applied);
  row[Column.stepTime] = frame.step_time_us / 1000;
  row[Column.iterations] = frame.iterations;
  row[Column.status] = frame.solve_status;
  row[Column.rung] = frame.rung;
  row[Column.isGated] = frame.is_gated ? 1 : 0;
  row[Column.frontTireUse] = percent(frame.front_tire_use);
  row[Column.rearTireUse] = percent(frame.rear_tire_use);
  row[Column.predictionError] = frame.prediction_error_m;
  row[Column.limiter] = frame.speed_limiter;
  row[Column.activeNow] = frame.active_now;
  row[Column.activeAhead] = frame.active_ahead;
  row[Column.lateralAcceleration] = frame.lateral_acceleration_mps2;
  row[Column.longitudinalAcceleration] = frame.longitudinal_acceleration_mps2;
  row[Column.x] = frame.x_m;
  row[Column.y] = frame.y_m;
  row[Column.isManual] = frame.is_manual ? 1 : 0;
  row[Column.activeFaults] = frame.active_faults;
  row[Column.cost] = frame.cost;
  stack(frame.cost_terms, row);
  return row;
}

/** Running sums: the top of each coloured layer. Terms below zero have no layer. */
function stack(terms: ArrayLike<number>, row: number[]): void {
  let sum = 0;
  const known = Math.min(terms.length, COST_TERMS);
  for (let term = 0; term < Math.max(terms.length, COST_TERMS); ++term) {
    sum += Math.max(0, terms[term] ?? 0);
    row[costColumn(term)] = known === 0 ? NaN : sum;
  }
}
