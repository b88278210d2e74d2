import { expect, it } from 'vitest';
import { type Range, scaleOf, shareOf, tidy, valueAt } from './scale';

const RANGES: readonly Range[] = [
  { minimum: 0, maximum: 500, scale: 'linear', isInteger: false },
  { minimum: 0.05, maximum: 20, scale: 'logarithmic', isInteger: false },
  { minimum: 0, maximum: 1e6, scale: 'logarithmic', isInteger: false },
  { minimum: 0, maximum: 10, scale: 'cubic', isInteger: false },
  { minimum: -1, maximum: 1, scale: 'linear', isInteger: false },
];

it('suits the range', () => {
  expect(scaleOf(0, 500, 100)).toBe('linear'); // latency_ms
  expect(scaleOf(0, 1e6, 1)).toBe('logarithmic'); // weights
  expect(scaleOf(0.05, 20, 1)).toBe('logarithmic'); // pace
  expect(scaleOf(0, 10, 0)).toBe('cubic'); // noise
  expect(scaleOf(0.01, 2, 1)).toBe('linear'); // friction_scale
  expect(scaleOf(5, 100, 20)).toBe('linear'); // horizon_steps
});

it('leads there and back', () => {
  for (const range of RANGES) {
    expect(valueAt(0, range)).toBe(range.minimum);
    expect(valueAt(1, range)).toBe(range.maximum);
    expect(shareOf(range.minimum, range)).toBe(0);
    expect(shareOf(range.maximum, range)).toBe(1);
    for (const share of [0.2, 0.5, 0.83]) expect(shareOf(valueAt(share, range), range)).toBeCloseTo(share, 2);
  }
});

it('puts real time in the middle of slow and fast', () => {
  expect(shareOf(1, RANGES[1] as Range)).toBeCloseTo(0.5, 12);
});

it('stays inside for values outside and unknown', () => {
  expect(shareOf(900, RANGES[0] as Range)).toBe(1);
  expect(shareOf(-3, RANGES[0] as Range)).toBe(0);
  expect(shareOf(NaN, RANGES[0] as Range)).toBe(0);
  expect(shareOf(1e-30, RANGES[2] as Range)).toBe(0);
});

it('gives whole numbers where only those count', () => {
  expect(valueAt(0.501, { minimum: 5, maximum: 100, scale: 'linear', isInteger: true })).toBe(53);
});

it('writes short numbers for people', () => {
  const numbers = [0.1 + 0.2, 1e6, -4, 123456.789, Infinity, NaN];
  expect(numbers.map(tidy).join(' ')).toBe('0.3 1000000 −4 123457 ∞ –');
});
