import type { Frame, Run } from '../protocol/topics';

// What older programs, and their recordings, do not tell.

const UNKNOWN_FRAME: Partial<Frame> = {
  steer_sent_rad: NaN,
  throttle_sent: NaN,
  pace: NaN,
  is_manual: false,
  cost_terms: new Float64Array(),
  speed_limiter: 0,
  speed_limit_mps: NaN,
  active_now: 0,
  active_ahead: 0,
  front_tire_use: NaN,
  rear_tire_use: NaN,
  active_faults: 0,
  stationarity: NaN,
  violation: NaN,
  worst_stage: -1,
  worst_constraint: -1,
  prediction_error_m: NaN,
};

const UNKNOWN_RUN: Partial<Run> = {
  mode: '',
  cost_term_names: [],
  constraint_names: [],
  fault_names: [],
  kerb_width_m: 0,
  building: '',
};

/** A frame with every field; unknown where the sender does not tell. */
export const completeFrame = (frame: Frame): Frame => ({ ...UNKNOWN_FRAME, ...frame });

export const completeRun = (run: Run): Run => ({ ...UNKNOWN_RUN, ...run });
