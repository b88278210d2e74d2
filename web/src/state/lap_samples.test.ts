import { describe, expect, it } from 'vitest';
import { LapSamples, timeGap, type LapMoment } from './lap_samples';

const LENGTH = 1000;
const moment = (s: number, time: number, speed = 20): LapMoment => ({
  s_m: s, time_s: time, speed_mps: speed, lateral_error_m: s / 1000, steer_rad: 0, throttle: 0, x_m: s, y_m: 0,
});

/** Drives laps at one speed each, a frame every `step` seconds. */
function drive(samples: LapSamples, speeds: readonly number[], step = 0.37): void {
  samples.setLength(LENGTH);
  let [distance, lapStart, time] = [0, 0, 0];
  let lastTime = 0;
  for (let frame = 0; distance < speeds.length * LENGTH; ++frame) {
    const lap = Math.floor(distance / LENGTH);
    const speed = speeds[lap] ?? 0;
    samples.push(lap, moment(distance - lap * LENGTH, time - lapStart, speed), lastTime);
    const rest = (lap + 1) * LENGTH - distance;
    if (speed * step < rest) [distance, time] = [distance + speed * step, time + step];
    else {
      const next = speeds[lap + 1] ?? 1;
      lastTime = time + rest / speed - lapStart;
      lapStart = time + rest / speed;
      distance = (lap + 1) * LENGTH + next * (step - rest / speed);
      time += step;
    }
  }
  samples.push(speeds.length, moment(distance - speeds.length * LENGTH, time - lapStart, 1), lastTime);
}

describe('lap samples', () => {
  it('keep a lap at equal distances, from line to line', () => {
    const samples = new LapSamples();
    drive(samples, [20, 25]);
    expect(samples.laps).toEqual([0, 1]);
    const times = samples.channel(1, 'time_s') as Float64Array;
    expect(times).toHaveLength(samples.points);
    for (const point of [0, 1, 250, 777, samples.points - 1]) expect(times[point]).toBeCloseTo(samples.s(point) / 25, 9);
    expect(samples.channel(1, 'lateral_error_m')?.[500]).toBeCloseTo(samples.s(500) / 1000, 9);
    expect(samples.channel(2, 'time_s')).toBeNull();
  });

  it('tell the gap between two laps along the road', () => {
    const samples = new LapSamples();
    drive(samples, [20, 25]);
    const gap = timeGap(samples.channel(0, 'time_s') as Float64Array, samples.channel(1, 'time_s') as Float64Array);
    expect(gap[0]).toBeCloseTo(0, 9);
    expect(gap.at(-1)).toBeCloseTo(LENGTH / 20 - LENGTH / 25, 9);
    expect(gap[500]).toBeCloseTo((LENGTH / 20 - LENGTH / 25) / 2, 1);
  });

  it('know the fastest, and its time at any place', () => {
    const samples = new LapSamples();
    expect(samples.best).toBe(-1);
    drive(samples, [20, 25, 24]);
    expect(samples.best).toBe(1);
    for (const s of [0, 123.4, 999.9, 1000]) expect(samples.at(1, 'time_s', s)).toBeCloseTo(s / 25, 9);
    expect(samples.at(9, 'time_s', 10)).toBeNaN();
    expect(samples.at(1, 'time_s', NaN)).toBeNaN();
  });

  it('keep the fastest lap when memory is short', () => {
    const samples = new LapSamples(2);
    drive(samples, [20, 40, 20, 20, 20, 20, 20]);
    expect(samples.laps).toContain(1);
    expect(samples.laps.at(-1)).toBe(6);
    expect(samples.laps.length).toBeLessThanOrEqual(4);
  });

  it('do not know what was not driven', () => {
    const samples = new LapSamples();
    samples.setLength(LENGTH);
    samples.push(3, moment(600, 12), 0); // joined in the middle of a lap
    samples.push(3, moment(900, 18), 0);
    samples.push(4, moment(50, 1), 20);
    const times = samples.channel(3, 'time_s') as Float64Array;
    expect(times[100]).toBeNaN();
    expect(times[samples.points - 1]).toBeCloseTo(20, 9);
    expect(samples.s(601)).toBeGreaterThan(600);
    expect(times[601]).toBeCloseTo(samples.s(601) / 50, 6);
  });

  it('drop a lap that was left, and everything of another road', () => {
    const samples = new LapSamples();
    drive(samples, [20, 25]);
    samples.push(0, moment(0, 0), 0);
    samples.push(0, moment(10, 1), 0);
    expect(samples.laps).toEqual([0, 1]);
    samples.setLength(LENGTH);
    expect(samples.laps).toEqual([0, 1]);
    samples.setLength(900);
    expect(samples.laps).toEqual([]);
  });

  it('ignore frames without a place on a road', () => {
    const samples = new LapSamples();
    samples.push(0, moment(1, 1), 0);
    samples.setLength(LENGTH);
    samples.push(0, moment(NaN, 1), 0);
    samples.push(1, moment(1, 1), 30);
    expect(samples.laps).toEqual([]);
  });
});
