// Texts of the car's estimated parameters: delay, steering and grip, relative to its configuration.
import { fixed } from '../lib/format';
import type { Frame } from '../protocol/messages';

/** One estimated parameter. */
export interface Learned {
  label: string;
  /** "+58 ± 6 ms": the estimate and two standard deviations. */
  text: string;
}

const DEGREES = 180 / Math.PI; // in a radian

/** The parameter as a list of one; empty if it is not estimated (NaN). Only differences get a plus sign. */
function parameter(
  label: string,
  unit: string,
  digits: number,
  value: number,
  deviation: number,
  configured: number,
): Learned[] {
  if (!Number.isFinite(value)) return [];
  const sign = configured === 0 && value > 0 ? '+' : '';
  return [{ label, text: `${sign}${fixed(value, digits)} ± ${fixed(2 * deviation, digits)}${unit}` }];
}

/** All parameters of the car that are estimated at the moment of `frame`. */
export function learnedOf(frame: Frame): Learned[] {
  return [
    ...parameter('Delay over configured', ' ms', 0, frame.learned_delay_s * 1e3, frame.learned_delay_sd_s * 1e3, 0),
    ...parameter('Steering gain', '', 2, frame.learned_steer_gain, frame.learned_steer_gain_sd, 1),
    ...parameter(
      'Steering offset, left positive',
      '°',
      2,
      frame.learned_steer_offset_rad * DEGREES,
      frame.learned_steer_offset_sd_rad * DEGREES,
      0,
    ),
    ...parameter('Grip over configured', '', 2, frame.learned_grip, frame.learned_grip_sd, 1),
  ];
}
