// Charts and maps of results: their format, their axes, and the paths of their series in pixels.
import { ticksOf } from '../draw/axis';
import { curvePath } from '../draw/curve';
import { extent } from '../lib/math';

/** Tokens of the colours of a series. */
export const TONES = {
  ink: 'ink',
  other: 'other',
  good: 'won',
  bad: 'lost',
  soft: 'edge',
  faint: 'rule',
  paper: 'paper',
} as const;

/** A chart, or a map, whose axes have the same scale. */
export interface Plot {
  readonly part: 'chart' | 'map';
  readonly title: string;
  readonly x: string;
  readonly series: readonly Series[];
}

/** A series of a plot. */
export interface Series {
  readonly draw: 'line' | 'dots' | 'cells' | 'mark';
  readonly tone: keyof typeof TONES;
  readonly name: string;
  /** x, y, …; of cells x, y, width, height, …; of marks x, … */
  readonly values: readonly (number | null)[];
}

/** Where the values of a plot are in its picture [px], y down. */
export interface Frame {
  readonly width: number;
  readonly height: number;
  readonly x: (value: number) => number;
  readonly y: (value: number) => number;
  readonly xTicks: readonly number[];
  readonly yTicks: readonly number[];
}

type Range = [low: number, high: number];

/** Room round the plotted area [px]. */
export const MARGIN = { left: 52, right: 12, top: 8, bottom: 40 } as const;
/**
 * Height of a chart [px], of a map at most as a share of its width, share of a range that is kept free, and distance of
 * ticks [px]; chosen.
 */
const CHART_HEIGHT = 160;
const MOST_MAP_HEIGHT = 0.62;
const PAD = 0.04;
const TICK_EVERY = { x: 80, y: 36 } as const;

/**
 * Every `step`th value from `first`; with a `length`, each is followed by its sum with that many values on. NaN:
 * unknown.
 */
const every = ({ values }: Series, step: number, first: number, length = first): number[] =>
  values.flatMap((value, i) =>
    i % step === first
      ? [value ?? NaN, (value ?? NaN) + (length > first ? (values[i + length - first] ?? NaN) : 0)]
      : [],
  );

/** Range of all values of the series along an axis. */
function rangeOf(series: readonly Series[], axis: 0 | 1): Range {
  const values = series.flatMap((each) => {
    if (each.draw === 'mark') return axis === 0 ? every(each, 1, 0) : [];
    return each.draw === 'cells' ? every(each, 4, axis, axis + 2) : every(each, 2, axis);
  });
  return extent(values.filter(Number.isFinite)) ?? [0, 0];
}

/** A range of another length about the same middle. */
const widened = ([low, high]: Range, to: number): Range => [(low + high - to) / 2, (low + high + to) / 2];

/** A range with room at both ends, except at an end that is 0: bars stand on it. */
function padded([low, high]: Range): Range {
  if (high <= low) return widened([low, high], Math.abs(low) || 1);
  const pad = PAD * (high - low);
  return [low === 0 ? 0 : low - pad, high === 0 ? 0 : high + pad];
}

/** The frame of a plot in a picture so many pixels wide. */
export function frameOf(plot: Plot, width: number): Frame {
  const [across, isMap] = [Math.max(80, width - MARGIN.left - MARGIN.right), plot.part === 'map'];
  let [x, y] = [padded(rangeOf(plot.series, 0)), padded(rangeOf(plot.series, 1))];
  let down = CHART_HEIGHT;
  if (isMap) {
    const scale = Math.min(across / (x[1] - x[0]), (MOST_MAP_HEIGHT * across) / (y[1] - y[0]));
    down = Math.max(CHART_HEIGHT, scale * (y[1] - y[0]));
    [x, y] = [widened(x, across / scale), widened(y, down / scale)];
  }
  const [perX, perY] = [across / (x[1] - x[0]), down / (y[1] - y[0])];
  return {
    width: across + MARGIN.left + MARGIN.right,
    height: down + MARGIN.top + MARGIN.bottom,
    x: (value) => MARGIN.left + perX * (value - x[0]),
    y: (value) => MARGIN.top + perY * (y[1] - value),
    xTicks: ticksOf(...x, across / TICK_EVERY.x),
    yTicks: ticksOf(...y, down / TICK_EVERY.y),
  };
}

const px = (value: number): string => value.toFixed(1);

/** The path of a series: of dots, strokes of no length. */
export function pathOf({ draw, values }: Series, { x, y, height }: Frame): string {
  const at = (i: number): number => values[i] ?? NaN;
  if (draw === 'line')
    return curvePath(
      values.length >> 1,
      (i) => x(at(2 * i)),
      (i) => y(at(2 * i + 1)),
    );
  const step = { dots: 2, cells: 4, mark: 1 }[draw];
  let path = '';
  for (let i = 0; i + step <= values.length; i += step) {
    if (!Number.isFinite(at(i)) || (draw !== 'mark' && !Number.isFinite(at(i + 1)))) continue;
    const place = `M${px(x(at(i)))} ${px(draw === 'mark' ? MARGIN.top : y(at(i + 1)))}`;
    if (draw === 'dots') path += `${place}h0`;
    else if (draw === 'mark') path += `${place}V${px(height - MARGIN.bottom)}`;
    else path += `${place}H${px(x(at(i) + at(i + 2)))}V${px(y(at(i + 1) + at(i + 3)))}H${px(x(at(i)))}z`;
  }
  return path;
}

/** Diameter of the dots of a series [px]: of few, such that each is seen. */
export const dotSize = ({ values }: Series): number => (values.length < 120 ? 6 : 2.4);
