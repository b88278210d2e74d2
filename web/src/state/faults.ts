import { begunBits, hasBit } from '../lib/bits';
import type { Point } from '../lib/math';
import { store } from '../lib/store';
import { capital } from '../lib/words';
import { type Change, type Frame, timeOf } from '../protocol/topics';
import { faultInWords } from './event_log';
import { entryOf } from './settings';

// Faults of the run: until when each lasts, and where on the road they began.

const MARKS_KEPT = 60; // chosen

/** Where faults began, in W [m]. */
export const faultMarks = store.signal<readonly Point[]>('moment', []);
/** Time of the run at which each fault that was switched on ends [s], by its key. */
const ends = new Map<string, number>();

store.onReset('moment', () => ends.clear());

/** Clears where faults began, which is found in frames. */
export function forgetFaultMarks(): void {
  if (faultMarks.value.length > 0) faultMarks.value = [];
}

/** Takes from a change of a switch how long its fault will last: "true", or "+5*0.5". */
export function noteFaultChange(change: Change): void {
  const { name, value } = change;
  if (!name.startsWith('fault.')) return;
  const own = entryOf(name)?.fault?.duration_s ?? NaN;
  const seconds = /^\+([\d.e-]+)/.exec(value)?.[1];
  if (value === 'false') ends.delete(name);
  else ends.set(name, timeOf(change) + (seconds === undefined ? own : Number(seconds)));
}

/** Marks the place where a fault begins. */
export function noteFaultMarks({ active_faults, x_m: x, y_m: y }: Frame, before: Frame | null): void {
  const marks = begunBits(active_faults, before?.active_faults).map(() => ({ x, y }));
  if (marks.length > 0) faultMarks.value = [...faultMarks.value, ...marks].slice(-MARKS_KEPT);
}

/** Seconds until a fault ends by itself; not-a-number where that is not known. */
export function secondsLeft(key: string, now: number): number {
  const left = (ends.get(key) ?? NaN) - now;
  return left >= 0 ? left : NaN;
}

/** The faults that are on, in words: "Half grip, 2 s left". */
export function faultsInWords({ active_faults, time_s }: Frame, names: readonly string[]): string[] {
  return names.flatMap((name, bit) => {
    if (!hasBit(active_faults, bit)) return [];
    const left = secondsLeft(`fault.${name.replace(/^fault\./, '')}`, time_s);
    return [`${capital(faultInWords(name))}${Number.isFinite(left) ? `, ${Math.ceil(left)} s left` : ''}`];
  });
}
