import { onThemeChange, tokenColour } from '../draw/theme';
import { store } from '../lib/store';
import { LIMITERS } from '../lib/words';

/** The colours of the style sheet that charts need. */
export interface ChartColours {
  readonly series: readonly string[];
  readonly limiter: readonly string[];
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
  series: Array.from({ length: 10 }, (_, i) => tokenColour(`series-${i + 1}`)),
  limiter: Array.from({ length: LIMITERS.length }, (_, i) => tokenColour(`limiter-${i}`)),
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

/** Clears a canvas and fits it to its box [CSS pixels] and the screen's resolution; null without a visible canvas. */
export function fitCanvas(canvas: HTMLCanvasElement, width: number, height: number): CanvasRenderingContext2D | null {
  const ratio = Math.min(devicePixelRatio, 2);
  const context = canvas.getContext('2d');
  if (!context || width === 0 || height === 0) return null;
  const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return context;
}
