// Colours of canvases, read from styles/tokens.css for the light and the dark scheme.
import { effect, untracked } from '@preact/signals';
import { scheme } from '../lib/appearance';
import { store } from '../lib/store';

/** The colours of tokens.css that canvases need, with their tokens. */
const COLOURS = {
  land: 'land',
  landLine: 'land-line',
  road: 'road',
  mark: 'mark', // edges and dashes of the road
  kerb: 'kerb',
  a: 'road-a', // the way driven
  b: 'road-b', // what it is compared with: the limit's line, the ghost
  plan: 'road-plan',
  pastPlan: 'road-past',
  lost: 'road-lost',
  won: 'road-won',
  car: 'car',
  glass: 'glass',
  wheel: 'wheel',
  ink: 'ink',
  quiet: 'quiet',
  rule: 'rule',
  sheet: 'sheet',
  act: 'act',
  planInText: 'plan',
  lostInText: 'lost',
  wonInText: 'won',
} as const;

/** Colours and fonts as canvases can use them. */
export interface Theme extends Readonly<Record<keyof typeof COLOURS, string>> {
  readonly series: readonly string[]; // of curves
  readonly font: string;
}

/** Tokens of the colours of curves, by number. */
const SERIES = ['ink', 'other', 'plan', 'lost', 'won', 'quiet', 'act', 'edge', 'quiet', 'rule'] as const;
/** Colour of a curve by its number, as a value of CSS. */
export const toneOf = (series: number): string => `var(--${SERIES[series] ?? 'quiet'})`;

/** Computed colour of a token in the scheme that is shown: canvases know no light-dark() and no color-mix(). */
function tokenColour(name: string): string {
  const probe = document.createElement('i');
  probe.style.colorScheme = scheme.peek(); // the page's own may change only after this
  probe.style.color = `var(--${name})`;
  document.documentElement.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}

/** Reads all tokens. */
const read = (): Theme => ({
  ...(Object.fromEntries(Object.entries(COLOURS).map(([name, token]) => [name, tokenColour(token)])) as Record<
    keyof typeof COLOURS,
    string
  >),
  series: SERIES.map(tokenColour),
  font: getComputedStyle(document.body).fontFamily,
});

/** Themes that were read, by scheme. */
const known = store.data('page', () => ({ light: null as Theme | null, dark: null as Theme | null }));
const listeners = new Set<() => void>();

effect(() => {
  void scheme.value;
  untracked(() => {
    for (const listener of listeners) listener();
  });
});

/** The colours of the scheme that the page shows, or is about to show. */
export const theme = (): Theme => (known[scheme.peek()] ??= read());

/** Calls back when the colour scheme changes between light and dark. */
export function onThemeChange(listener: () => void): () => void {
  listeners.add(listener);
  return () => void listeners.delete(listener);
}
