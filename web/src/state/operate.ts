import { signal } from '@preact/signals';
import type { ServiceName, Setting, Source } from '../protocol/source';
import { link, notice, services } from './link';
import { entryOf, settings, Wishes } from './settings';

/** What the page can do to the run; everything goes through here, whoever asks. */
let source: Source | null = null;

/** A wish that starts the run anew and waits for a yes. */
export const asking = signal<{ readonly key: string; readonly value: Setting } | null>(null);
let wasAsked = false;

export const wishes = new Wishes(
  (key, value) =>
    source?.set?.(key, value) ?? Promise.resolve({ value: null, sentence: `${key} cannot be changed here` }),
);

export function attach(to: Source): void {
  source = to;
}

export const retry = (): void => source?.retryNow?.();

/** Asks for the values of all tunables again. */
export const refresh = (): void => source?.refresh?.();

export const can = (name: ServiceName): boolean => services.value.has(name) && link.value === 'live';

export function call(name: ServiceName, data?: boolean): void {
  void source?.call?.(name, data).then((sentence) => {
    if (sentence !== null) notice.value = sentence;
  });
}

/** Whether a tunable can be set now. */
export const canSet = (key: string): boolean => link.value === 'live' && settings.value.has(key);

/** Sets a tunable. The first time one would start the run anew, the operator is asked. */
export function set(key: string, value: Setting): void {
  if (entryOf(key)?.is_live === false && !wasAsked) {
    asking.value = { key, value };
    return;
  }
  void wishes.set(key, value);
}

/** The operator's answer to `asking`; a yes holds for the rest of the page's life. */
export function answer(isYes: boolean): void {
  const wish = asking.value;
  asking.value = null;
  if (!isYes || !wish) {
    settings.value = new Map(settings.value); // whatever shows the wish shows the value in force again
    return;
  }
  wasAsked = true;
  void wishes.set(wish.key, wish.value);
}
