import { readdirSync, readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { firstSince } from '../lib/math';
import { store } from '../lib/store';
import { UNKNOWN_LIMIT } from '../protocol/messages';
import type { Limit } from '../protocol/topics';
import { timeGap } from './comparison';
import { LapSamples, UNKNOWN_MOMENT } from './lap_samples';
import { gapToLimit, limitChannel, limit as limitOfThePage, limitTimeAt, receiveLimit, whyNoLimit } from './limit';
import { lapWith } from './test_messages';

const limit: Limit = {
  ...UNKNOWN_LIMIT,
  is_known: true,
  lap_time_s: 20,
  sector_times_s: Float64Array.of(5, 5, 10),
  // In the order of the lap: the start line is at 500 m.
  s_m: Float64Array.of(500, 750, 0, 250, 500),
  n_m: Float64Array.of(2, 1, 0, 1, 2),
  speed_mps: Float64Array.of(60, 50, 40, 50, 60),
  time_s: Float64Array.of(0, 5, 10, 15, 20),
};

/** One lap at 50 m/s round 1 km, seen from 500 m on, where laps begin. */
function samples(): LapSamples {
  const all = new LapSamples();
  all.setLength(1000);
  for (let i = -1; i <= 101; ++i) {
    const moment = { s_m: (500 + 10 * (i + 100)) % 1000, time_s: ((i + 100) % 100) / 5, speed_mps: 50 };
    all.push(1 + Math.floor(i / 100), { ...UNKNOWN_MOMENT, ...moment }, 20);
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
    store.reset('run');
    expect(now()).toEqual([null, '']);
  });

  it('is compared with a lap: as was sent, or from first_lap on', () => {
    const lap = lapWith(4, 22);
    expect(gapToLimit(lap, limit)).toBeCloseTo(10);
    expect(gapToLimit(lap, null)).toBeNaN();
    expect(gapToLimit(lap, { ...limit, first_lap: 5 })).toBeNaN();
    expect(gapToLimit({ ...lap, gap_to_limit_percent: 7 }, limit)).toBe(7);
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

/** A shipped track: its length and a lap whose speed follows from its bends. */
interface Track {
  readonly name: string;
  readonly length: number; // [m]
  speedAt(s: number): number; // [m/s]
}

const FOLDER = new URL('../../../data/tracks/', import.meta.url);

/** A speed that the bends allow at 12 m/s², between 8 and 60 m/s: abrupt changes are what it has to stand. */
function trackOf(file: string): Track {
  const points = readFileSync(new URL(file, FOLDER), 'utf8')
    .split('\n')
    .filter((line) => /^-?\d/.test(line))
    .map((line) => line.split(',').map(Number) as [number, number]);
  const at = (i: number): [number, number] => points[i % points.length] as [number, number];
  const step = (i: number): number => Math.hypot(at(i + 1)[0] - at(i)[0], at(i + 1)[1] - at(i)[1]);
  const yaw = (i: number): number => Math.atan2(at(i + 1)[1] - at(i)[1], at(i + 1)[0] - at(i)[0]);
  const places = [0];
  for (let i = 1; i < points.length; ++i) places.push((places[i - 1] ?? 0) + step(i - 1));
  const speeds = points.map((_, i) => {
    const turn = Math.abs(Math.sin((yaw(i + 1) - yaw(i)) / 2)) * 2;
    return Math.min(60, Math.max(8, Math.sqrt((12 * step(i)) / Math.max(turn, 1e-6))));
  });
  const length = (places.at(-1) ?? 0) + step(points.length - 1);
  return { name: file, length, speedAt: (s) => speeds[firstSince(places, s + 1e-9) - 1] ?? 8 };
}

/** The lap in steps of half a metre from a line on: place along the road and time since the line. */
function drive({ length, speedAt }: Track, line: number) {
  const steps = Math.floor(2 * length);
  const [s, time, speed] = [new Float64Array(steps + 1), new Float64Array(steps + 1), new Float64Array(steps + 1)];
  for (let i = 0; i <= steps; ++i) {
    s[i] = (line + (i * length) / steps) % length;
    speed[i] = speedAt(s[i] ?? 0);
    time[i] = i === 0 ? 0 : (time[i - 1] ?? 0) + length / steps / (speed[i] ?? 8);
  }
  return { s, time, speed, lapTime: time[steps] ?? NaN };
}

describe('a lap against itself as the limit', () => {
  const tracks = readdirSync(FOLDER)
    .filter((file) => file.endsWith('.csv') && file !== 'stage.csv') // stage is open
    .map(trackOf);

  it.each(tracks)('has no gap on $name, wherever the line is', (track) => {
    for (let part = 0; part < 11; ++part) {
      const line = (part / 11) * track.length;
      const { s, time, speed, lapTime } = drive(track, line);
      const columns = { s_m: s, time_s: time, speed_mps: speed, x_m: s, y_m: s, n_m: s };
      const itself: Limit = { ...UNKNOWN_LIMIT, is_known: true, lap_time_s: lapTime, ...columns };
      const all = new LapSamples();
      all.setLength(track.length);
      // Frames 40 ms apart see the line within rounding, some of them on the other side of it.
      const push = (lap: number, i: number, since = time[i] ?? NaN): void => {
        const moment = { s_m: s[i] ?? NaN, time_s: since, speed_mps: speed[i] ?? NaN };
        all.push(lap, { ...UNKNOWN_MOMENT, ...moment }, lap === 0 ? 0 : lapTime);
      };
      push(0, s.length - 2, lapTime - 0.01);
      for (let i = 1; i < s.length - 1; ++i) push(1, i);
      push(2, 1);

      const driven = all.channel(1, 'time_s') as Float64Array;
      const best = limitChannel(itself, all, 'time_s') as Float64Array;
      const gaps = timeGap(driven, best).filter(Number.isFinite);
      expect(gaps.length).toBeGreaterThan(990);
      expect(Math.max(...gaps.map(Math.abs)), `line at ${line} m`).toBeLessThan(0.05);
      // Distance and time of the picture's numbers.
      for (let i = 0; i < s.length - 1; i += 7) {
        const gap = (time[i] ?? NaN) - limitTimeAt(itself, track.length, s[i] ?? NaN, time[i] ?? NaN);
        if (!(Math.abs(gap) < 0.05)) expect.fail(`at ${s[i]} m: ${gap} s`);
      }
      const speeds = limitChannel(itself, all, 'speed_mps') as Float64Array;
      expect(speeds.every((value) => value > 7.9 && value < 60.1)).toBe(true);
    }
  });
});
