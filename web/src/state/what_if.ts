// Question for another future of the run ("what if"): its moment, length and settings, and the answer.
import { effect } from '@preact/signals';
import { refusalInWords } from '../lib/refusal';
import { valueInWords } from '../lib/scale';
import { store } from '../lib/store';
import { lastPart, nameInWords, reasonOf } from '../lib/words';
import type { SchemaEntry } from '../protocol/schema';
import type { AskAnswer, Setting } from '../protocol/source';
import { restartListeners } from './demultiplexer';
import { live } from './live';
import { ask as askRun, can } from './operate';
import { cursorTime } from './plot_view';
import { pause, programPage } from './program_page';
import { run } from './run';
import { isControl, schema, settings } from './settings';
import { readWhatIf, type WhatIfAnswer } from './what_if_answer';

/** Moment from which both futures are driven: now, that of the cursor, or the beginning of this lap. */
export type From = 'now' | 'cursor' | 'line';
/** Length of the futures: seconds, or a whole lap. */
export type Span = '10' | '30' | 'lap';

/** A setting that is changed in the question; the text as typed. */
export interface ChosenSetting {
  readonly key: string;
  readonly value: Setting;
}

/** The question: its moment, its length, and the changed settings. */
export const from = store.signal<From>('page', 'now');
export const span = store.signal<Span>('page', 'lap');
export const chosenSettings = store.signal<readonly ChosenSetting[]>('page', []);

/** The newest answer, and the settings that it was asked with. */
export const answer = store.signal<WhatIfAnswer | null>('page', null);
export const asked = store.signal<readonly ChosenSetting[]>('page', []);
/** The share that is computed; null when nothing is. */
export const progress = store.signal<number | null>('page', null);
/** Why there is no answer; empty when nothing is wrong. */
export const problem = store.signal('page', '');

/** A recording that is shown, about which the program answers questions. */
export interface AskedLog {
  /** Number of the recording. */
  which(): number;
  /** The position [s], on the recording's time line. */
  position(): number;
  ask(question: string): Promise<AskAnswer>;
}
/** The recording that questions are about; null in a live run. */
export const askedLog = store.signal<AskedLog | null>('page', null);
/** The settings of the recording that is shown; a live run has its own. */
export const loggedSchema = store.signal<readonly SchemaEntry[]>('page', []);

/** Whether the program answers questions now. */
export const canAsk = (): boolean => askedLog.value !== null || can('/what_if');

/** The settings that may change while a run goes on. */
export const offered = (): readonly SchemaEntry[] =>
  (askedLog.value ? loggedSchema.value : schema.value).filter(
    ({ key, is_live, kind }) => is_live && !isControl(key) && kind !== 'text',
  );

/** The value in force. */
export function valueInForce(entry: SchemaEntry): Setting | undefined {
  return askedLog.value ? (entry.default ?? undefined) : settings.value.get(entry.key);
}

/** The moment that is asked for, on the time line of the run or the recording [s]; null: now. */
export function moment(): number | null {
  const frame = live.frame;
  const log = askedLog.value;
  const offset = log && frame ? log.position() - frame.time_s : 0; // a recording may have several runs
  if (from.value === 'cursor' && cursorTime.value !== null) return cursorTime.value + offset;
  if (from.value === 'line' && frame) return Math.max(0, frame.time_s - frame.lap_time_s) + offset;
  return log ? log.position() : null;
}

/** The question as the program reads it. */
export function question(): string {
  const at = moment();
  return JSON.stringify({
    ...(at === null ? {} : { at_s: at }),
    // From within a lap its rest comes first, then a whole one.
    ...(span.value === 'lap' ? { laps: from.value === 'line' ? 1 : 2 } : { for_s: Number(span.value) }),
    log: askedLog.value?.which() ?? 0,
    settings: Object.fromEntries(chosenSettings.value.map(({ key, value }) => [key, value])),
  });
}

const POLL_MS = 150; // chosen
/** Number of the newest question here, and the run that it is about. */
const asking = store.data('page', () => ({ newest: 0, run: '' }));

/** Waits for the answer of a question by its number. */
async function waitFor(id: number, mine: number): Promise<void> {
  while (mine === asking.newest) {
    const reply = await programPage('what_if.json');
    const state = reply === null ? null : readWhatIf(JSON.parse(reply));
    if (mine !== asking.newest) return;
    if (state?.id !== id) throw new Error('another question took the place of this one');
    if (state.kind === 'failed') throw new Error(state.why);
    if (state.kind === 'done') {
      answer.value = state.answer;
      return;
    }
    progress.value = state.share;
    await pause(POLL_MS);
  }
}

/** Asks; the answer appears in `answer`. */
export async function ask(): Promise<void> {
  const mine = ++asking.newest;
  const sent = chosenSettings.value;
  problem.value = '';
  progress.value = 0;
  try {
    const taken = await (askedLog.value?.ask(question()) ?? askRun('/what_if', question()));
    if (!taken.isTaken) throw new Error(taken.message);
    await waitFor(Number(taken.message), mine);
    if (mine === asking.newest) asked.value = sent;
  } catch (error) {
    if (mine === asking.newest) problem.value = refusalInWords(reasonOf(error));
  } finally {
    if (mine === asking.newest) progress.value = null;
  }
}

/** Names of both futures: "as it is", and the changes. */
export function futureNames(): readonly [string, string] {
  const [first, ...others] = asked.value;
  if (!first) return ['as it is', 'what if'];
  const name = `${nameInWords(lastPart(first.key))} ${valueInWords(first.value)}`;
  return ['as it is', others.length === 0 ? `with ${name}` : `with ${others.length + 1} changes`];
}

/** Forgets the answer, and one that is being computed. */
export function forgetAnswer(): void {
  ++asking.newest;
  answer.value = null;
  progress.value = null;
  problem.value = '';
}

// An answer is about one run.
restartListeners.add(forgetAnswer);
effect(() => {
  const now = `${run.value?.track} ${run.value?.car} ${run.value?.controller} ${run.value?.preset}`;
  if (asking.run !== '' && asking.run !== now) forgetAnswer();
  asking.run = now;
});
