import { expect, it } from 'vitest';
import { curvePath, drawStretch, knownStretches } from './curve';

it('curves have gaps where points are unknown, or too far apart', () => {
  const times = [0, 1, 2, 5, 6];
  const values = [1, NaN, 3, 4, 5];
  const isKnown = (i: number): boolean => Number.isFinite(values[i]);
  expect(knownStretches(5, isKnown)).toEqual([
    [0, 1],
    [2, 5],
  ]);
  expect(knownStretches(5, isKnown, (i) => (times[i] ?? 0) - (times[i - 1] ?? 0) > 2)).toEqual([
    [0, 1],
    [2, 3],
    [3, 5],
  ]);
});

it('a curve is a path in pixels', () => {
  const y = [1, 2, NaN, 4];
  expect(
    curvePath(
      4,
      (i) => 10 * i,
      (i) => y[i] ?? NaN,
    ),
  ).toBe('M0.0 1.0L10.0 2.0M30.0 4.0');
});

it('of many points in a pixel column the extremes stay', () => {
  const y = [0, 5, 1, 9, 2, 3, 0];
  const drawn: number[][] = [];
  const add = (...at: number[]): void => void drawn.push(at);
  const x = (i: number): number => (i === 0 ? 0 : i === 6 ? 2 : 1 + i / 10);
  drawStretch({ moveTo: add, lineTo: add }, [0, 7], x, (i) => y[i] ?? NaN);
  expect(drawn.map(([, each]) => each)).toEqual([0, 5, 1, 9, 3, 0]);
});
