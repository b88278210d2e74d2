import { expect, it } from 'vitest';
import { stepSeverity } from './plot_bands';

it('a control step is as severe as its worst part', () => {
  expect(stepSeverity(0, 0, 0)).toBe(0);
  expect(stepSeverity(1, 0, 0)).toBe(0); // good enough is good
  expect([stepSeverity(0, 1, 0), stepSeverity(0, 0, 1)]).toEqual([1, 1]);
  expect([stepSeverity(-2, 0, 0), stepSeverity(0, 2, 0), stepSeverity(1, 3, 1)]).toEqual([2, 2, 2]);
});
