import { describe, expect, it } from 'vitest';
import { SPEED_UNITS } from '../lib/units';
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

  it('ends at a round speed that depends on nothing but the car', () => {
    const tops = (length: number) => SPEED_UNITS.map((unit) => Math.round(topOfScale(length, unit) * unit.perMps));
    expect(tops(4.47)).toEqual([120, 200, 55]);
    expect(tops(0.5)).toEqual([30, 50, 14]);
    expect(tops(NaN)).toEqual([120, 200, 55]);
    for (const unit of SPEED_UNITS) expect(Math.abs(topOfScale(4.47, unit) - 54.5)).toBeLessThan(1.2);
  });
});
