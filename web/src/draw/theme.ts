import { effect } from '@preact/signals';
import { scheme } from '../lib/appearance';
import { store } from '../lib/store';

/** The colours of style.css that canvases need. */
export interface Theme {
  readonly ground: string;
  readonly groundLine: string;
  readonly road: string;
  readonly edge: string;
  readonly centreLine: string;
  readonly reference: string;
  readonly trace: string;
  readonly racingLine: string;
  readonly predicted: string;
  readonly outcome: string;
  readonly carBody: string;
  readonly carGlass: string;
  readonly carEdge: string;
  readonly wheel: string;
  readonly brake: string;
  readonly gain: string;
  readonly kerb: string;
  readonly kerbLight: string;
  readonly text: string;
  readonly faint: string;
  readonly grid: string;
  readonly panel: string;
  readonly accent: string;
  readonly font: string;
  readonly series: readonly [string, string];
}

function read(): Theme {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string): string => style.getPropertyValue(`--${name}`).trim();
  return {
    ground: colour('ground'),
    groundLine: colour('ground-line'),
    road: colour('road'),
    edge: colour('road-edge'),
    centreLine: colour('centre-line'),
    reference: colour('reference'),
    trace: colour('trace'),
    racingLine: colour('racing-line'),
    predicted: colour('predicted'),
    outcome: colour('outcome'),
    carBody: colour('car-body'),
    carGlass: colour('car-glass'),
    carEdge: colour('car-edge'),
    wheel: colour('wheel'),
    brake: colour('bad'),
    gain: colour('good'),
    kerb: colour('kerb'),
    kerbLight: colour('kerb-light'),
    text: colour('text'),
    faint: colour('text-faint'),
    grid: colour('grid'),
    panel: colour('panel'),
    accent: colour('accent'),
    font: style.fontFamily,
    series: [colour('series-1'), colour('series-2')],
  };
}

const known = store.data('page', () => ({ theme: null as Theme | null }));
const listeners = new Set<() => void>();

effect(() => {
  void scheme.value;
  known.theme = null;
  for (const listener of listeners) listener();
});

export const theme = (): Theme => (known.theme ??= read());

/** Calls back when the colour scheme changes between light and dark. */
export function onThemeChange(listener: () => void): () => void {
  listeners.add(listener);
  return () => void listeners.delete(listener);
}
