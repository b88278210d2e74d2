import { clamp } from './math';

/** How the travel of a slider maps to the values of its range. */
export type Scale = 'linear' | 'cubic' | 'logarithmic';

/** Range of a slider. */
export interface Range {
  readonly minimum: number;
  readonly maximum: number;
  readonly scale: Scale;
  readonly isInteger: boolean;
}

/** Length of a logarithmic scale whose range begins at 0, in decades below its end; chosen. */
const DECADES = 7;

/**
 * The scale on which the usual value is easy to find; the bounds are chosen. Logarithmic where the range spans a factor
 * of 300 and the usual value lies in its first fifth, or where it leads from 0 to a thousand and more; cubic where the
 * usual value lies in its first twentieth; else linear.
 */
export function scaleOf(minimum: number, maximum: number, usual: number): Scale {
  if (minimum > 0 ? maximum / minimum > 300 && usual < 0.2 * maximum : minimum === 0 && maximum >= 1000)
    return 'logarithmic';
  return usual - minimum < 0.05 * (maximum - minimum) ? 'cubic' : 'linear';
}

/** The share of the travel, in [0, 1], at which a value lies. */
export function shareOf(value: number, { minimum, maximum, scale }: Range): number {
  if (!(value > minimum)) return 0;
  if (value >= maximum) return 1;
  const linear = (value - minimum) / (maximum - minimum);
  if (scale === 'linear') return linear;
  if (scale === 'cubic') return Math.cbrt(linear);
  if (minimum > 0) return Math.log(value / minimum) / Math.log(maximum / minimum);
  return clamp(1 + Math.log10(value / maximum) / DECADES, 0, 1);
}

/** The value at a share of the travel, rounded to three digits. */
export function valueAt(share: number, { minimum, maximum, scale, isInteger }: Range): number {
  if (share <= 0) return minimum;
  if (share >= 1) return maximum;
  let raw = minimum + (scale === 'cubic' ? share ** 3 : share) * (maximum - minimum);
  if (scale === 'logarithmic')
    raw = minimum > 0 ? minimum * (maximum / minimum) ** share : maximum * 10 ** ((share - 1) * DECADES);
  return clamp(isInteger ? Math.round(raw) : Number(raw.toPrecision(3)), minimum, maximum);
}

/** A number for display: at most six digits, no trailing zeros, a true minus sign. */
export function tidy(value: number): string {
  if (value === Infinity) return '∞';
  if (!Number.isFinite(value)) return '–';
  return String(Number(value.toPrecision(6))).replace('-', '−');
}

/** A value of a setting for display. */
export const valueInWords = (value: number | boolean | string): string =>
  typeof value === 'number' ? tidy(value) : String(value);
