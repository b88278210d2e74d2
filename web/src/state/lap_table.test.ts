import { describe, expect, it } from 'vitest';
import { UNKNOWN_LAP } from '../protocol/messages';
import type { Lap } from '../protocol/topics';
import { LAP_CHANNELS, LapSamples, UNKNOWN_MOMENT } from './lap_samples';
import { bestOf, lapSamplesCsv, lapsCsv } from './lap_table';

const lap = (number: number, sectors: [number, number, number], more: Partial<Lap> = {}): Lap => ({
  ...UNKNOWN_LAP,
  lap: number,
  lap_time_s: sectors[0] + sectors[1] + sectors[2],
  sector_times_s: new Float64Array(sectors),
  is_clean: true,
  mean_speed_mps: 40,
  top_speed_mps: 45 + number,
  min_edge_distance_m: 1,
  rms_lateral_error_m: 0.2,
  gap_to_limit_percent: 12.5,
  sector_gaps_to_limit_percent: new Float64Array([10, 12, 15]),
  ...more,
});

describe('the table of laps', () => {
  it('does not count a lap that left the road, unless all did', () => {
    expect(bestOf([lap(1, [9, 9, 9]), lap(2, [5, 5, 5], { is_clean: false })])?.lap).toBe(1);
    expect(bestOf([lap(2, [5, 5, 5], { is_clean: false })])?.lap).toBe(2);
    expect(bestOf([])).toBeUndefined();
  });

  it('counts the standing start only while there is no other clean lap', () => {
    expect(bestOf([lap(1, [9, 9, 9])])?.lap).toBe(1);
    expect(bestOf([lap(1, [9, 9, 9]), lap(2, [9, 9, 10]), lap(3, [9, 9, 9.5])])?.lap).toBe(3);
  });

  it('is written as a file', () => {
    const driven = { by_hand_share: 0.5, setting_names: ['latency_ms', 'seed'], setting_values: ['60', '2'] };
    const lines = lapsCsv([lap(1, [12, 9, 9], driven)], null).split('\n');
    expect(lines[0]?.split(',')).toHaveLength(13);
    expect(lines[1]).toBe('1,30,12,9,9,true,40,46,1,0.2,12.5,0.5,latency_ms=60 seed=2');
  });

  it('has a file for each lap along the road', () => {
    const samples = new LapSamples();
    samples.setLength(100);
    const moment = (s: number, time: number) => ({
      ...UNKNOWN_MOMENT,
      s_m: s,
      time_s: time,
      speed_mps: 10,
      lateral_error_m: 0,
      steer_rad: 0,
      throttle: 0.5,
      x_m: 7,
      y_m: 1,
    });
    for (const [number, s, time] of [
      [0, 0, 0],
      [0, 99, 9.9],
      [1, 1, 0.1],
    ] as const)
      samples.push(number, moment(s, time), number * 10);
    const lines = lapSamplesCsv(samples, 0).trim().split('\n');
    expect(lines[0]).toBe(['s_m', ...LAP_CHANNELS].join(','));
    expect(lines).toHaveLength(samples.points + 1);
    expect(lines.at(-1)).toMatch(/^99\.9,9\.99,10,0,0,0\.5,7,1,/);
  });
});
