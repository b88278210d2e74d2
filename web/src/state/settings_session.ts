import { effect } from '@preact/signals';
import type { Setting } from '../protocol/source';
import { requests } from './operate';
import { run } from './run';
import { refusals, settings, startSettings } from './settings';

// The values a run started with survive a reload of the page, in the session storage of the browser's tab.
const KEY = 'chicane.start';

let session = '';
let isStartKnown = false;

interface Kept {
  readonly session: string;
  readonly start: readonly [string, Setting][];
}

function kept(): Kept | null {
  try {
    return JSON.parse(sessionStorage.getItem(KEY) ?? 'null') as Kept | null;
  } catch {
    return null;
  }
}

function keep(start: ReadonlyMap<string, Setting>): void {
  startSettings.value = start;
  try {
    sessionStorage.setItem(KEY, JSON.stringify({ session, start: [...start] } satisfies Kept));
  } catch {
    // Without storage the start is what the page receives first.
  }
}

/** Begins another run, whose values are not known yet. */
export function beginSettings(name: string): void {
  session = name;
  settings.value = new Map();
  refusals.value = new Map();
  const before = kept();
  isStartKnown = before?.session === name;
  startSettings.value = isStartKnown && before ? new Map(before.start) : new Map();
}

export function takeSettings(values: ReadonlyMap<string, Setting>, isAll: boolean): void {
  requests.receive(values);
  if (!isAll || isStartKnown) return;
  isStartKnown = true;
  keep(new Map(values));
}

/** Requests all values again when the track, car, controller or preset changes; a new preset also resets the start. */
export function refreshOnNewChoice(refresh: () => void): void {
  let [preset, rest] = ['', ''];
  effect(() => {
    const now = run.value;
    if (!now) return;
    const others = [now.track, now.car, now.controller].join('\n');
    const [isPreset, isOther] = [preset !== '' && preset !== now.preset, rest !== '' && rest !== others];
    [preset, rest] = [now.preset, others];
    if (isPreset) isStartKnown = false;
    if (isPreset || isOther) refresh();
  });
}
