import { effect, untracked } from '@preact/signals';
import { scheme } from '../lib/appearance';
import { store } from '../lib/store';

/** The colours of tokens.css that canvases need. */
export interface Theme {
  readonly land: string;
  readonly landLine: string;
  readonly road: string;
  readonly mark: string; // edges and dashes of the road
  readonly kerb: string;
  readonly a: string; // the way driven
  readonly b: string; // what it is compared with: the limit's line, the ghost
  readonly plan: string;
  readonly pastPlan: string;
  readonly lost: string;
  readonly won: string;
  readonly car: string;
  readonly glass: string;
  readonly wheel: string;
  readonly ink: string;
  readonly quiet: string;
  readonly rule: string;
  readonly sheet: string;
  readonly act: string;
  readonly planInText: string;
  readonly lostInText: string;
  readonly wonInText: string;
  readonly series: readonly string[]; // of curves
  readonly font: string;
}

/** Tokens of curves, by number. */
const SERIES = ['ink', 'other', 'plan', 'lost', 'won', 'quiet', 'act', 'edge', 'quiet', 'rule'] as const;
/** Of a curve, as a style has it. */
export const toneOf = (series: number): string => `var(--${SERIES[series] ?? 'quiet'})`;

/** A token as a canvas can use it: light or dark as `scheme` says, and colours are mixed. */
function tokenColour(name: string): string {
  const probe = document.createElement('i');
  probe.style.colorScheme = scheme.peek(); // the page may follow after this
  probe.style.color = `var(--${name})`;
  document.documentElement.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}

const read = (): Theme => ({
  land: tokenColour('land'),
  landLine: tokenColour('land-line'),
  road: tokenColour('road'),
  mark: tokenColour('mark'),
  kerb: tokenColour('kerb'),
  a: tokenColour('road-a'),
  b: tokenColour('road-b'),
  plan: tokenColour('road-plan'),
  pastPlan: tokenColour('road-past'),
  lost: tokenColour('road-lost'),
  won: tokenColour('road-won'),
  car: tokenColour('car'),
  glass: tokenColour('glass'),
  wheel: tokenColour('wheel'),
  ink: tokenColour('ink'),
  quiet: tokenColour('quiet'),
  rule: tokenColour('rule'),
  sheet: tokenColour('sheet'),
  act: tokenColour('act'),
  planInText: tokenColour('plan'),
  lostInText: tokenColour('lost'),
  wonInText: tokenColour('won'),
  series: SERIES.map(tokenColour),
  font: getComputedStyle(document.body).fontFamily,
});

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
