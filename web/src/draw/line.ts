// Lines as columns of coordinates: lengths, the stretches inside a picture, and the part ahead of a car.
import type { Box, Point } from '../lib/math';
import { knownStretches } from './curve';

/** A line as columns, in W [m]. */
export interface Line {
  readonly x: ArrayLike<number>;
  readonly y: ArrayLike<number>;
}

/** The points of a line as columns. */
export const lineOf = (points: readonly Point[]): Line => ({
  x: Float64Array.from(points, ({ x }) => x),
  y: Float64Array.from(points, ({ y }) => y),
});

/** Length of the step that ends at a point of a line [m]. */
const stepTo = ({ x, y }: Line, i: number): number =>
  Math.hypot((x[i] ?? NaN) - (x[i - 1] ?? NaN), (y[i] ?? NaN) - (y[i - 1] ?? NaN));

/** Length of a line from its start to each of its points [m]. */
export function lengthsOf(line: Line): Float64Array {
  const lengths = new Float64Array(line.x.length);
  for (let i = 1; i < lengths.length; ++i) lengths[i] = (lengths[i - 1] ?? 0) + stepTo(line, i);
  return lengths;
}

/** The longest step between neighbouring points of a line [m]. */
export function longestStep(line: Line): number {
  let longest = 0;
  for (let i = 1; i < line.x.length; ++i) longest = Math.max(longest, stepTo(line, i) || 0);
  return longest;
}

/**
 * The stretches [first, end) of a line that lie within `margin` of a box. With a margin of the line's longest step no
 * piece that touches the box is missed.
 */
export function stretchesInside({ x, y }: Line, box: Box, margin: number): [number, number][] {
  const [left, right, low, high] = [box.minX - margin, box.maxX + margin, box.minY - margin, box.maxY + margin];
  return knownStretches(x.length, (i) => {
    const [px, py] = [x[i] ?? NaN, y[i] ?? NaN];
    return px >= left && px <= right && py >= low && py <= high;
  });
}

/** Adds the points [first, end) of a line to a path; a step longer than `most` is a jump and leaves a gap. */
export function addLine(path: Path2D, { x, y }: Line, first: number, end: number, most = Infinity): void {
  for (let i = first; i < end; ++i) {
    const [px, py] = [x[i] ?? NaN, y[i] ?? NaN];
    const isJump = i === first || Math.abs(px - (x[i - 1] ?? NaN)) > most || Math.abs(py - (y[i - 1] ?? NaN)) > most;
    if (isJump) path.moveTo(px, py);
    else path.lineTo(px, py);
  }
}

/** The part of a line that lies ahead of a pose: a plan that is a moment old begins behind its car. */
export function aheadOf({ x, y }: Line, pose: { readonly x: number; readonly y: number; readonly yaw: number }): Line {
  const [cos, sin] = [Math.cos(pose.yaw), Math.sin(pose.yaw)];
  let first = 0;
  while (first < x.length && cos * ((x[first] ?? 0) - pose.x) + sin * ((y[first] ?? 0) - pose.y) < 0) ++first;
  return { x: Array.prototype.slice.call(x, first), y: Array.prototype.slice.call(y, first) };
}
