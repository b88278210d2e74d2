import { afterEach, expect, it } from 'vitest';
import { LapSamples, momentOf } from './lap_samples';
import { addOtherLaps, channelOnto, otherLaps, removeOtherLaps } from './other_laps';
import { frameWith, lapWith } from './test_messages';

const LENGTH = 1000; // [m]
const speedAt = (place: number): number => 30 + 10 * Math.sin((2 * Math.PI * place) / LENGTH);

/** Two laps from a start line, at speeds that depend on the place alone. */
function driven(line: number, factor = 1, recordedFrom = 0): { samples: LapSamples; time: number } {
  const samples = new LapSamples();
  samples.setLength(LENGTH);
  const step = 0.01;
  let [s, lap, since, last] = [line, 0, 0, 0];
  while (lap < 3) {
    const frame = frameWith({ s_m: s % LENGTH, lap_time_s: since, speed_mps: factor * speedAt(s), x_m: s % LENGTH });
    if (s - line >= recordedFrom) samples.push(lap, momentOf(frame), last);
    const before = s;
    s += factor * speedAt(s) * step;
    since += step;
    if (s >= line + (lap + 1) * LENGTH) {
      const over = (s - line - (lap + 1) * LENGTH) / (s - before);
      [lap, last, since] = [lap + 1, since - over * step, over * step];
    }
  }
  return { samples, time: last };
}

afterEach(() => removeOtherLaps());

it('are compared wherever their laps begin', () => {
  const own = driven(100);
  const times = own.samples.channel(1, 'time_s');
  for (const line of [100, 101, 350, 600, 990]) {
    const { samples, time } = driven(line);
    const other = { recording: 'a', lap: 2, time, samples };
    const shifted = channelOnto(other, 'time_s', own.samples);
    const places = channelOnto(other, 'x_m', own.samples);
    const far = (value: number | undefined, of: number | undefined): number => Math.abs((value ?? NaN) - (of ?? NaN));
    const inTime = Array.from({ length: own.samples.points }, (_, i) => far(shifted?.[i], times?.[i])).slice(1);
    expect(Math.max(...inTime), `times from ${line}`).toBeLessThan(0.05);
    // x is the distance here, wrapped at the end of the road: there a point may lie between two laps.
    const inPlace = Array.from(inTime, (_, i) => far(places?.[i], own.samples.place(i)));
    expect(inPlace.filter((metres) => !(metres < 0.01)).length, `places from ${line}`).toBeLessThanOrEqual(2);
  }
});

it('are compared where they were recorded, if only in part', () => {
  const own = driven(100);
  const { samples, time } = driven(101.5, 1, 1400); // as a branch of a run in its second lap
  const shifted = channelOnto({ recording: 'a', lap: 2, time, samples }, 'time_s', own.samples);
  const gap = own.samples.channel(1, 'time_s')?.map((each, i) => (shifted?.[i] ?? NaN) - each) ?? [];
  expect(gap[100]).toBeNaN();
  expect(Math.max(...Array.from(gap.slice(410, 990), Math.abs))).toBeLessThan(0.05);
});

it('are none of another road', () => {
  const { samples, time } = driven(0);
  const onto = new LapSamples();
  onto.setLength(LENGTH + 1);
  expect(channelOnto({ recording: 'a', lap: 2, time, samples }, 'time_s', onto)).toBeNull();
});

it('are those of a recording that were sampled, and replace it', () => {
  const { samples, time } = driven(0);
  addOtherLaps('a', [lapWith(2, time), lapWith(9, 30)], samples); // lap 9 was never sampled
  addOtherLaps('b', [lapWith(2, time)], samples);
  addOtherLaps('a', [lapWith(2, time)], samples);
  expect(otherLaps.value.map(({ recording, lap }) => [recording, lap])).toEqual([
    ['b', 2],
    ['a', 2],
  ]);
});
