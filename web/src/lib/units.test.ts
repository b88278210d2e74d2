import { afterEach, expect, it } from 'vitest';
import { inSpeedUnit, MPH, nextSpeedUnit, SPEED_UNITS, speedUnit } from './units';

afterEach(() => {
  while (speedUnit().name !== 'mph') nextSpeedUnit();
});

it('knows miles per hour', () => expect(44.704 * MPH).toBeCloseTo(100, 9));

it('goes through all and back to the first', () => {
  const seen = SPEED_UNITS.map(() => {
    const { name } = speedUnit();
    const shown = inSpeedUnit(10);
    nextSpeedUnit();
    return [name, Number(shown.toFixed(3))];
  });
  expect(seen).toEqual([
    ['mph', 22.369],
    ['km/h', 36],
    ['m/s', 10],
  ]);
  expect(speedUnit().name).toBe('mph');
});
