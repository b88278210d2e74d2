import { onThemeChange } from '../draw/theme';
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

function read(): ChartColours {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string): string => style.getPropertyValue(`--${name}`).trim();
  return {
    series: Array.from({ length: 10 }, (_, i) => colour(`series-${i + 1}`)),
    limiter: Array.from({ length: LIMITERS.length }, (_, i) => colour(`limiter-${i}`)),
    good: colour('good'),
    warning: colour('warning'),
    bad: colour('bad'),
    text: colour('text'),
    soft: colour('text-soft'),
    faint: colour('text-faint'),
    grid: colour('grid'),
    panel: colour('panel'),
    font: style.fontFamily,
  };
}

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
