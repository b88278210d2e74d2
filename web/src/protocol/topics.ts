// Types of the messages this page reads; their one definition is the schema text that the server advertises
// (src/chicane/protocol/ros_schemas.hpp), checked against these names in fixtures.test.ts.

export interface Stamp {
  sec: number;
  nsec: number;
}

/** chicane_msgs/msg/Frame. SI units and radians, left positive, not-a-number for unknown. */
export interface Frame {
  stamp: Stamp;
  cycle: bigint;
  time_s: number;
  has_truth: boolean;
  x_m: number;
  y_m: number;
  yaw_rad: number;
  vx_mps: number;
  vy_mps: number;
  yaw_rate_radps: number;
  speed_mps: number;
  longitudinal_acceleration_mps2: number;
  lateral_acceleration_mps2: number;
  measured_x_m: number;
  measured_y_m: number;
  measured_yaw_rad: number;
  measured_speed_mps: number;
  s_m: number;
  lateral_error_m: number;
  heading_error_rad: number;
  edge_distance_m: number;
  is_off_track: boolean;
  off_track_events: number;
  lap: number;
  lap_time_s: number;
  last_lap_time_s: number;
  steer_asked_rad: number;
  steer_applied_rad: number;
  throttle_asked: number;
  throttle_applied: number;
  rung: number;
  solve_status: number;
  is_gated: boolean;
  has_map: boolean;
  iterations: number;
  sweeps: number;
  cost: number;
  step_time_us: number;
  delay_s: number;
  speed_reference_mps: number;
  sight_m: number;
  tracked_lateral_error_m: number;
  tracked_heading_error_rad: number;
  steer_sent_rad: number;
  throttle_sent: number;
  pace: number;
  is_manual: boolean;
  cost_terms: Float64Array;
  speed_limiter: number;
  speed_limit_mps: number;
  active_now: number;
  active_ahead: number;
  front_tire_use: number;
  rear_tire_use: number;
  active_faults: number;
  stationarity: number;
  violation: number;
  worst_stage: number;
  worst_constraint: number;
  prediction_error_m: number;
}

/** Frame.speed_limiter */
export const SPEED_LIMITER = { NONE: 0, ASKED: 1, CURVATURE: 2, BRAKING: 3, POWER: 4, SIGHT: 5 } as const;

/** chicane_msgs/msg/Plan: columns of equal length. */
export interface Plan {
  stamp: Stamp;
  time_s: Float64Array;
  x_m: Float64Array;
  y_m: Float64Array;
  yaw_rad: Float64Array;
  speed_mps: Float64Array;
  steer_rad: Float64Array;
  throttle: Float64Array;
}

/** chicane_msgs/msg/Run */
export interface Run {
  track: string;
  track_length_m: number;
  is_closed: boolean;
  controller: string;
  preset: string;
  latency_s: number;
  control_period_s: number;
  is_paused: boolean;
  car: string;
  front_axle_m: number;
  rear_axle_m: number;
  track_width_m: number;
  tire_width_m: number;
  body_length_m: number;
  body_width_m: number;
  steer_limit_rad: number;
  mode: string;
  cost_term_names: string[];
  constraint_names: string[];
  fault_names: string[];
  kerb_width_m: number;
  /** Another run that is being built, in words; empty: none. */
  building: string;
}

/** chicane_msgs/msg/Lap: one completed lap */
export interface Lap {
  lap: number;
  lap_time_s: number;
  sector_times_s: Float64Array;
  is_clean: boolean;
  mean_speed_mps: number;
  top_speed_mps: number;
  min_edge_distance_m: number;
  rms_lateral_error_m: number;
  gap_to_limit_percent: number;
  sector_gaps_to_limit_percent: Float64Array;
}

/**
 * chicane_msgs/msg/Limit: the fastest lap that is possible, and its line; columns of equal length, empty while it is
 * not known
 */
export interface Limit {
  is_known: boolean;
  lap_time_s: number;
  sector_times_s: Float64Array;
  s_m: Float64Array;
  x_m: Float64Array;
  y_m: Float64Array;
  n_m: Float64Array;
  speed_mps: Float64Array;
  longitudinal_acceleration_mps2: Float64Array;
  lateral_acceleration_mps2: Float64Array;
  time_s: Float64Array;
  /** In one sentence, while it is not known; older programs do not tell. */
  why_not?: string;
  /** It holds for laps from this one on: before, grip or mass of the car were others; older programs do not tell. */
  first_lap?: number;
}

/** chicane_msgs/msg/Change: a setting that changed during the run */
export interface Change {
  stamp: Stamp;
  cycle: bigint;
  name: string;
  value: string;
}

/** The part of nav_msgs/msg/Path this page draws. */
export interface Path {
  poses: { pose: { position: { x: number; y: number } } }[];
}

/** The topics this page subscribes to, and what they carry. */
export interface Topics {
  '/chicane/frame': Frame;
  '/chicane/plan': Plan;
  '/chicane/run': Run;
  '/reference': Path;
  '/track/left': Path;
  '/track/right': Path;
  '/track/centre': Path;
  '/chicane/lap': Lap;
  '/chicane/change': Change;
  '/chicane/limit': Limit;
}

export type TopicName = keyof Topics;

export const TOPIC_NAMES: readonly TopicName[] = [
  '/chicane/frame',
  '/chicane/plan',
  '/chicane/run',
  '/reference',
  '/track/left',
  '/track/right',
  '/track/centre',
  '/chicane/lap',
  '/chicane/change',
  '/chicane/limit',
];
