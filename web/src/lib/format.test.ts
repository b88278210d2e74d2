import { describe, expect, it } from 'vitest';
import { duration, fixed, lapTime, plural, side, UNKNOWN } from './format';

describe('format', () => {
  it('writes numbers without a negative zero', () => {
    expect(fixed(-0.004, 2)).toBe('0.00');
    expect(fixed(-1.256, 2)).toBe('−1.26');
    expect(fixed(NaN, 2)).toBe(UNKNOWN);
    expect(fixed(Infinity, 0)).toBe(UNKNOWN);
  });

  it('writes lap times in minutes and seconds, rounded', () => {
    expect(lapTime(0)).toBe('0:00.00');
    expect(lapTime(83.4567)).toBe('1:23.46');
    expect(lapTime(59.999)).toBe('1:00.00');
    expect(lapTime(34.6516, 3)).toBe('0:34.652'); // as the program prints it
    expect(lapTime(61.204, 3)).toBe('1:01.204');
    expect(lapTime(28.13)).toBe('0:28.13');
    expect(lapTime(-1)).toBe(UNKNOWN);
    expect(lapTime(NaN)).toBe(UNKNOWN);
  });

  it('names the side of an offset', () => {
    expect(side(0.4)).toBe('left');
    expect(side(-0.4)).toBe('right');
    expect(side(0.001)).toBe('');
    expect(side(NaN)).toBe('');
  });

  it('picks the unit of a duration', () => {
    expect(duration(456)).toEqual({ value: '456', unit: 'µs' });
    expect(duration(1234)).toEqual({ value: '1.23', unit: 'ms' });
    expect(duration(45_678)).toEqual({ value: '45.7', unit: 'ms' });
    expect(duration(NaN).value).toBe(UNKNOWN);
  });

  it('counts in words', () => {
    expect(plural(1, 'lap')).toBe('1 lap');
    expect(plural(0, 'lap')).toBe('0 laps');
  });
});
