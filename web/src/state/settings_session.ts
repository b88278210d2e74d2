import { effect } from '@preact/signals';
import type { Setting } from '../protocol/source';
import { requests } from './operate';
import { run } from './run';

export function takeSettings(values: ReadonlyMap<string, Setting>): void {
  requests.receive(values);
}

/** Requests all values again when the track, car, controller or preset changes. */
export function refreshOnNewChoice(refresh: () => void): void {
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
