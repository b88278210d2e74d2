import { readFileSync } from 'node:fs';
import { parse } from '@foxglove/rosmsg';
import { MessageReader } from '@foxglove/rosmsg2-serialization';
import { describe, expect, it } from 'vitest';
import { decoder } from './decoder';
import { SPEED_LIMITER } from './messages';
import type { Change, Frame, Lap, Path, Plan, Run } from './topics';
import { TOPIC_NAMES } from './topics';

// Written by tests/protocol/ros_messages_test.cpp; the numbers are those of tests/protocol/viewer_samples.hpp.
const folder = new URL('../../../tests/protocol/fixtures/ros/', import.meta.url);
const topics = JSON.parse(readFileSync(new URL('topics.json', folder), 'utf8')) as {
  topic: string;
  type: string;
  file: string;
  schema: string;
}[];

function read<T>(name: string): T {
  const topic = topics.find((each) => each.topic === name);
  if (!topic) throw new Error(`no fixture for ${name}`);
  return decoder(topic.schema)(readFileSync(new URL(topic.file, folder))) as T;
}

describe('messages of the C++ side', () => {
  it('include every topic this page subscribes to', () => {
    // The past has the type of a frame, and a channel of viewers alone (wire/viewer.hpp).
    const sent = TOPIC_NAMES.filter((name) => name !== '/chicane/past');
    for (const name of sent) expect(topics.map((each) => each.topic)).toContain(name);
  });

  it.each(topics)('$topic is read as the reference implementation reads it', ({ schema, file }) => {
    const bytes = readFileSync(new URL(file, folder));
    const reference = new MessageReader(parse(schema, { ros2: true }));
    expect(decoder(schema)(bytes)).toEqual(reference.readMessage(bytes));
  });

  it('carry a frame', () => {
    const frame = read<Frame>('/chicane/frame');
    expect(frame).toMatchObject({
      stamp: { sec: 12, nsec: 250_000_000 },
      cycle: 1234567890123n,
      time_s: 12.25,
      has_truth: true,
      x_m: 10,
      y_m: -20,
      yaw_rad: 0.5,
      vx_mps: 30,
      vy_mps: -0.4,
      yaw_rate_radps: 0.25,
      longitudinal_acceleration_mps2: -1.25,
      lateral_acceleration_mps2: 7.5,
      measured_x_m: 10.1,
      measured_speed_mps: 29.5,
      s_m: 456.5,
      lateral_error_m: 0.3,
      heading_error_rad: -0.03,
      edge_distance_m: 1.875,
      is_off_track: true,
      off_track_events: 3,
      lap: 2,
      lap_time_s: 4.5,
      last_lap_time_s: 28.125,
      steer_asked_rad: 0.02,
      steer_applied_rad: 0.015,
      throttle_asked: 0.75,
      throttle_applied: -0.5,
      rung: 1,
      solve_status: 1,
      is_gated: true,
      has_map: true,
      iterations: 7,
      sweeps: 9,
      cost: 123.5,
      delay_s: 0.118,
      speed_reference_mps: 33,
      sight_m: 140,
      tracked_lateral_error_m: 0.31,
      tracked_heading_error_rad: -0.02,
      steer_sent_rad: 0.01,
      throttle_sent: 0.625,
      pace: 0.25,
      is_manual: true,
      speed_limiter: SPEED_LIMITER.BRAKING,
      speed_limit_mps: 34.5,
      active_now: 0b10,
      active_ahead: 0b101010,
      front_tire_use: 0.875,
      rear_tire_use: 1.0625,
      active_faults: 0b100100,
      stationarity: 0.0009765625,
      violation: 0.0625,
      worst_stage: 17,
      worst_constraint: 4,
      prediction_error_m: 0.03125,
    } satisfies Partial<Frame>);
    expect([...frame.cost_terms]).toEqual([0.5, 1.5, 121.5]);
    expect(frame.step_time_us).toBeCloseTo(456, 9);
    expect(frame.speed_mps).toBeCloseTo(Math.hypot(30, 0.4), 12);
  });

  it('carry a plan', () => {
    const plan = read<Plan>('/chicane/plan');
    expect([...plan.time_s]).toEqual([12.375, 12.4375, 12.5]);
    expect([...plan.x_m]).toEqual([11, 12, 13]);
    expect([...plan.speed_mps]).toEqual([31, 30, 29]);
    expect([...plan.throttle]).toEqual([0.5, 0.25, 0]);
  });

  it('carry the run', () => {
    expect(read<Run>('/chicane/run')).toMatchObject({
      track: 'lakeside',
      track_length_m: 1350.5,
      is_closed: true,
      controller: 'tracking-mpc',
      preset: 'default',
      latency_s: 0.1,
      control_period_s: 0.04,
      is_paused: false,
      car: 'udacity',
      rear_axle_m: 2,
      mode: 'serve',
      cost_term_names: ['lateral', 'heading', 'speed'],
      constraint_names: ['steer_limit', 'throttle_max'],
      fault_names: ['link_lost', 'half_grip'],
      kerb_width_m: 0.75,
      building: 'track = oval',
      guard_mode: 'observe',
      guard_road: 'waypoints',
      guard_version: 7,
      brake_throttle_limit: 0.04,
      notices: ['pid.speed_reference_mps: has no effect'],
      car_notes: ['a car, identified from 60 s of log.csv'],
      identified_keys: ['mass_kg', 'friction'],
      track_kind: 'GPX',
      track_notes: ['width: assumed'],
      track_scale: 0.125,
      track_points: 321,
      track_fit_rms_m: 0.0625,
      track_fit_max_m: 0.1875,
    });
  });

  it('carry a lap', () => {
    const lap = read<Lap>('/chicane/lap');
    expect(lap).toMatchObject({
      lap: 2,
      lap_time_s: 28.125,
      is_clean: true,
      mean_speed_mps: 47.5,
      top_speed_mps: 49.25,
      min_edge_distance_m: 1.625,
      rms_lateral_error_m: 0.1875,
      setting_names: ['latency_ms'],
      setting_values: ['60'],
      is_mixed: true,
      by_hand_share: 0.25,
      faults: ['half_grip'],
    });
    expect([...lap.sector_times_s]).toEqual([9.25, 9.5, 9.375]);
  });

  it('carry a change', () => {
    expect(read<Change>('/chicane/change')).toEqual({
      stamp: { sec: 12, nsec: 250_000_000 },
      cycle: 306n,
      name: 'latency_ms',
      value: '150',
    });
  });

  it('carry lines', () => {
    const positions = read<Path>('/track/right').poses.map(({ pose }) => pose.position);
    expect(positions).toEqual([
      { x: 0, y: -2, z: 0 },
      { x: 4, y: -2, z: 0 },
      { x: 0, y: -2, z: 0 },
    ]);
    expect(read<Path>('/reference').poses).toHaveLength(2);
  });

  it('carry a scene for the 3D panels of other viewers', () => {
    const { entities } = read<{
      entities: { id: string; frame_id: string; frame_locked: boolean; cubes: unknown[] }[];
    }>('/scene');
    expect(entities).toMatchObject([
      { id: 'road', frame_id: 'map', frame_locked: false, lines: [{ type: 0 }, { type: 0 }] },
      { id: 'car', frame_id: 'base_link', frame_locked: true, triangles: [], models: [] },
    ]);
    expect(entities[1]?.cubes).toHaveLength(6);
  });

  it('carry the standard types', () => {
    expect(read('/odom')).toMatchObject({
      header: { frame_id: 'odom' },
      child_frame_id: 'base_link',
      twist: { twist: { linear: { x: 30 }, angular: { z: 0.25 } } },
    });
    expect(read('/tf')).toMatchObject({ transforms: [{ child_frame_id: 'odom' }, { child_frame_id: 'base_link' }] });
    expect(read('/clock')).toMatchObject({ clock: { sec: 12, nsec: 250_000_000 } });
    expect(read('/diagnostics')).toMatchObject({
      status: [
        { level: 1, name: 'chicane: controller', hardware_id: 'tracking-mpc' },
        { level: 2, message: 'off the road' },
      ],
    });
    const { drive } = read<{ drive: { steering_angle: number; speed: number } }>('/drive');
    expect(drive.steering_angle).toBeCloseTo(0.01, 7);
    expect(drive.speed).toBe(33);
  });
});
