// Colour scheme of the page: as the system prefers, or light or dark as chosen here.
import { computed, effect } from '@preact/signals';
import { persisted } from './persisted';
import { store } from './store';

export const APPEARANCES = ['system', 'light', 'dark'] as const;
export type Appearance = (typeof APPEARANCES)[number];

const isAppearance = (value: unknown): value is Appearance => (APPEARANCES as readonly unknown[]).includes(value);

/** The user's choice; kept by the browser. */
export const appearance = persisted<Appearance>('appearance', 'system', isAppearance);

const prefersDark = typeof matchMedia === 'undefined' ? null : matchMedia('(prefers-color-scheme: dark)');
const isSystemDark = store.signal('page', prefersDark?.matches ?? false);
prefersDark?.addEventListener('change', () => (isSystemDark.value = prefersDark.matches));

/** The scheme that is shown. */
export const scheme = computed<'light' | 'dark'>(() =>
  appearance.value === 'system' ? (isSystemDark.value ? 'dark' : 'light') : appearance.value,
);

/** Switches between light and dark; chooses 'system' where the system has the new one. */
export function toggleScheme(): void {
  const other = scheme.value === 'dark' ? 'light' : 'dark';
  appearance.value = (isSystemDark.value ? 'dark' : 'light') === other ? 'system' : other;
}

if (typeof document !== 'undefined') {
  effect(() => {
    document.documentElement.style.colorScheme = scheme.value;
  });
}
