import { expect, it } from 'vitest';
import { duration, fixed, lapTime, plural, side, UNKNOWN } from './format';

it('writes numbers without a negative zero', () => {
  expect([-0.004, -1.256, NaN, Infinity].map((value) => fixed(value, 2))).toEqual(['0.00', '−1.26', UNKNOWN, UNKNOWN]);
});

it('writes lap times in minutes and seconds, rounded', () => {
  const texts = [0, 83.4567, 59.999, 28.13, -1, NaN].map((time) => lapTime(time));
  expect(texts).toEqual(['0:00.00', '1:23.46', '1:00.00', '0:28.13', UNKNOWN, UNKNOWN]);
  expect([34.6516, 61.204].map((time) => lapTime(time, 3))).toEqual(['0:34.652', '1:01.204']); // as of the program
});

it('names the side of an offset', () => {
  expect([0.4, -0.4, 0.001, NaN].map(side)).toEqual(['left', 'right', '', '']);
});

it('picks the unit of a duration', () => {
  const texts = [456, 1234, 45_678].map(duration).map(({ value, unit }) => `${value} ${unit}`);
  expect([...texts, duration(NaN).value]).toEqual(['456 µs', '1.23 ms', '45.7 ms', UNKNOWN]);
});

it('counts in words', () => {
  expect([1, 0].map((count) => plural(count, 'lap'))).toEqual(['1 lap', '0 laps']);
});
