import { describe, expect, it } from 'vitest';
import { UNKNOWN_LIMIT } from '../protocol/messages';
import type { Limit } from '../protocol/topics';
import { LapSamples } from './lap_samples';
import { forgetLimit, gapsToLimit, limitChannel, limit as limitOfThePage, receiveLimit, whyNoLimit } from './limit';
import { lapWith } from './test_messages';

const limit: Limit = {
  ...UNKNOWN_LIMIT,
  is_known: true,
  lap_time_s: 20,
  sector_times_s: Float64Array.of(5, 5, 10),
  s_m: Float64Array.of(0, 250, 500, 750, 1000),
  n_m: Float64Array.of(0, 1, 2, 1, 0),
  speed_mps: Float64Array.of(40, 50, 60, 50, 40),
  time_s: Float64Array.of(10, 15, 0, 5, 10), // the start line is at 500 m
};

/** One lap at 50 m/s round 1 km, seen from 500 m on, where laps begin. */
function samples(): LapSamples {
  const all = new LapSamples();
  all.setLength(1000);
  for (let i = -1; i <= 101; ++i) {
    const since = ((i + 100) % 100) / 5;
    all.push(
      i < 0 ? 0 : i < 100 ? 1 : 2,
      {
        s_m: (500 + 10 * (i + 100)) % 1000,
        time_s: since,
        speed_mps: 50,
        lateral_error_m: 0,
        steer_rad: 0,
        throttle: 0,
        x_m: 0,
        y_m: 0,
      },
      20,
    );
  }
  return all;
}

describe('the limit', () => {
  it('has a reason while it is not known, which is forgotten with it', () => {
    const now = () => [limitOfThePage.value?.lap_time_s ?? null, whyNoLimit.value];
    receiveLimit({ ...UNKNOWN_LIMIT, why_not: 'the road is open' });
    expect(now()).toEqual([null, 'the road is open']);
    receiveLimit({ ...limit, why_not: '' });
    expect(now()).toEqual([20, '']);
    receiveLimit(UNKNOWN_LIMIT);
    expect(now()).toEqual([null, '']);
    receiveLimit({ ...UNKNOWN_LIMIT, why_not: 'too early' });
    forgetLimit();
    expect(now()).toEqual([null, '']);
  });

  it('is computed for laps that were driven before it was known', () => {
    const lap = lapWith(1, 22, { sector_times_s: Float64Array.of(5, 6, 11) });
    expect(gapsToLimit(lap, limit)).toEqual({
      lap: expect.closeTo(10),
      sectors: [expect.closeTo(0), expect.closeTo(20), expect.closeTo(10)],
    });
    expect(gapsToLimit(lap, null)).toEqual({ lap: NaN, sectors: [NaN, NaN, NaN] });
  });

  it('holds for laps from first_lap on', () => {
    expect(gapsToLimit(lapWith(4, 22), { ...limit, first_lap: 5 }).lap).toBeNaN();
    expect(gapsToLimit(lapWith(5, 22), { ...limit, first_lap: 5 }).lap).toBeCloseTo(10);
  });

  it('is taken from the lap if it was sent', () => {
    const told = lapWith(1, 22, {
      gap_to_limit_percent: 7,
      sector_gaps_to_limit_percent: Float64Array.of(1, 2, 3),
    });
    expect(gapsToLimit(told, limit)).toEqual({ lap: 7, sectors: [1, 2, 3] });
    expect(gapsToLimit(lapWith(1, 22), null).lap).toBeNaN();
  });

  it('is sampled at the points of driven laps', () => {
    const all = samples();
    const speed = limitChannel(limit, all, 'speed_mps');
    const time = limitChannel(limit, all, 'time_s');
    expect(all.place(0)).toBeCloseTo(500, 9);
    expect([speed?.[0], speed?.[250], speed?.[500], speed?.[625]]).toEqual(
      [60, 50, 40, 45].map((each) => expect.closeTo(each, 9)),
    );
    expect([time?.[1], time?.[250], time?.[625]]).toEqual([0.02, 5, 12.5].map((each) => expect.closeTo(each, 9)));
    expect(limitChannel(limit, all, 'throttle')).toBeNull();
    expect(limitChannel(limit, new LapSamples(), 'speed_mps')).toBeNull();
  });
});
