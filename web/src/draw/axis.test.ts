import { expect, it } from 'vitest';
import { firstSince } from '../lib/math';
import { aboutZero, fromZero, rangeInSteps, ticksOf } from './axis';

it('starts axes at zero and end at a round number', () => {
  expect(fromZero(20)([[3, 73], [12]])).toEqual([0, 80]);
  expect(fromZero(20)([[]])).toEqual([0, 20]);
  expect(fromZero(1)([[NaN, 4]])).toEqual([0, 5]);
});

it('looks closer where all values are far from zero', () => {
  expect(rangeInSteps([[71, 96], [83]], 10, 20)).toEqual([70, 100]);
  expect(rangeInSteps([[71, 76]], 10, 40)).toEqual([40, 80]);
  expect(rangeInSteps([[3, NaN]], 10, 40)).toEqual([0, 40]);
  expect(rangeInSteps([[], [NaN]], 10, 40)).toEqual([0, 40]);
});

it('makes axes of signed values symmetric', () => {
  expect(aboutZero(0.5)([[-0.7, 0.1]])).toEqual([-0.8, 0.8]);
  expect(aboutZero(0.5)([[0.1]])).toEqual([-0.5, 0.5]);
  expect(aboutZero(2)([[], [NaN]])).toEqual([-2, 2]);
});

it('begins with the first visible row', () => {
  expect([2.5, 2, 9, 0].map((from) => firstSince([1, 2, 3, 4], from))).toEqual([2, 1, 4, 0]);
  expect(firstSince([], 0)).toBe(0);
});

it('has few ticks, round and within the range', () => {
  expect(ticksOf(0, 62.4, 8)).toEqual([0, 10, 20, 30, 40, 50, 60]);
  expect(ticksOf(-0.07, 0.31, 4)).toEqual([0, 0.1, 0.2, 0.3]);
  expect(ticksOf(-25, 25, 5)).toEqual([-20, 0, 20]);
  expect(ticksOf(3, 3, 5)).toEqual([]);
  expect(ticksOf(NaN, 3, 5)).toEqual([]);
  for (const high of [0.013, 0.7, 1, 9.99, 480, 3600]) {
    const ticks = ticksOf(0, high, 6);
    expect(ticks.length).toBeGreaterThan(1);
    expect(ticks.length).toBeLessThanOrEqual(6);
    expect(ticks.at(-1)).toBeLessThanOrEqual(high);
  }
});
