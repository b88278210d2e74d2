import { expect, it } from 'vitest';
import { LAP_CHANNELS, LapSamples, UNKNOWN_MOMENT } from './lap_samples';
import { bestOf, lapSamplesCsv, lapsCsv } from './lap_table';
import { lapWith } from './test_messages';

it('does not count a lap that left the road, unless all did', () => {
  const off = lapWith(2, 15, { is_clean: false });
  expect(bestOf([lapWith(1, 27), off])?.lap).toBe(1);
  expect(bestOf([off])?.lap).toBe(2);
  expect(bestOf([])).toBeUndefined();
});

it('counts the standing start only while there is no other clean lap', () => {
  const first = lapWith(1, 27);
  expect(bestOf([first])?.lap).toBe(1);
  expect(bestOf([first, lapWith(2, 28), lapWith(3, 27.5)])?.lap).toBe(3);
});

it('is written as a file', () => {
  const measures = { mean_speed_mps: 40, min_edge_distance_m: 1, rms_lateral_error_m: 0.2, gap_to_limit_percent: 12.5 };
  const driven = { by_hand_share: 0.5, setting_names: ['latency_ms', 'seed'], setting_values: ['60', '2'] };
  const lines = lapsCsv([lapWith(1, 30, { ...measures, ...driven, top_speed_mps: 46 })], null).split('\n');
  expect(lines[0]?.split(',')).toHaveLength(13);
  expect(lines[1]).toBe('1,30,1,2,3,true,40,46,1,0.2,12.5,0.5,latency_ms=60 seed=2');
});

it('has a file for each lap along the road', () => {
  const samples = new LapSamples();
  samples.setLength(100);
  const still = { ...UNKNOWN_MOMENT, speed_mps: 10, lateral_error_m: 0, steer_rad: 0, throttle: 0.5, x_m: 7, y_m: 1 };
  for (const s of [0, 99, 101]) {
    const lap = Math.floor(s / 100);
    samples.push(lap, { ...still, s_m: s % 100, time_s: (s % 100) / 10 }, 10 * lap);
  }
  const lines = lapSamplesCsv(samples, 0).trim().split('\n');
  expect(lines[0]).toBe(['s_m', ...LAP_CHANNELS].join(','));
  expect(lines).toHaveLength(samples.points + 1);
  expect(lines.at(-1)).toMatch(/^99\.9,9\.99,10,0,0,0\.5,7,1,/);
});
