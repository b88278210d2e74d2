import { effect } from '@preact/signals';
import { persisted } from '../lib/persisted';

/** The panels, in the order of their tabs and of the keys 1, 2, … */
export const TABS = ['drive', 'tune', 'laps', 'faults', 'whatif'] as const;
export type Tab = (typeof TABS)[number];

const isTab = (value: unknown): value is Tab => (TABS as readonly unknown[]).includes(value);

/** The panel that is shown. */
export const tab = persisted<Tab>('tab', 'laps', isTab);

/** The tab that an address names; null without one. */
export function tabIn(hash: string): Tab | null {
  const name = hash.slice(1);
  return isTab(name) ? name : null;
}

/** Shows the tab that the address names, now and whenever it changes: it has priority over the one shown last. */
export function readAddress(): void {
  const follow = (): void => {
    tab.value = tabIn(location.hash) ?? tab.value;
  };
  follow();
  addEventListener('popstate', follow);
}

/** Keeps the tab in the address: links and reload open it, back and forward go through the tabs that were shown. */
export function followAddress(): void {
  readAddress();
  effect(() => {
    const shown = tab.value;
    if (tabIn(location.hash) === shown) return;
    // The first tab belongs to the address that was opened: back leaves the page.
    if (tabIn(location.hash) === null) history.replaceState(null, '', `#${shown}`);
    else history.pushState(null, '', `#${shown}`);
  });
}
