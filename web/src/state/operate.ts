// Requests to the program: every view changes the run through these functions.
import { effect } from '@preact/signals';
import { store } from '../lib/store';
import type { AskAnswer, ServiceName, Setting, Source } from '../protocol/source';
import { link, notice, services } from './link';
import { run } from './run';
import { entryOf, SettingRequests, settings } from './settings';

/** What the page can do to the run: every view changes it through these functions. */
const operated = store.data('page', () => ({ source: null as Source | null, isConfirmed: false }));

/** A change that would restart the run and waits for the operator's confirmation. */
export const pendingConfirmation = store.signal<{ readonly key: string; readonly value: Setting } | null>('page', null);

/** Requests to change settings. */
export const requests = new SettingRequests(
  (key, value) =>
    operated.source?.set?.(key, value) ?? Promise.resolve({ value: null, sentence: `${key} cannot be changed here` }),
);

/** Sends all requests to another source from now on. */
export function attach(to: Source): void {
  operated.source = to;
}

/** Connects now instead of waiting. */
export const retry = (): void => operated.source?.retryNow?.();

/** Requests the values of all settings again. */
export const refresh = (): void => operated.source?.refresh?.();

/** Requests them whenever the track, car, controller or preset changes. */
export function refreshOnNewChoice(): void {
  let known = '';
  effect(() => {
    const now = run.value;
    if (!now) return;
    const choice = [now.track, now.car, now.controller, now.preset].join('\n');
    const isOther = known !== '' && known !== choice;
    known = choice;
    if (isOther) refresh();
  });
}

/** Whether a service can be called now. */
export const can = (name: ServiceName): boolean => services.value.has(name) && link.value === 'live';

/** Calls a service; a refusal becomes a notice. */
export function call(name: ServiceName, data?: boolean): void {
  void operated.source?.call?.(name, data).then((sentence) => {
    if (sentence !== null) notice.value = sentence;
  });
}

/** Asks for another future of the run that goes on; or begins a race against a second car, or ends it. */
export const ask = (name: '/what_if' | '/rival', question: string): Promise<AskAnswer> =>
  operated.source?.ask?.(name, question) ?? Promise.resolve({ isTaken: false, message: 'nobody is there to ask' });

/** Whether a setting can be changed now. */
export const canSet = (key: string): boolean =>
  link.value === 'live' && settings.value.has(key) && entryOf(key)?.is_fixed !== true;

/** Changes a setting. The first change that would restart the run has to be confirmed. */
export function set(key: string, value: Setting): void {
  if (entryOf(key)?.is_live === false && !operated.isConfirmed) {
    pendingConfirmation.value = { key, value };
    return;
  }
  void requests.set(key, value);
}

/** Confirms or cancels the pending change; a confirmation holds until the page is closed. */
export function confirm(isYes: boolean): void {
  const request = pendingConfirmation.value;
  pendingConfirmation.value = null;
  if (!isYes || !request) {
    settings.value = new Map(settings.value); // controls show the value in force again
    return;
  }
  operated.isConfirmed = true;
  void requests.set(request.key, request.value);
}
