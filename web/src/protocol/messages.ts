// Messages of chicane_msgs as this page reads them. Made from their definitions, which follow from
// src/chicane/protocol/frame_fields.cpp and detail/ros_schemas.hpp; do not edit. As long as the
// messages are. Renewed by cmake --build --preset release --target renew_fixtures

export interface Stamp {
  sec: number;
  nsec: number;
}

/**
 * chicane_msgs/msg/Frame. One control cycle. SI units and radians; left, counter-clockwise and forward are positive.
 * Not-a-number: unknown.
 */
export interface Frame {
  stamp: Stamp;
  /** number of the control cycle */
  cycle: bigint;
  /** of the measurement, from the start of the run */
  time_s: number;
  /** the motion below is the simulator's truth; else as measured */
  has_truth: boolean;

  // Motion of the centre of mass; map is the world, yaw 0 along its x axis
  /** in map */
  x_m: number;
  /** in map */
  y_m: number;
  /** in map, counter-clockwise positive */
  yaw_rad: number;
  /** along the car */
  vx_mps: number;
  /** to its left */
  vy_mps: number;
  yaw_rate_radps: number;
  /** magnitude of the velocity */
  speed_mps: number;
  /** along the car */
  longitudinal_acceleration_mps2: number;
  /** to its left */
  lateral_acceleration_mps2: number;

  // Input of the controller: the measurement as it came in
  /** of the centre of mass, in map */
  measured_x_m: number;
  /** of the centre of mass, in map */
  measured_y_m: number;
  measured_yaw_rad: number;
  measured_speed_mps: number;

  // On the road, judged by our simulator, or from what was measured where the track is known; else not-a-number
  /** along the centre line */
  s_m: number;
  /** from the centre line, left positive */
  lateral_error_m: number;
  /** yaw minus the direction of the line */
  heading_error_rad: number;
  /** of the outermost tyre to the edge, negative = off the road */
  edge_distance_m: number;
  is_off_track: boolean;
  /** times the car left the road */
  off_track_events: number;
  /** laps completed */
  lap: number;
  /** of the running lap */
  lap_time_s: number;
  /** 0 before the first completed lap */
  last_lap_time_s: number;

  // Commands: asked by the controller now, before the gate, and acting on the car after the delay
  /** angle of the front wheels, left positive */
  steer_asked_rad: number;
  steer_applied_rad: number;
  /** [-1, 1], negative brakes */
  throttle_asked: number;
  throttle_applied: number;

  // The control step
  rung: number;
  solve_status: number;
  /** the command gate had to change the command */
  is_gated: boolean;
  guard_reason: number;
  /** of the stop at hand, least distance of a tyre to the known edge; NaN: no stop */
  stop_edge_m: number;
  /** of the stop at hand, to standstill; NaN: no stop */
  stop_distance_m: number;
  /** the lap is closed in the controller's memory */
  has_map: boolean;
  /** of the outer (SQP) loop */
  iterations: number;
  /** Riccati sweeps, changes of the active set included */
  sweeps: number;
  /** of the plan */
  cost: number;
  /** of the whole control step, wall clock */
  step_time_us: number;
  /** compensated: from measurement to actuation */
  delay_s: number;
  /** wanted where the command acts */
  speed_reference_mps: number;
  /** length of known road ahead */
  sight_m: number;
  /** from the line the controller follows */
  tracked_lateral_error_m: number;
  /** yaw minus the direction of that line */
  tracked_heading_error_rad: number;

  // Commands as sent, after the gate
  steer_sent_rad: number;
  throttle_sent: number;
  /** run seconds per second of the clock */
  pace: number;
  /** a person drives */
  is_manual: boolean;

  // Why the controller chose this command
  /** of the plan, summed over its stages (names: Run.cost_term_names) */
  cost_terms: Float64Array;
  /** what limits the speed of the plan where the command acts */
  speed_limiter: number;
  /** what the speed plan allows where the command acts */
  speed_limit_mps: number;
  /** constraints (bits: Run.constraint_names) in the plan's first stage */
  active_now: number;
  /** and anywhere in it */
  active_ahead: number;

  // The simulated car: share of its grip that each axle uses; faults that are on
  /** 1 = all of it, more slides */
  front_tire_use: number;
  /** 1 = all of it, more slides */
  rear_tire_use: number;
  /** bits: Run.fault_names */
  active_faults: number;

  // How good the answer is
  /** largest step a projected gradient would still take */
  stationarity: number;
  /** largest violation of a soft constraint */
  violation: number;
  /** where it is, -1 nowhere */
  worst_stage: number;
  /** its place in Run.constraint_names, -1 none */
  worst_constraint: number;
  /** of the car now from where plans said, one delay and one period ago */
  prediction_error_m: number;

  // What the run has found out about its car (docs/identification.md); else not-a-number
  /** by which commands act later than configured */
  learned_delay_s: number;
  /** its standard deviation */
  learned_delay_sd_s: number;
  /** the wheels turn to gain times command plus offset */
  learned_steer_gain: number;
  /** its standard deviation */
  learned_steer_gain_sd: number;
  /** left positive */
  learned_steer_offset_rad: number;
  /** its standard deviation */
  learned_steer_offset_sd_rad: number;
  /** of the tyres, share of the configured one */
  learned_grip: number;
  /** its standard deviation */
  learned_grip_sd: number;
}

/** Frame.rung */
export const RUNG = {
  /** the controller drives */
  CONTROLLER: 0,
  /** the car follows the last plan */
  SHIFTED_PLAN: 1,
  /** the car follows the last plan and brakes gently */
  HOLD_AND_BRAKE: 2,
  /** the car follows the last plan and brakes as hard as is useful */
  BRAKE: 3,
  /** the controller returns to the road at walking pace */
  RETURN_TO_ROAD: 4,
  /** the controller has no plan and stops the car along the road */
  STOP_ON_ROAD: 5,
  /** the guard stops the car on the known road */
  GUARD_STOP: 6,
} as const;

/** Frame.solve_status */
export const STATUS = {
  /** the solver converged */
  OPTIMAL: 0,
  /** the solver stopped at its limit, close enough to the optimum */
  BUDGET_SPENT: 1,
  /** the solver converged as far as rounding allows */
  AT_FLOOR: 2,
  /** the solver did not converge */
  STALLED: -1,
  /** the constraints cannot all hold */
  INFEASIBLE: -2,
  /** the problem contains a number that is not finite */
  NOT_FINITE: -3,
} as const;

/** Frame.guard_reason */
export const REASON = {
  /** the guard found nothing */
  NONE: 0,
  /** the controller has no answer */
  NO_ANSWER: 1,
  /** position, yaw or speed has not been measured for too long */
  NOT_MEASURED: 2,
  /** the measurements repeat although the car moves */
  FROZEN: 3,
  /** measured speed and measured displacement contradict each other */
  SPEED_MISMATCH: 4,
  /** the measured yaw changed faster than a car can turn */
  HEADING_JUMP: 5,
  /** the measured position changed faster than a car can move */
  POSITION_JUMP: 6,
  /** the controller's command would leave no way to stop on the road */
  NO_WAY_TO_STOP: 7,
  /** the known road is far away */
  FAR_FROM_ROAD: 8,
  /** a receiver left alone could not stop the car on the road */
  TOO_FAST_FOR_SILENCE: 9,
  /** the measurements are of an earlier moment */
  LATE: 10,
  /** the wheels turn otherwise than they are asked to */
  OTHER_STEERING: 11,
  /** the brakes give less than they are asked for */
  WEAK_BRAKES: 12,
  /** the car stands although its road goes on */
  STUCK: 13,
  /** the car faces the edge of its road, nearer than it can turn */
  FACES_EDGE: 14,
} as const;

/** Frame.speed_limiter */
export const SPEED_LIMITER = {
  /** the controller does not say what limits the speed */
  NONE: 0,
  /** the car drives at the speed that is asked for */
  ASKED: 1,
  /** the bend takes all the grip that the plan may use */
  CURVATURE: 2,
  /** the car must be slower at the bend ahead */
  BRAKING: 3,
  /** the drive gives no more */
  POWER: 4,
  /** the road is not known far enough ahead */
  SIGHT: 5,
  /** the controller gives less than full throttle */
  PART_THROTTLE: 6,
  /** the wheels cannot be turned any faster */
  STEER_RATE: 7,
  /** the car already uses the road up to its edge */
  EDGE: 8,
  /** the planned lap is no faster here */
  PLAN: 9,
} as const;

/** What a Frame says when nothing is known. */
export const UNKNOWN_FRAME: Frame = {
  stamp: { sec: 0, nsec: 0 },
  cycle: 0n,
  time_s: NaN,
  has_truth: false,
  x_m: NaN,
  y_m: NaN,
  yaw_rad: NaN,
  vx_mps: NaN,
  vy_mps: NaN,
  yaw_rate_radps: NaN,
  speed_mps: NaN,
  longitudinal_acceleration_mps2: NaN,
  lateral_acceleration_mps2: NaN,
  measured_x_m: NaN,
  measured_y_m: NaN,
  measured_yaw_rad: NaN,
  measured_speed_mps: NaN,
  s_m: NaN,
  lateral_error_m: NaN,
  heading_error_rad: NaN,
  edge_distance_m: NaN,
  is_off_track: false,
  off_track_events: 0,
  lap: 0,
  lap_time_s: NaN,
  last_lap_time_s: NaN,
  steer_asked_rad: NaN,
  steer_applied_rad: NaN,
  throttle_asked: NaN,
  throttle_applied: NaN,
  rung: 0,
  solve_status: 0,
  is_gated: false,
  guard_reason: 0,
  stop_edge_m: NaN,
  stop_distance_m: NaN,
  has_map: false,
  iterations: 0,
  sweeps: 0,
  cost: NaN,
  step_time_us: NaN,
  delay_s: NaN,
  speed_reference_mps: NaN,
  sight_m: NaN,
  tracked_lateral_error_m: NaN,
  tracked_heading_error_rad: NaN,
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
  learned_delay_s: NaN,
  learned_delay_sd_s: NaN,
  learned_steer_gain: NaN,
  learned_steer_gain_sd: NaN,
  learned_steer_offset_rad: NaN,
  learned_steer_offset_sd_rad: NaN,
  learned_grip: NaN,
  learned_grip_sd: NaN,
};

/** The numbers of a frame, and what is yes or no, in its order. */
export const FRAME_NUMBERS = [
  'time_s',
  'has_truth',
  'x_m',
  'y_m',
  'yaw_rad',
  'vx_mps',
  'vy_mps',
  'yaw_rate_radps',
  'speed_mps',
  'longitudinal_acceleration_mps2',
  'lateral_acceleration_mps2',
  'measured_x_m',
  'measured_y_m',
  'measured_yaw_rad',
  'measured_speed_mps',
  's_m',
  'lateral_error_m',
  'heading_error_rad',
  'edge_distance_m',
  'is_off_track',
  'off_track_events',
  'lap',
  'lap_time_s',
  'last_lap_time_s',
  'steer_asked_rad',
  'steer_applied_rad',
  'throttle_asked',
  'throttle_applied',
  'rung',
  'solve_status',
  'is_gated',
  'guard_reason',
  'stop_edge_m',
  'stop_distance_m',
  'has_map',
  'iterations',
  'sweeps',
  'cost',
  'step_time_us',
  'delay_s',
  'speed_reference_mps',
  'sight_m',
  'tracked_lateral_error_m',
  'tracked_heading_error_rad',
  'steer_sent_rad',
  'throttle_sent',
  'pace',
  'is_manual',
  'speed_limiter',
  'speed_limit_mps',
  'active_now',
  'active_ahead',
  'front_tire_use',
  'rear_tire_use',
  'active_faults',
  'stationarity',
  'violation',
  'worst_stage',
  'worst_constraint',
  'prediction_error_m',
  'learned_delay_s',
  'learned_delay_sd_s',
  'learned_steer_gain',
  'learned_steer_gain_sd',
  'learned_steer_offset_rad',
  'learned_steer_offset_sd_rad',
  'learned_grip',
  'learned_grip_sd',
] as const;

/** Each value of a state, for people: without capital and full stop. */
export type Words = Readonly<
  Record<number, { readonly severity: 'good' | 'warning' | 'bad'; readonly text: string } | undefined>
>;

/** Frame.rung in words. */
export const RUNG_WORDS: Words = {
  [RUNG.CONTROLLER]: {
    severity: 'good',
    text: 'the controller drives',
  },
  [RUNG.SHIFTED_PLAN]: {
    severity: 'warning',
    text: 'the car follows the last plan',
  },
  [RUNG.HOLD_AND_BRAKE]: {
    severity: 'bad',
    text: 'the car follows the last plan and brakes gently',
  },
  [RUNG.BRAKE]: {
    severity: 'bad',
    text: 'the car follows the last plan and brakes as hard as is useful',
  },
  [RUNG.RETURN_TO_ROAD]: {
    severity: 'warning',
    text: 'the controller returns to the road at walking pace',
  },
  [RUNG.STOP_ON_ROAD]: {
    severity: 'bad',
    text: 'the controller has no plan and stops the car along the road',
  },
  [RUNG.GUARD_STOP]: {
    severity: 'bad',
    text: 'the guard stops the car on the known road',
  },
};

/** Frame.solve_status in words. */
export const STATUS_WORDS: Words = {
  [STATUS.OPTIMAL]: {
    severity: 'good',
    text: 'the solver converged',
  },
  [STATUS.BUDGET_SPENT]: {
    severity: 'good',
    text: 'the solver stopped at its limit, close enough to the optimum',
  },
  [STATUS.AT_FLOOR]: {
    severity: 'good',
    text: 'the solver converged as far as rounding allows',
  },
  [STATUS.STALLED]: {
    severity: 'bad',
    text: 'the solver did not converge',
  },
  [STATUS.INFEASIBLE]: {
    severity: 'bad',
    text: 'the constraints cannot all hold',
  },
  [STATUS.NOT_FINITE]: {
    severity: 'bad',
    text: 'the problem contains a number that is not finite',
  },
};

/** Frame.guard_reason in words. */
export const REASON_WORDS: Words = {
  [REASON.NONE]: {
    severity: 'good',
    text: 'the guard found nothing',
  },
  [REASON.NO_ANSWER]: {
    severity: 'bad',
    text: 'the controller has no answer',
  },
  [REASON.NOT_MEASURED]: {
    severity: 'bad',
    text: 'position, yaw or speed has not been measured for too long',
  },
  [REASON.FROZEN]: {
    severity: 'bad',
    text: 'the measurements repeat although the car moves',
  },
  [REASON.SPEED_MISMATCH]: {
    severity: 'bad',
    text: 'measured speed and measured displacement contradict each other',
  },
  [REASON.HEADING_JUMP]: {
    severity: 'bad',
    text: 'the measured yaw changed faster than a car can turn',
  },
  [REASON.POSITION_JUMP]: {
    severity: 'bad',
    text: 'the measured position changed faster than a car can move',
  },
  [REASON.NO_WAY_TO_STOP]: {
    severity: 'bad',
    text: "the controller's command would leave no way to stop on the road",
  },
  [REASON.FAR_FROM_ROAD]: {
    severity: 'bad',
    text: 'the known road is far away',
  },
  [REASON.TOO_FAST_FOR_SILENCE]: {
    severity: 'warning',
    text: 'a receiver left alone could not stop the car on the road',
  },
  [REASON.LATE]: {
    severity: 'bad',
    text: 'the measurements are of an earlier moment',
  },
  [REASON.OTHER_STEERING]: {
    severity: 'warning',
    text: 'the wheels turn otherwise than they are asked to',
  },
  [REASON.WEAK_BRAKES]: {
    severity: 'warning',
    text: 'the brakes give less than they are asked for',
  },
  [REASON.STUCK]: {
    severity: 'warning',
    text: 'the car stands although its road goes on',
  },
  [REASON.FACES_EDGE]: {
    severity: 'bad',
    text: 'the car faces the edge of its road, nearer than it can turn',
  },
};

/** Frame.speed_limiter in words. */
export const SPEED_LIMITER_WORDS: Words = {
  [SPEED_LIMITER.NONE]: {
    severity: 'good',
    text: 'the controller does not say what limits the speed',
  },
  [SPEED_LIMITER.ASKED]: {
    severity: 'good',
    text: 'the car drives at the speed that is asked for',
  },
  [SPEED_LIMITER.CURVATURE]: {
    severity: 'good',
    text: 'the bend takes all the grip that the plan may use',
  },
  [SPEED_LIMITER.BRAKING]: {
    severity: 'good',
    text: 'the car must be slower at the bend ahead',
  },
  [SPEED_LIMITER.POWER]: {
    severity: 'good',
    text: 'the drive gives no more',
  },
  [SPEED_LIMITER.SIGHT]: {
    severity: 'good',
    text: 'the road is not known far enough ahead',
  },
  [SPEED_LIMITER.PART_THROTTLE]: {
    severity: 'good',
    text: 'the controller gives less than full throttle',
  },
  [SPEED_LIMITER.STEER_RATE]: {
    severity: 'good',
    text: 'the wheels cannot be turned any faster',
  },
  [SPEED_LIMITER.EDGE]: {
    severity: 'good',
    text: 'the car already uses the road up to its edge',
  },
  [SPEED_LIMITER.PLAN]: {
    severity: 'good',
    text: 'the planned lap is no faster here',
  },
};

/**
 * chicane_msgs/msg/Plan. What the controller intends: predicted motion of the centre of mass with its commands, all
 * arrays of the same length; element 0 is where the first command acts.
 */
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

/** What a Plan says when nothing is known. */
export const UNKNOWN_PLAN: Plan = {
  stamp: { sec: 0, nsec: 0 },
  time_s: new Float64Array(),
  x_m: new Float64Array(),
  y_m: new Float64Array(),
  yaw_rad: new Float64Array(),
  speed_mps: new Float64Array(),
  steer_rad: new Float64Array(),
  throttle: new Float64Array(),
};

/** chicane_msgs/msg/Run. What is running: constant until something is chosen anew. */
export interface Run {
  track: string;
  /** 0 = unknown */
  track_length_m: number;
  is_closed: boolean;
  controller: string;
  preset: string;
  /** artificial, from command to actuation */
  latency_s: number;
  control_period_s: number;
  is_paused: boolean;

  // The car, as the controller models it
  car: string;
  /** centre of mass to front axle */
  front_axle_m: number;
  /** centre of mass to rear axle */
  rear_axle_m: number;
  /** between the wheels of an axle */
  track_width_m: number;
  tire_width_m: number;
  body_length_m: number;
  body_width_m: number;
  steer_limit_rad: number;
  /** "drive": our simulator; "serve": an external one */
  mode: string;
  /** of Frame.cost_terms */
  cost_term_names: string[];
  /** of the bits of Frame.active_now and active_ahead, from the lowest */
  constraint_names: string[];
  /** of the bits of Frame.active_faults */
  fault_names: string[];
  /** drivable, outside each edge */
  kerb_width_m: number;
  /** another run that is being built: "track = oval"; empty: none */
  building: string;
  /** "finished", "stopped", "failed": the run is over; empty: it goes on */
  end: string;
  /** why, in one sentence; empty when it finished */
  end_reason: string;
  /** "on", "observe", "off"; empty: not known */
  guard_mode: string;
  /** where the guard knows the road from: "track", "waypoints" */
  guard_road: string;
  /** 0: not known */
  guard_version: number;
  /** the throttle that brakes fully is minus this */
  brake_throttle_limit: number;
  /** what was assumed, and what has no effect: a sentence each */
  notices: string[];

  // Where car and road come from, as their files say it
  car_notes: string[];
  /** parameters found by a log, in the unit of their key */
  identified_keys: string[];
  identified_values: Float64Array;
  /** 95 % interval; not-a-number: assumed, the log did not excite it */
  identified_low: Float64Array;
  identified_high: Float64Array;
  /** "occupancy map", "table of points"; empty: not known */
  track_kind: string;
  /** remarks of the file, and what its reader assumed */
  track_notes: string[];
  /** the road's size over that of its file */
  track_scale: number;
  /** in the file; 0: not known */
  track_points: number;
  /** of the points from the smooth line */
  track_fit_rms_m: number;
  track_fit_max_m: number;
}

/** What a Run says when nothing is known. */
export const UNKNOWN_RUN: Run = {
  track: '',
  track_length_m: NaN,
  is_closed: false,
  controller: '',
  preset: '',
  latency_s: NaN,
  control_period_s: NaN,
  is_paused: false,
  car: '',
  front_axle_m: NaN,
  rear_axle_m: NaN,
  track_width_m: NaN,
  tire_width_m: NaN,
  body_length_m: NaN,
  body_width_m: NaN,
  steer_limit_rad: NaN,
  mode: '',
  cost_term_names: [],
  constraint_names: [],
  fault_names: [],
  kerb_width_m: NaN,
  building: '',
  end: '',
  end_reason: '',
  guard_mode: '',
  guard_road: '',
  guard_version: 0,
  brake_throttle_limit: NaN,
  notices: [],
  car_notes: [],
  identified_keys: [],
  identified_values: new Float64Array(),
  identified_low: new Float64Array(),
  identified_high: new Float64Array(),
  track_kind: '',
  track_notes: [],
  track_scale: NaN,
  track_points: 0,
  track_fit_rms_m: NaN,
  track_fit_max_m: NaN,
};

/** chicane_msgs/msg/Lap. One completed lap, sent when it is. */
export interface Lap {
  /** its number, from 1 */
  lap: number;
  lap_time_s: number;
  /** thirds of the lap */
  sector_times_s: Float64Array;
  /** no tyre left the road */
  is_clean: boolean;
  mean_speed_mps: number;
  top_speed_mps: number;
  /** of the outermost tyre, negative = off the road */
  min_edge_distance_m: number;
  rms_lateral_error_m: number;
  /** lap time over the limit's, minus 100 %; not-a-number while unknown */
  gap_to_limit_percent: number;
  /** the same for the thirds */
  sector_gaps_to_limit_percent: Float64Array;
  /** changed since the run began, as at the end of the lap */
  setting_names: string[];
  /** as --set takes them */
  setting_values: string[];
  /** one of them changed while the lap was driven */
  is_mixed: boolean;
  /** of its time, driven by a person */
  by_hand_share: number;
  /** that acted in it */
  faults: string[];
}

/** What a Lap says when nothing is known. */
export const UNKNOWN_LAP: Lap = {
  lap: 0,
  lap_time_s: NaN,
  sector_times_s: new Float64Array(3).fill(NaN),
  is_clean: false,
  mean_speed_mps: NaN,
  top_speed_mps: NaN,
  min_edge_distance_m: NaN,
  rms_lateral_error_m: NaN,
  gap_to_limit_percent: NaN,
  sector_gaps_to_limit_percent: new Float64Array(3).fill(NaN),
  setting_names: [],
  setting_values: [],
  is_mixed: false,
  by_hand_share: NaN,
  faults: [],
};

/** chicane_msgs/msg/Change. A setting that changed during the run, before this control cycle. */
export interface Change {
  stamp: Stamp;
  cycle: bigint;
  /** key as in YAML and --set: "latency_ms" */
  name: string;
  /** as --set takes it */
  value: string;
}

/** What a Change says when nothing is known. */
export const UNKNOWN_CHANGE: Change = {
  stamp: { sec: 0, nsec: 0 },
  cycle: 0n,
  name: '',
  value: '',
};

/**
 * chicane_msgs/msg/Limit. The physical limit of this road for this car: the fastest lap of the model in docs/limit.md
 * and its line, arrays of the same length by rising time from the start line, the last point the first one again.
 */
export interface Limit {
  /** false: see why_not; the rest is empty */
  is_known: boolean;
  lap_time_s: number;
  /** thirds of the lap, from the start line */
  sector_times_s: Float64Array;
  /** along the centre line from its beginning */
  s_m: Float64Array;
  /** of the centre of mass */
  x_m: Float64Array;
  y_m: Float64Array;
  /** to the left of the centre line */
  n_m: Float64Array;
  speed_mps: Float64Array;
  longitudinal_acceleration_mps2: Float64Array;
  /** positive to the left */
  lateral_acceleration_mps2: Float64Array;
  /** since the start line */
  time_s: Float64Array;
  /** in one sentence, while is_known is false */
  why_not: string;
  /** it holds for laps from this one on: before, grip or mass were others */
  first_lap: number;
  /** of the limit, in the order of a lap, with half of the straights beside */
  corner_times_s: Float64Array;
  /** laps that were driven again without these, one at a time: "latency" */
  without: string[];
  /** the best of each; not-a-number where there was none */
  without_lap_times_s: Float64Array;
  /** of these laps, one after the other; not-a-number where not known */
  without_corner_times_s: Float64Array;
}

/** What a Limit says when nothing is known. */
export const UNKNOWN_LIMIT: Limit = {
  is_known: false,
  lap_time_s: NaN,
  sector_times_s: new Float64Array(3).fill(NaN),
  s_m: new Float64Array(),
  x_m: new Float64Array(),
  y_m: new Float64Array(),
  n_m: new Float64Array(),
  speed_mps: new Float64Array(),
  longitudinal_acceleration_mps2: new Float64Array(),
  lateral_acceleration_mps2: new Float64Array(),
  time_s: new Float64Array(),
  why_not: '',
  first_lap: 0,
  corner_times_s: new Float64Array(),
  without: [],
  without_lap_times_s: new Float64Array(),
  without_corner_times_s: new Float64Array(),
};

/**
 * chicane_msgs/msg/Situation. State of the run in a control cycle, for people: who drives, what limits or stops the
 * car, what ends a stop. Computed from the applied command and the motion.
 */
export interface Situation {
  stamp: Stamp;
  /** "normal"; "notice": driven otherwise; "alarm": a person has to know or act */
  severity: string;
  /** at most six words: "Grip: 97 % in T4" */
  sentence: string;
  /** why, in a clause; empty where the sentence says it */
  reason: string;
  /** what ends an alarm, by itself and by a person: two sentences */
  ends_it: string;
  /** "controller", "guard", "person" */
  driver: string;
  /** the sentence without its numbers: "part_throttle" */
  kind: string;
  /** time of the run at which `kind` began */
  kind_since_s: number;
  /** of an alarm: time of the run at which its event began; not-a-number: no alarm */
  event_since_s: number;
  /** time of the run since which the car stands; not-a-number: it moves */
  stands_since_s: number;
  /** events of the run so far that a person has to know of */
  alarms: number;
}

/** What a Situation says when nothing is known. */
export const UNKNOWN_SITUATION: Situation = {
  stamp: { sec: 0, nsec: 0 },
  severity: '',
  sentence: '',
  reason: '',
  ends_it: '',
  driver: '',
  kind: '',
  kind_since_s: NaN,
  event_since_s: NaN,
  stands_since_s: NaN,
  alarms: 0,
};
