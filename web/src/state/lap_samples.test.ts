import { expect, it } from 'vitest';
import { type LapMoment, LapSamples, UNKNOWN_MOMENT } from './lap_samples';

const LENGTH = 1000;
const LINE = 270.4; // where laps begin along the road's line [m]

const moment = (distance: number, time: number, speed = 20): LapMoment => ({
  ...UNKNOWN_MOMENT,
  s_m: (LINE + distance) % LENGTH,
  time_s: time,
  speed_mps: speed,
  lateral_error_m: distance / 1000,
});

/** Drives laps at one speed each, a frame every `step` seconds. */
function drive(samples: LapSamples, speeds: readonly number[], step = 0.37): void {
  samples.setLength(LENGTH);
  let [lap, distance, time, last] = [0, 0, 0, 0];
  while (lap < speeds.length) {
    const speed = speeds[lap] ?? 0;
    samples.push(lap, moment(distance, time, speed), last);
    distance += speed * step;
    time += step;
    if (distance < LENGTH) continue;
    last = LENGTH / speed;
    time -= last;
    ++lap;
    distance = time * (speeds[lap] ?? 20);
  }
  samples.push(lap, moment(distance, time), last);
}

/** Drives a piece of a lap, from one moment to another. */
function cover(
  samples: LapSamples,
  lap: number,
  [from, since]: [number, number],
  [to, until]: [number, number],
  lastLapTime = 0,
  step = 0.37,
): void {
  const steps = Math.ceil((until - since) / step);
  for (let i = 0; i <= steps; ++i) {
    const share = i / steps;
    samples.push(lap, moment(from + share * (to - from), since + share * (until - since)), lastLapTime);
  }
}

// The line is found between two frames as if the speed were constant. Here it jumps by 5 m/s on the line, and a quarter
// of that in 0.37 s is half a metre, or 20 ms.
const DIGITS = 1;

it('keep a lap at equal distances from line to line, wherever the line is', () => {
  const samples = new LapSamples();
  drive(samples, [20, 25]);
  expect(samples.laps).toEqual([0, 1]);
  const times = samples.channel(1, 'time_s') as Float64Array;
  expect(times).toHaveLength(samples.points);
  expect(samples.s(0)).toBeGreaterThanOrEqual(0);
  expect(samples.s(0)).toBeLessThan(1);
  for (const point of [0, 1, 250, 777, samples.points - 1])
    expect(times[point]).toBeCloseTo(samples.s(point) / 25, DIGITS);
  expect(samples.channel(1, 'lateral_error_m')?.[500]).toBeCloseTo(samples.s(500) / 1000, DIGITS);
  expect(samples.channel(2, 'time_s')).toBeNull();
});

it('know the fastest, and its time at any place', () => {
  const samples = new LapSamples();
  expect([samples.best, samples.line]).toEqual([-1, 0]);
  drive(samples, [20, 25, 24]);
  expect(samples.best).toBe(1);
  for (const distance of [1.7, 123.4, 800, 998])
    expect(samples.at(1, 'time_s', (LINE + distance) % LENGTH)).toBeCloseTo(distance / 25, DIGITS);
  expect(samples.at(1, 'time_s', LINE)).toBeNaN(); // the clock starts anew here
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
  cover(samples, 3, [600, 12], [990, 19.8]); // joined in the middle of a lap
  samples.push(4, moment(10, 0.2), 20);
  const times = samples.channel(3, 'time_s') as Float64Array;
  expect(times[100]).toBeNaN();
  expect(times[samples.points - 1]).toBeCloseTo(samples.s(samples.points - 1) / 50, 1);
  expect(times[650]).toBeCloseTo(samples.s(650) / 50, 6);
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

it('ignore frames without a place on a road, and a car that goes back', () => {
  const samples = new LapSamples();
  samples.push(0, moment(1, 1), 0);
  samples.setLength(LENGTH);
  samples.push(0, moment(NaN, 1), 0);
  samples.push(1, moment(1, 1), 30);
  expect(samples.laps).toEqual([]);
  cover(samples, 1, [1, 1], [500, 20], 30);
  cover(samples, 1, [500, 20], [480, 25], 30);
  cover(samples, 1, [480, 25], [995, 40], 30);
  samples.push(2, moment(10, 0.5), 40.2);
  expect(samples.channel(1, 'time_s')?.[300]).toBeCloseTo(12.4, 0); // 1 s + 299 m of 499 m in 19 s
  expect(samples.channel(1, 'time_s')?.[690]).toBeCloseTo(31.1, 0);
});

it('leave out what a page without a connection has missed', () => {
  const samples = new LapSamples();
  drive(samples, [20, 20]);
  cover(samples, 2, [20, 1], [300, 15], 50);
  cover(samples, 2, [500, 25], [998, 49.9], 50);
  samples.push(3, moment(4, 0.2), 50);
  const speeds = samples.channel(2, 'speed_mps') as Float64Array;
  expect(speeds[298]).toBeCloseTo(20);
  for (const point of [300, 400, 499]) expect(speeds[point]).toBeNaN();
  expect(speeds[502]).toBeCloseTo(20);
  // Cut off over the line: the lap counts, its end and the next one's beginning are not known.
  cover(samples, 3, [4, 0.2], [600, 30], 50);
  cover(samples, 4, [300, 15], [999, 49.95], 50);
  samples.push(5, moment(1, 0.05), 50);
  expect(samples.laps).toEqual([0, 1, 2, 3, 4]);
  expect(samples.channel(3, 'time_s')?.[598]).toBeCloseTo(samples.s(598) / 20, 6);
  expect(samples.channel(3, 'time_s')?.[800]).toBeNaN();
  expect(samples.channel(4, 'time_s')?.[100]).toBeNaN();
  expect(samples.channel(4, 'time_s')?.[302]).toBeCloseTo(15.1, 0);
});

it('end with a recording that ends on the line', () => {
  const samples = new LapSamples();
  drive(samples, [20]);
  cover(samples, 1, [7.4, 0.296], [999.5, 39.98], 50);
  expect(samples.laps).toEqual([0]);
  samples.complete(1, 30); // of another run
  samples.complete(0, 40);
  expect(samples.laps).toEqual([0]);
  samples.complete(1, 40);
  expect(samples.laps).toEqual([0, 1]);
  expect(samples.best).toBe(1);
  expect(samples.channel(1, 'time_s')?.[samples.points - 1]).toBeCloseTo(samples.s(samples.points - 1) / 25, 2);

  const only = new LapSamples();
  only.setLength(LENGTH);
  cover(only, 0, [0, 0], [999, 49.95]);
  only.complete(0, 50);
  expect(only.laps).toEqual([0]);
  expect(only.place(0)).toBeCloseTo(LINE, -1);
  expect(only.channel(0, 'time_s')?.[500]).toBeCloseTo(only.s(500) / 20, 2);
});

it('know the line where a run begins, and do not guess it after missing frames', () => {
  for (const begin of [0, 100]) {
    const samples = new LapSamples();
    samples.setLength(LENGTH);
    cover(samples, 0, [begin, begin / 20], [600, 30]);
    cover(samples, 1, [300, 15], [999, 49.95], 50);
    expect(samples.laps).toEqual(begin > 0 ? [] : [0]);
    samples.push(2, moment(1, 0.05), 50);
    expect(samples.laps).toEqual(begin > 0 ? [1] : [0, 1]);
    expect([samples.place(0), samples.line]).toEqual([expect.closeTo(LINE, -1), expect.closeTo(LINE, -1)]);
  }
});
