import { computed, signal } from '@preact/signals';
import type { SchemaEntry } from '../protocol/schema';
import type { SetAnswer, Setting } from '../protocol/source';

/** All tunables, as the server describes them; empty while it has not. */
export const schema = signal<readonly SchemaEntry[]>([]);
/** What is in force, or wished for and on its way. */
export const settings = signal<ReadonlyMap<string, Setting>>(new Map());
/** What the run started with. */
export const startSettings = signal<ReadonlyMap<string, Setting>>(new Map());
/** Sentences about wishes that were refused, until the same tunable is set again. */
export const refusals = signal<ReadonlyMap<string, string>>(new Map());

export const entryOf = (key: string): SchemaEntry | undefined => schema.value.find((entry) => entry.key === key);

/** Controls of the page rather than tunables of the experiment: not part of a preset or a list of changes. */
export const isControl = (key: string): boolean => /^(run|manual|fault)\./.test(key);

export interface SettingChange {
  readonly key: string;
  readonly from: Setting;
  readonly to: Setting;
}

/** What differs from the start, in the order of the schema. */
export const settingChanges = computed<readonly SettingChange[]>(() =>
  changesBetween(startSettings.value, settings.value).filter(({ key }) => !isControl(key)),
);

export function changesBetween(
  start: ReadonlyMap<string, Setting>,
  now: ReadonlyMap<string, Setting>,
): SettingChange[] {
  return [...start].flatMap(([key, from]) => {
    const to = now.get(key);
    return to === undefined || Object.is(to, from) ? [] : [{ key, from, to }];
  });
}

function withEntry<T>(map: ReadonlyMap<string, T>, key: string, value: T | undefined): ReadonlyMap<string, T> {
  const copy = new Map(map);
  if (value === undefined) copy.delete(key);
  else copy.set(key, value);
  return copy;
}

/**
 * Sends wishes for tunables. The page shows a wish at once; for each tunable only one is on its way, and of those that
 * come meanwhile only the newest follows it, so that a dragged slider never builds a queue. A refused wish snaps back.
 */
export class Wishes {
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
      const wish = state.next;
      delete state.next;
      ({ value: inForce, sentence } = await this.#send(key, wish));
    }
    this.#open.delete(key);
    if (inForce !== null) settings.value = withEntry(settings.value, key, inForce);
    if (sentence !== (refusals.value.get(key) ?? null))
      refusals.value = withEntry(refusals.value, key, sentence ?? undefined);
  }

  /** Values the server tells of its own accord; wishes on their way win. */
  receive(values: ReadonlyMap<string, Setting>): void {
    const all = new Map(settings.value);
    for (const [key, value] of values) if (!this.#open.has(key)) all.set(key, value);
    settings.value = all;
  }
}
