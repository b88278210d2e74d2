// Texts of numbers, lap times, durations and counts.

/** Shown in place of an unknown number. */
export const UNKNOWN = '–';

/** A number with fixed decimals, a true minus sign and no "−0.0". */
export function fixed(value: number, decimals: number): string {
  if (!Number.isFinite(value)) return UNKNOWN;
  const text = Math.abs(value).toFixed(decimals);
  return value < 0 && Number(text) !== 0 ? `−${text}` : text;
}

/** 83.4567 s → "1:23.46", or with three decimals: rounded, as the program prints lap times. */
export function lapTime(seconds: number, decimals: 2 | 3 = 2): string {
  if (!Number.isFinite(seconds) || seconds < 0) return UNKNOWN;
  const parts = 10 ** decimals; // of a second
  const count = Math.round(seconds * parts);
  const [minutes, rest] = [Math.floor(count / (60 * parts)), count % (60 * parts)];
  return `${minutes}:${(rest / parts).toFixed(decimals).padStart(3 + decimals, '0')}`;
}

/** The side of a signed offset: positive is left. */
export function side(metres: number): string {
  if (!Number.isFinite(metres) || Math.abs(metres) < 0.005) return '';
  return metres > 0 ? 'left' : 'right';
}

/** Microseconds in the unit that keeps the number short. */
export function duration(microseconds: number): { value: string; unit: string } {
  if (!Number.isFinite(microseconds)) return { value: UNKNOWN, unit: 'ms' };
  if (microseconds < 1000) return { value: fixed(microseconds, 0), unit: 'µs' };
  return { value: fixed(microseconds / 1000, microseconds < 10_000 ? 2 : 1), unit: 'ms' };
}

/** "1 lap", "2 laps" */
export const plural = (count: number, noun: string): string => `${count} ${noun}${count === 1 ? '' : 's'}`;
