import { computed } from '@preact/signals';
import { clamp } from '../lib/math';
import { persisted } from '../lib/persisted';
import { store } from '../lib/store';

// Where the panel stands, and how large it is: kept by the browser.

type Dock = 'right' | 'bottom';

export const dock = persisted<Dock>('dock', 'right', (value) => value === 'right' || value === 'bottom');
const shareRight = persisted<number>('dock.right', 0.34);
const shareBottom = persisted<number>('dock.bottom', 0.44);

/** Where the window has room, the numbers stand on the picture, which is larger for it. */
const roomy = typeof matchMedia === 'undefined' ? null : matchMedia('(min-width: 1001px) and (min-height: 600px)');
export const isRoomy = store.signal('page', roomy?.matches ?? true);
roomy?.addEventListener('change', () => (isRoomy.value = roomy.matches));

/** The share of the window that the panel takes, where it is docked now. */
export const panelShare = computed<number>(() => (dock.value === 'right' ? shareRight.value : shareBottom.value));

export function setPanelShare(share: number): void {
  const limited = clamp(share, 0.2, 0.8);
  if (dock.value === 'right') shareRight.value = limited;
  else shareBottom.value = limited;
}

export function toggleDock(): void {
  dock.value = dock.value === 'right' ? 'bottom' : 'right';
}
