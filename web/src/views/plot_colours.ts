import { onThemeChange, tokenColour } from '../draw/theme';
import { store } from '../lib/store';

/** Tokens of curves, by number. */
const SERIES = ['ink', 'other', 'plan', 'lost', 'won', 'quiet', 'act', 'edge', 'quiet', 'rule'] as const;
/** Of a curve, as a style has it. */
export const toneOf = (series: number): string => `var(--${SERIES[series] ?? 'quiet'})`;

/** The colours of the style sheet that charts need. */
export interface ChartColours {
  readonly series: readonly string[];
  readonly good: string;
  readonly warning: string;
  readonly bad: string;
  readonly text: string;
  readonly soft: string;
  readonly faint: string;
  readonly grid: string;
  readonly panel: string;
  readonly font: string;
}

const read = (): ChartColours => ({
  series: SERIES.map(tokenColour),
  good: tokenColour('won'),
  warning: tokenColour('plan'),
  bad: tokenColour('lost'),
  text: tokenColour('ink'),
  soft: tokenColour('quiet'),
  faint: tokenColour('quiet'),
  grid: tokenColour('rule'),
  panel: tokenColour('sheet'),
  font: getComputedStyle(document.body).fontFamily,
});

const known = store.data('page', () => ({ colours: null as ChartColours | null }));
onThemeChange(() => (known.colours = null));

export const chartColours = (): ChartColours => (known.colours ??= read());
