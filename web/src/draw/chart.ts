import { tidy } from '../lib/scale';
import { drawStretch, knownStretches } from './curve';
import type { Theme } from './theme';

// A chart of columns over time, on a canvas. Lengths in CSS pixels, y down.

type Context = CanvasRenderingContext2D;

/** Room round the plotted area for the labels of the axes [px]. */
export const ROOM = { left: 44, right: 18, top: 8, bottom: 22 } as const;

/** Where the values of a chart are on its canvas. */
export interface Chart {
  readonly context: Context;
  readonly left: number;
  readonly right: number;
  readonly top: number;
  readonly bottom: number;
  readonly from: number; // of the horizontal axis
  readonly to: number;
  readonly x: (value: number) => number;
  readonly y: (value: number) => number;
}

/** The chart of a canvas: ranges of its horizontal and of its vertical axis. */
export function chartOn(
  context: Context,
  size: { readonly width: number; readonly height: number },
  [from, to]: readonly [number, number],
  [low, high]: readonly [number, number],
): Chart {
  const [left, right] = [ROOM.left, size.width - ROOM.right];
  const [top, bottom] = [ROOM.top, size.height - ROOM.bottom];
  const x = (value: number): number => left + ((value - from) / (to - from)) * (right - left);
  const y = (value: number): number => bottom - ((value - low) / (high - low || 1)) * (bottom - top);
  return { context, left, right, top, bottom, from, to, x, y };
}

/** Draws grid and labels; `label` gives those of the horizontal axis. */
export function drawAxes(
  { context, left, right, top, bottom, x, y }: Chart,
  xTicks: readonly number[],
  yTicks: readonly number[],
  label: (tick: number) => string,
  { rule, quiet, font }: Theme,
): void {
  context.strokeStyle = rule;
  context.lineWidth = 1;
  context.beginPath();
  const sharp = (place: number): number => Math.round(place) + 0.5; // a line of one pixel, not of two faint ones
  for (const tick of xTicks) {
    context.moveTo(sharp(x(tick)), top);
    context.lineTo(sharp(x(tick)), bottom);
  }
  for (const tick of yTicks) {
    context.moveTo(left, sharp(y(tick)));
    context.lineTo(right, sharp(y(tick)));
  }
  context.stroke();
  context.fillStyle = quiet;
  context.font = `11px ${font}`;
  context.textBaseline = 'middle';
  context.textAlign = 'center';
  for (const tick of xTicks) context.fillText(label(tick), x(tick), bottom + 12);
  context.textAlign = 'right';
  for (const tick of yTicks) context.fillText(tidy(tick), left - 7, y(tick));
}

/** A curve of a chart. */
export interface ChartCurve {
  readonly values: ArrayLike<number>;
  readonly colour: string;
  readonly isDashed: boolean;
  /** Colour of the area down to 0; without it a line alone. */
  readonly fill?: string;
}

/** Draws a curve inside the plotted area, with a gap where values are more than `longest` seconds apart. */
export function drawCurve(
  { context, left, right, top, bottom, x, y }: Chart,
  times: ArrayLike<number>,
  { values, colour, isDashed, fill }: ChartCurve,
  longest: number,
): void {
  const at = (of: ArrayLike<number>, i: number): number => of[i] ?? NaN;
  const [atX, atY] = [(i: number) => x(at(times, i)), (i: number) => y(at(values, i))];
  const stretches = knownStretches(
    times.length,
    (i) => Number.isFinite(at(values, i)),
    (i) => at(times, i) - at(times, i - 1) > longest,
  );
  context.save();
  context.beginPath();
  context.rect(left, top - 1, right - left, bottom - top + 2);
  context.clip();
  context.lineJoin = 'round';
  context.strokeStyle = colour;
  context.lineWidth = fill ? 1 : 1.75;
  if (isDashed) context.setLineDash([5, 4]);
  for (const stretch of stretches) {
    const path = new Path2D();
    drawStretch(path, stretch, atX, atY);
    if (fill) {
      const area = new Path2D(path);
      area.lineTo(atX(stretch[1] - 1), y(0));
      area.lineTo(atX(stretch[0]), y(0));
      context.fillStyle = fill;
      context.fill(area);
    }
    context.stroke(path);
  }
  context.restore();
}
