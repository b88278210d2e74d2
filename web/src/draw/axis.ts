// Ranges and ticks of the axes of plots.
import { extent, niceCeil } from '../lib/math';

/** Values of the curves of a plot. */
type Columns = readonly ArrayLike<number>[];
/** Range of an axis for the columns that are drawn. */
type AxisRange = (columns: Columns) => [number, number];

/** Factor from the greatest value to the least end of an axis, so that lines do not touch the frame; chosen. */
const HEADROOM = 1.06;

/** The greatest distance of a value from 0. */
const reachOf = (columns: Columns): number =>
  Math.max(0, ...columns.flatMap((column) => extent(column) ?? []).map(Math.abs));

/** From 0 to a round number above all absolute values, at least `least`: the axis seldom changes. */
export const fromZero =
  (least: number, headroom = HEADROOM): AxisRange =>
  (columns) => [0, niceCeil(Math.max(least, headroom * reachOf(columns)))];

/** Symmetric about 0, to a round number beyond all values, at least `least`. */
export const aboutZero =
  (least: number, headroom = HEADROOM): AxisRange =>
  (columns) => {
    const [, end] = fromZero(least, headroom)(columns);
    return [-end, end];
  };

/** Around all values in whole steps, at least `least` high: for values far from 0. */
export function rangeInSteps(values: Columns, step: number, least: number): [number, number] {
  const extents = values.flatMap((column) => extent(column) ?? []);
  if (extents.length === 0) return [0, least];
  const low = Math.floor(Math.min(...extents) / step) * step;
  const high = Math.ceil(Math.max(...extents) / step) * step;
  return high - low >= least ? [low, high] : [Math.max(0, high - least), Math.max(high, least)];
}

/** Round numbers from `low` to `high`, at most `most` of them: 1, 2 or 5 times a power of ten apart. */
export function ticksOf(low: number, high: number, most: number): number[] {
  const span = high - low;
  if (!(span > 0) || !Number.isFinite(span)) return [];
  const power = 10 ** Math.floor(Math.log10(span / most));
  const step = [1, 2, 5, 10, 20].map((factor) => factor * power).find((each) => span / each < most) ?? 20 * power;
  const first = Math.ceil(low / step - 1e-9);
  const count = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: count }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}
