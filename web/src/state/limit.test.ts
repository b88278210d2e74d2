import { describe, expect, it } from 'vitest';
import type { Lap, Limit } from '../protocol/topics';
import { LapSamples } from './lap_samples';
import { forgetLimit, gapsToLimit, limitChannel, limit as limitOfThePage, receiveLimit, whyNoLimit } from './limit';

const limit = {
  is_known: true,
  lap_time_s: 20,
  sector_times_s: Float64Array.of(5, 5, 10),
  s_m: Float64Array.of(0, 250, 500, 750, 1000),
  n_m: Float64Array.of(0, 1, 2, 1, 0),
  speed_mps: Float64Array.of(40, 50, 60, 50, 40),
  time_s: Float64Array.of(10, 15, 0, 5, 10), // the start line is at 500 m
} as unknown as Limit;

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
    receiveLimit({ is_known: false, why_not: 'the road is open' } as Limit);
    expect(now()).toEqual([null, 'the road is open']);
    receiveLimit({ ...limit, why_not: '' });
    expect(now()).toEqual([20, '']);
    receiveLimit({ is_known: false } as Limit); // an older program
    expect(now()).toEqual([null, '']);
    receiveLimit({ is_known: false, why_not: 'too early' } as Limit);
    forgetLimit();
    expect(now()).toEqual([null, '']);
  });

  it('is computed for laps that were driven before it was known', () => {
    const lap = {
      lap: 1,
      lap_time_s: 22,
      sector_times_s: Float64Array.of(5, 6, 11),
      gap_to_limit_percent: NaN,
      sector_gaps_to_limit_percent: Float64Array.of(NaN, NaN, NaN),
    } as unknown as Lap;
    expect(gapsToLimit(lap, limit)).toEqual({
      lap: expect.closeTo(10),
      sectors: [expect.closeTo(0), expect.closeTo(20), expect.closeTo(10)],
    });
    expect(gapsToLimit(lap, null)).toEqual({ lap: NaN, sectors: [NaN, NaN, NaN] });
  });

  it('holds for laps from the first one on that the car of today began', () => {
    const lap = (number: number) =>
      ({
        lap: number,
        lap_time_s: 22,
        sector_times_s: Float64Array.of(5, 6, 11),
        gap_to_limit_percent: NaN,
      }) as unknown as Lap;
    expect(gapsToLimit(lap(4), { ...limit, first_lap: 5 }).lap).toBeNaN();
    expect(gapsToLimit(lap(5), { ...limit, first_lap: 5 }).lap).toBeCloseTo(10);
  });

  it('is taken as told, and as unknown from older programs', () => {
    const told = {
      lap_time_s: 22,
      sector_times_s: Float64Array.of(5, 6, 11),
      gap_to_limit_percent: 7,
      sector_gaps_to_limit_percent: Float64Array.of(1, 2, 3),
    } as unknown as Lap;
    expect(gapsToLimit(told, limit)).toEqual({ lap: 7, sectors: [1, 2, 3] });
    expect(gapsToLimit({ lap_time_s: 22, sector_times_s: new Float64Array(0) } as unknown as Lap, null).lap).toBeNaN();
  });

  it('lies beside a lap that was driven, place for place', () => {
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
