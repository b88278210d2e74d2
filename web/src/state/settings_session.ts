import { effect } from '@preact/signals';
import type { Setting } from '../protocol/source';
import { wishes } from './operate';
import { run } from './run';
import { refusals, settings, startSettings } from './settings';

// What a run started with outlives a reload of the page, in the storage of the browser's tab.
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
    // Without storage the start is what the page first sees.
  }
}

/** Another run: its values are not known yet. */
export function beginSettings(name: string): void {
  session = name;
  settings.value = new Map();
  refusals.value = new Map();
  const before = kept();
  isStartKnown = before?.session === name;
  startSettings.value = isStartKnown && before ? new Map(before.start) : new Map();
}

export function takeSettings(values: ReadonlyMap<string, Setting>, isAll: boolean): void {
  wishes.receive(values);
  if (!isAll || isStartKnown) return;
  isStartKnown = true;
  keep(new Map(values));
}

/** Asks for all values again when something was chosen anew; another preset is another start. */
export function refreshWhenChosenAnew(refresh: () => void): void {
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
