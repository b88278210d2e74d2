import { describe, expect, it } from 'vitest';
import { rangeAboutZero, rangeFromZero, secondsBack } from './axis';

describe('axes', () => {
  it('start at zero and end at a round number', () => {
    expect(rangeFromZero([[3, 73], [12]], 20)).toEqual([0, 80]);
    expect(rangeFromZero([[]], 20)).toEqual([0, 20]);
    expect(rangeFromZero([[NaN, 4]], 1)).toEqual([0, 5]);
  });

  it('are symmetric for signed values', () => {
    expect(rangeAboutZero([[-0.7, 0.1]], 0.5)).toEqual([-0.8, 0.8]);
    expect(rangeAboutZero([[0.1]], 0.5)).toEqual([-0.5, 0.5]);
    expect(rangeAboutZero([[], [NaN]], 2)).toEqual([-2, 2]);
  });

  it('count seconds back from now', () => {
    expect(secondsBack(33, 20, 5)).toEqual([13, 18, 23, 28, 33]);
  });
});
