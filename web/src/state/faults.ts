import { begunBits, hasBit } from '../lib/bits';
import { store } from '../lib/store';
import type { Change, Frame } from '../protocol/topics';
import { faultInWords } from './event_log';
import { entryOf } from './settings';

// Faults of the run: until when each lasts, and where on the road they began.

const MARKS_KEPT = 60;

/** Where and when a fault began. */
export interface FaultMark {
  readonly name: string;
  readonly time: number; // of the run [s]
  readonly x: number; // in W [m]
  readonly y: number;
}

export const faultMarks = store.signal<readonly FaultMark[]>('moment', []);
/** When each fault that was switched on will end [s], by its key. */
const untils = new Map<string, number>();

store.onReset('moment', () => untils.clear());

/** Clears where faults began, which is found in frames. */
export function forgetFaultMarks(): void {
  if (faultMarks.value.length > 0) faultMarks.value = [];
}

/** Takes from a change of a switch how long its fault will last: "true", or "+5*0.5". */
export function noteFaultChange({ stamp, name, value }: Change): void {
  if (!name.startsWith('fault.')) return;
  const own = entryOf(name)?.fault?.duration_s ?? NaN;
  const told = /^\+([\d.e-]+)/.exec(value)?.[1];
  if (value === 'false') untils.delete(name);
  else untils.set(name, stamp.sec + stamp.nsec / 1e9 + (told === undefined ? own : Number(told)));
}

export function noteFaultMarks(frame: Frame, before: Frame | null, names: readonly string[]): void {
  const marks = begunBits(frame.active_faults, before?.active_faults).map((bit) => ({
    name: names[bit] ?? `#${bit + 1}`,
    time: frame.time_s,
    x: frame.x_m,
    y: frame.y_m,
  }));
  if (marks.length > 0) faultMarks.value = [...faultMarks.value, ...marks].slice(-MARKS_KEPT);
}

/** Seconds until a fault ends by itself; not-a-number where that is not known. */
export function secondsLeft(key: string, now: number): number {
  const left = (untils.get(key) ?? NaN) - now;
  return left >= 0 ? left : NaN;
}

/** The faults that are on, in words: "Fault: half grip, 2 s left". */
export function faultsInWords({ active_faults, time_s }: Frame, names: readonly string[]): string[] {
  return names.flatMap((name, bit) => {
    if (!hasBit(active_faults, bit)) return [];
    const left = secondsLeft(`fault.${name.replace(/^fault\./, '')}`, time_s);
    return [`Fault: ${faultInWords(name)}${Number.isFinite(left) ? `, ${Math.ceil(left)} s left` : ''}`];
  });
}
