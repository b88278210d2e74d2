// Settings of the run: schema, values in force, requests and refusals.
import { computed } from '@preact/signals';
import { refusalInWords } from '../lib/refusal';
import { store } from '../lib/store';
import type { SchemaEntry } from '../protocol/schema';
import type { SetAnswer, Setting } from '../protocol/source';

/** All settings as the server describes them; empty until it does. */
export const schema = store.signal<readonly SchemaEntry[]>('run', []);
/** The values in force, or requested and not yet answered. */
export const settings = store.signal<ReadonlyMap<string, Setting>>('run', new Map());
/** The values the run started with, as the program knows them. */
export const startSettings = computed<ReadonlyMap<string, Setting>>(
  () => new Map(schema.value.flatMap(({ key, start }) => (start === null ? [] : [[key, start]]))),
);
/** Why requests were refused, by key, until the same setting is changed again. */
export const refusals = store.signal<ReadonlyMap<string, string>>('run', new Map());

/** Description of a setting. */
export const entryOf = (key: string): SchemaEntry | undefined => schema.value.find((entry) => entry.key === key);

/** Controls of the page rather than settings of the experiment: not part of a preset or of the list of changes. */
export const isControl = (key: string): boolean => /^(run|manual|fault)\./.test(key);

/** A setting with its value before and after. */
export interface SettingChange {
  readonly key: string;
  readonly from: Setting;
  readonly to: Setting;
}

/** The settings that differ from the start of the run, in the order of the schema. */
export const settingChanges = computed<readonly SettingChange[]>(() =>
  [...startSettings.value].flatMap(([key, from]) => {
    const to = settings.value.get(key);
    return to === undefined || Object.is(to, from) || isControl(key) ? [] : [{ key, from, to }];
  }),
);

/** A copy of a map with one entry changed, or removed where the value is undefined. */
function withEntry<T>(map: ReadonlyMap<string, T>, key: string, value: T | undefined): ReadonlyMap<string, T> {
  const copy = new Map(map);
  if (value === undefined) copy.delete(key);
  else copy.set(key, value);
  return copy;
}

/**
 * Sends changes of settings. The page shows the requested value at once. For each setting one request is open at a
 * time, and of those made meanwhile only the newest is sent, so that a dragged slider builds no queue. A refused value
 * is replaced by the one in force.
 */
export class SettingRequests {
  readonly #send: (key: string, value: Setting) => Promise<SetAnswer>;
  readonly #open = new Map<string, { next?: Setting }>();

  constructor(send: (key: string, value: Setting) => Promise<SetAnswer>) {
    this.#send = send;
  }

  async set(key: string, value: Setting): Promise<void> {
    settings.value = withEntry(settings.value, key, value);
    const open = this.#open.get(key);
    if (open) {
      open.next = value;
      return;
    }
    const state: { next?: Setting } = { next: value };
    this.#open.set(key, state);
    let inForce: Setting | null = null;
    let sentence: string | null = null;
    while (state.next !== undefined) {
      const request = state.next;
      delete state.next;
      ({ value: inForce, sentence } = await this.#send(key, request));
      if (sentence !== null) sentence = refusalInWords(sentence);
    }
    this.#open.delete(key);
    if (inForce !== null) settings.value = withEntry(settings.value, key, inForce);
    if (sentence !== (refusals.value.get(key) ?? null))
      refusals.value = withEntry(refusals.value, key, sentence ?? undefined);
  }

  /** Takes values that the server sends unasked; a setting with an open request keeps the requested value. */
  receive(values: ReadonlyMap<string, Setting>): void {
    const all = new Map(settings.value);
    for (const [key, value] of values) if (!this.#open.has(key)) all.set(key, value);
    settings.value = all;
  }
}
