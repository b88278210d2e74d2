// Unit of all speeds on the page, chosen by the user.
import { persisted } from './persisted';

/** A unit for speeds; every speed on the page is shown in one of these. */
export interface SpeedUnit {
  readonly name: 'mph' | 'km/h' | 'm/s';
  readonly spoken: string; // for screen readers
  readonly perMps: number; // of the unit in one m/s
  readonly axisStep: number; // of plots [unit]
  readonly axisLeast: number; // least height of a plot's axis [unit]
}

/** mph in one m/s: 3600 s/h over 1609.344 m/mile. */
export const MPH = 3600 / 1609.344;

/** The units, in the order of the key that changes them. */
export const SPEED_UNITS: readonly SpeedUnit[] = [
  { name: 'mph', spoken: 'miles per hour', perMps: MPH, axisStep: 10, axisLeast: 40 },
  { name: 'km/h', spoken: 'kilometres per hour', perMps: 3.6, axisStep: 20, axisLeast: 60 },
  { name: 'm/s', spoken: 'metres per second', perMps: 1, axisStep: 5, axisLeast: 20 },
];

const chosen = persisted<SpeedUnit['name']>('speed-unit', 'mph', (value) =>
  SPEED_UNITS.some(({ name }) => name === value),
);

/** The unit chosen; a signal, so that views that read it follow changes. */
export const speedUnit = (): SpeedUnit =>
  SPEED_UNITS.find(({ name }) => name === chosen.value) ?? (SPEED_UNITS[0] as SpeedUnit);

/** A speed [m/s] as a number in the reader's unit. */
export const inSpeedUnit = (mps: number): number => mps * speedUnit().perMps;

/** Chooses the next unit. */
export function nextSpeedUnit(): void {
  const at = SPEED_UNITS.findIndex(({ name }) => name === chosen.value);
  chosen.value = SPEED_UNITS[(at + 1) % SPEED_UNITS.length]?.name ?? 'mph';
}
