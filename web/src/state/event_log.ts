// Events of the run: found by comparing frames, and changes that the program reports.
import { begunBits, hasBit } from '../lib/bits';
import { store } from '../lib/store';
import { nameInWords, rungInWords, type Sentence, statusInWords } from '../lib/words';
import { type Change, type Frame, timeOf } from '../protocol/topics';
import { shortly } from './lap_setup';

/** An event of the run: when it began and, once it has ended, how long it lasted. */
export interface RunEvent extends Sentence {
  readonly id: number;
  readonly time: number; // of the run [s]
  readonly duration: number | null; // null: not over yet, or without a duration
  readonly isChange?: boolean; // somebody changed something; all others are found in frames
}

const KEPT = 60; // events; chosen

/** Events of the run, newest first. */
export const events = store.signal<readonly RunEvent[]>('moment', []);

/** A condition of frames that is an event as long as it lasts. */
interface Watch {
  readonly name: string;
  /** The condition in this frame, or null for none. A different text is a different event. */
  look(frame: Frame): Sentence | null;
}

/** Conditions that are events. */
const WATCHES: readonly Watch[] = [
  { name: 'rung', look: ({ rung, guard_reason }) => (rung === 0 ? null : rungInWords(rung, guard_reason)) },
  { name: 'status', look: ({ solve_status }) => (solve_status >= 0 ? null : statusInWords(solve_status)) },
  {
    name: 'gate',
    look: ({ is_gated }) => (is_gated ? { severity: 'warning', text: 'The gate changed the command' } : null),
  },
  { name: 'road', look: ({ is_off_track }) => (is_off_track ? { severity: 'bad', text: 'Off the road' } : null) },
  { name: 'manual', look: ({ is_manual }) => (is_manual ? { severity: 'good', text: 'Driven by hand' } : null) },
];

/** Id of the next event, and the names of faults by bit. */
const kept = store.data('page', () => ({ nextId: 1, faultNames: [] as readonly string[] }));
/** Events that are not over, by the condition that found them. */
const found = store.data('moment', () => ({ open: new Map<string, RunEvent>() }));

/** Clears the events that were found in frames. */
export function forgetFrameEvents(): void {
  events.value = events.value.filter(({ isChange }) => isChange);
  found.open = new Map();
}

/** Sets the names of faults by their bits in frames. */
export function setFaultNames(names: readonly string[]): void {
  kept.faultNames = names;
}

/** Inserts an event by its time: changes of a run that was joined late arrive apart from its frames. */
function add(event: RunEvent): void {
  const at = events.value.findIndex(({ time }) => time <= event.time);
  const before = at < 0 ? events.value.length : at;
  events.value = [...events.value.slice(0, before), event, ...events.value.slice(before)].slice(0, KEPT);
}

/** Ends the event of a condition where its text changes, and begins the next one. */
function follow(key: string, now: Sentence | null, time: number): void {
  const running = found.open.get(key);
  if (running && running.text !== now?.text) {
    const ended = { ...running, duration: time - running.time };
    events.value = events.value.map((event) => (event.id === running.id ? ended : event));
    found.open.delete(key);
  }
  if (now && running?.text !== now.text) {
    const event = { ...now, id: kept.nextId++, time, duration: null };
    found.open.set(key, event);
    add(event);
  }
}

/** Opens and closes events by comparing a frame with the one before it. */
export function noteEvents(frame: Frame, before: Frame | null): void {
  for (const { name, look } of WATCHES) follow(name, look(frame), frame.time_s);
  for (const bit of begunBits(frame.active_faults ^ (before?.active_faults ?? 0))) {
    const text = `Fault: ${faultInWords(kept.faultNames[bit] ?? `#${bit + 1}`)}`;
    follow(`fault ${bit}`, hasBit(frame.active_faults, bit) ? { severity: 'warning', text } : null, frame.time_s);
  }
}

/** Adds what the program assumed when the run began, once: it comes with each description of the run. */
export function noteNotices(notices: readonly string[]): void {
  for (const text of notices) {
    if (events.value.some((event) => event.text === text)) continue;
    add({ id: kept.nextId++, severity: 'warning', text, time: 0, duration: null, isChange: true });
  }
}

/** Name of a fault in words. */
export const faultInWords = (name: string): string => nameInWords(name.replace(/^fault\./, ''));

/** Adds a change of a setting, or of the lap that the car races by. */
export function noteChange(change: Change): void {
  const { name, value } = change;
  const isPlan = name === 'run.racing_line';
  if (/^(manual|fault|run)\./.test(name) && !isPlan) return; // noteEvents() or the page itself shows these
  const [grip, ...more] = value.split(', ');
  const slip = more.find((part) => part.startsWith('slip '));
  const share = [
    `${Math.round(100 * Number(grip))} % of the grip`,
    ...(slip ? [`${Math.round(100 * Number(slip.slice(5)))} % of the slip`] : []),
    ...(more.includes('slides') ? ['and to slide'] : []),
  ].join(', ');
  const planned = `Races by a new lap, planned with ${share}`;
  add({
    id: kept.nextId++,
    severity: isPlan ? 'good' : 'unknown',
    text: isPlan ? planned : `${name} set to ${shortly(value)}`,
    time: timeOf(change),
    duration: null,
    isChange: true,
  });
}
