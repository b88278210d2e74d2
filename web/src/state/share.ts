import { computed } from '@preact/signals';
import { store } from '../lib/store';
import type { SchemaEntry } from '../protocol/schema';
import type { Setting } from '../protocol/source';
import { link } from './link';
import { call, refresh, requests } from './operate';
import { pause } from './program_page';
import { entryOf, isControl, refusals, type SettingChange, schema, settings, startSettings } from './settings';

// A link that holds a run: track, car, preset, controller, seed, and what differs from what these give. It lies in the
// fragment of the address, which browsers send to no server, and it is followed by the settings' own requests, so that
// the program checks each value as it checks one that is typed. Names only: a file of one machine is none of another.

/** Settings that choose a run, in the order in which they are set: a preset brings its controller. */
const CHOICES = ['track', 'car', 'preset', 'controller', 'seed'] as const;
/** Settings that are no changes of a link: the choices, and how long a run lasts. */
const NOT_SHARED = new Set<string>([...CHOICES, 'laps', 'time_limit_s']);
const PREFIX = '#run?';

/** A run as a link holds it: the choices, and the settings that differ from what they give. */
export interface SharedRun {
  readonly choices: ReadonlyMap<string, Setting>;
  readonly changes: ReadonlyMap<string, Setting>;
}

/** Whether a setting is a change of a run. */
const isOfRun = ({ key, kind }: SchemaEntry): boolean => !isControl(key) && !NOT_SHARED.has(key) && kind !== 'text';
const isShared = (entry: SchemaEntry): boolean => isOfRun(entry) && !entry.is_fixed;

/** Value that the chosen preset gives to a setting with the chosen car. */
const givenBy = (entry: SchemaEntry): Setting => entry.default ?? 'inf';

/** The run that goes on. */
export const sharedNow = computed<SharedRun>(() => ({
  choices: new Map(
    CHOICES.flatMap((key) => {
      const value = settings.value.get(key);
      return value === undefined ? [] : [[key, value]];
    }),
  ),
  changes: new Map(
    schema.value.filter(isOfRun).flatMap((entry) => {
      const value = settings.value.get(entry.key);
      return value === undefined || Object.is(value, givenBy(entry)) ? [] : [[entry.key, value]];
    }),
  ),
}));

/** The changes that a link cannot set, because they are fixed when a run starts. */
export const fixedChanges = computed<readonly string[]>(() =>
  [...sharedNow.value.changes.keys()].filter((key) => entryOf(key)?.is_fixed === true),
);

/** The choices that are files, which a link cannot name. */
export const filesChosen = computed<readonly string[]>(() =>
  (['track', 'car', 'preset'] as const).filter((key) => {
    const [value, entry] = [settings.value.get(key), entryOf(key)];
    return value !== undefined && entry !== undefined && !entry.choices.includes(String(value));
  }),
);

/** The address of a run, to be opened on any running `chicane drive`. `page`: where the page is, without fragment. */
export function linkTo({ choices, changes }: SharedRun, page: string): string {
  const settable = [...changes].filter(([key]) => entryOf(key)?.is_fixed !== true);
  const query = new URLSearchParams([...choices, ...settable].map(([key, value]) => [key, String(value)]));
  return `${page}${PREFIX}${query}`;
}

/** Name by which the program was started: "./run.sh", where that started it. */
export const programName = store.signal('page', 'chicane');

/** A value as a word of the shell. */
const quoted = (value: Setting): string => (/^[\w.+-]+$/.test(String(value)) ? String(value) : `'${value}'`);

/** The command that begins a run. It names a controller only where that is not the preset's. */
export function commandOf({ choices, changes }: SharedRun): string {
  const given = entryOf('controller')?.default;
  const isTold = (key: string, value: Setting): boolean =>
    key === 'controller' ? value !== given : key === 'seed' ? value !== 1 : true;
  const words = [`${programName.value} drive`];
  for (const key of ['preset', 'track', 'car', 'controller', 'seed']) {
    const value = choices.get(key);
    if (value !== undefined && isTold(key, value)) words.push(`--${key} ${quoted(value)}`);
  }
  for (const [key, value] of changes) words.push(`--set ${key}=${quoted(value)}`);
  return words.join(' ');
}

/** Options of a run that a link does not hold. */
export interface DrivenWith {
  readonly laps: number; // 0: until it is stopped, as without an option
  readonly pace: number;
  readonly port: number;
}
const USUAL_PORT = 4567; // of the program

/** The command that drives the whole run once more, on the same page. */
export function commandAgain(shared: SharedRun, { laps, pace, port }: DrivenWith): string {
  const words = [commandOf(shared)];
  if (laps > 0) words.push(`--laps ${laps}`);
  if (Number.isFinite(pace) && pace !== 1) words.push(`--pace ${pace}`);
  if (port > 0 && port !== USUAL_PORT) words.push(`--port ${port}`);
  return words.join(' ');
}

/** Value that a text stands for; the program refuses one that the setting cannot have. */
function meant(text: string, entry: SchemaEntry | undefined): Setting {
  if (entry?.kind === 'bool' && /^(true|false)$/.test(text)) return text === 'true';
  const isNumber = entry?.kind === 'number' || entry?.kind === 'integer';
  return isNumber && text.trim() !== '' && Number.isFinite(Number(text)) ? Number(text) : text;
}

/** Keys and texts in the fragment of an address; null when it is no link to a run. */
export function textsIn(fragment: string): ReadonlyMap<string, string> | null {
  return fragment.startsWith(PREFIX) ? new Map(new URLSearchParams(fragment.slice(PREFIX.length))) : null;
}

/** Keys and texts of the link that was opened, until the user has answered; null: none. */
export const wantedTexts = store.signal<ReadonlyMap<string, string> | null>('page', null);

/** The run of a link, compared with the run that goes on. */
export interface Wanted {
  readonly run: SharedRun;
  readonly differences: readonly SettingChange[];
  /** Keys that this program does not know, or does not take from a link. */
  readonly unknown: readonly string[];
}

/** The run that the address asked for; null without one, or before the settings are known. */
export const wanted = computed<Wanted | null>(() => {
  const texts = wantedTexts.value;
  if (!texts || schema.value.length === 0 || settings.value.size === 0) return null;
  const choices = new Map<string, Setting>();
  const changes = new Map<string, Setting>();
  const unknown: string[] = [];
  for (const [key, text] of texts) {
    const entry = entryOf(key);
    const isChoice = (CHOICES as readonly string[]).includes(key);
    if (!entry || !(isChoice || isShared(entry))) unknown.push(key);
    else (isChoice ? choices : changes).set(key, meant(text, entry));
  }
  const now = sharedNow.value;
  const differences = [...choices].flatMap(([key, to]) => {
    const from = now.choices.get(key) ?? '';
    return Object.is(from, to) ? [] : [{ key, from, to }];
  });
  for (const entry of schema.value.filter(isShared)) {
    const from = settings.value.get(entry.key);
    // With another preset or car all other settings are what these give.
    const to = changes.get(entry.key) ?? (differences.length === 0 ? givenBy(entry) : from);
    if (from !== undefined && to !== undefined && !Object.is(from, to)) differences.push({ key: entry.key, from, to });
  }
  return { run: { choices, changes }, differences, unknown };
});

/** Waits until the run that was chosen drives; false when another one does. */
async function hasBegun(chosen: ReadonlyMap<string, Setting>): Promise<boolean> {
  for (;;) {
    const isWanted = [...chosen].every(([key, value]) => settings.value.get(key) === value);
    if (!isWanted || link.value !== 'live') return false;
    if ([...chosen].every(([key, value]) => startSettings.value.get(key) === value)) return true;
    refresh();
    await pause(150);
  }
}

/** Requests values one after another; what was refused is added to `sentences`. */
async function setAll(values: ReadonlyMap<string, Setting>, sentences: string[]): Promise<void> {
  for (const [key, value] of values) {
    await requests.set(key, value);
    const sentence = refusals.value.get(key);
    if (sentence !== undefined) sentences.push(sentence);
  }
}

/**
 * Drives the run of a link, from its beginning: its choices, then all settings as they are in it, then the start once
 * more. Resolves to what the program refused.
 */
export async function driveShared({ choices, changes }: SharedRun): Promise<string[]> {
  const sentences: string[] = [];
  const chosen = new Map([...choices].filter(([key, value]) => settings.value.get(key) !== value));
  await setAll(chosen, sentences);
  if (sentences.length > 0) return sentences;
  if (!(await hasBegun(chosen))) return ['the program did not begin that run'];
  const others = schema.value.filter(isShared).flatMap((entry) => {
    const value = changes.get(entry.key) ?? givenBy(entry);
    const now = settings.value.get(entry.key);
    return now === undefined || Object.is(now, value) ? [] : [{ entry, value }];
  });
  const of = (isLive: boolean): Map<string, Setting> =>
    new Map(others.filter(({ entry }) => entry.is_live === isLive).map(({ entry, value }) => [entry.key, value]));
  await setAll(of(false), sentences);
  await setAll(of(true), sentences);
  if (sentences.length === 0 && !(await hasBegun(of(false)))) return ['the program did not begin that run'];
  call('/reset');
  return sentences;
}
