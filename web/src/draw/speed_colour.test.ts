import { describe, expect, it } from 'vitest';
import { MPH } from '../lib/format';
import { speedColour, speedGradient, topOfScale } from './speed_colour';

describe('speed colour', () => {
  it('runs from the first stop to the last and stays there', () => {
    expect(speedColour(0)).toBe('rgb(72 92 220)');
    expect(speedColour(-5)).toBe(speedColour(0));
    expect(speedColour(1)).toBe('rgb(255 112 77)');
    expect(speedColour(7)).toBe(speedColour(1));
    expect(speedColour(NaN)).toBe(speedColour(0));
    expect(speedGradient()).toContain('rgb(38 188 150)');
  });

  it('changes without jumps', () => {
    const channels = (share: number) => speedColour(share).match(/\d+/g)?.map(Number) ?? [];
    for (let share = 0; share < 1; share += 0.01) {
      const [a, b] = [channels(share), channels(share + 0.01)];
      a.forEach((value, i) => expect(Math.abs(value - (b[i] ?? NaN))).toBeLessThan(10));
    }
  });

  it('ends the scale at a round speed', () => {
    expect(topOfScale(0) * MPH).toBeCloseTo(20, 9);
    expect(topOfScale(100 / MPH) * MPH).toBeCloseTo(100, 9);
    expect(topOfScale(101 / MPH) * MPH).toBeCloseTo(120, 9);
  });
});
