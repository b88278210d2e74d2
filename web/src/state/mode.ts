// Mode of the page, kept in its address.
import { effect } from '@preact/signals';
import { store } from '../lib/store';

/** What the page is for at the moment, in the order of the header and of the keys 1, 2, 3. */
export const MODES = ['watch', 'understand', 'try'] as const;
export type Mode = (typeof MODES)[number];

/** The mode that is shown. */
export const mode = store.signal<Mode>('page', 'watch');

/** The mode that an address names; null without one. */
export function modeIn(hash: string): Mode | null {
  const name = /^#(\w+)/.exec(hash)?.[1];
  return MODES.find((each) => each === name) ?? null;
}

/** Shows the mode that the address names, now and whenever it changes. */
export function readAddress(): void {
  const follow = (): void => {
    mode.value = modeIn(location.hash) ?? mode.value;
  };
  follow();
  addEventListener('popstate', follow);
}

/** Keeps the mode in the address: links and reload open it, back and forward go through the modes that were shown. */
export function followAddress(): void {
  readAddress();
  effect(() => {
    const shown = mode.value;
    if (modeIn(location.hash) === shown) return;
    // The first mode belongs to the address that was opened: back leaves the page.
    if (modeIn(location.hash) === null) history.replaceState(null, '', `#${shown}`);
    else history.pushState(null, '', `#${shown}`);
  });
}
