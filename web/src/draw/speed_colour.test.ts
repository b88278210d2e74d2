import { describe, expect, it } from 'vitest';
import { SPEED_UNITS, type SpeedUnit } from '../lib/units';
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
    const [mph, kmh, mps] = SPEED_UNITS as readonly [SpeedUnit, SpeedUnit, SpeedUnit];
    const top = (speed: number, unit: SpeedUnit) => topOfScale(speed / unit.perMps, unit) * unit.perMps;
    expect(top(0, mph)).toBeCloseTo(20, 9);
    expect(top(100, mph)).toBeCloseTo(100, 9);
    expect(top(101, mph)).toBeCloseTo(120, 9);
    expect(top(161, kmh)).toBeCloseTo(200, 9);
    expect(top(45, mps)).toBeCloseTo(50, 9);
  });
});
