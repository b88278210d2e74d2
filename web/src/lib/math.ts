// Points and boxes, angles, interpolation, and search in ascending numbers.

/** A point in a plane. */
export interface Point {
  readonly x: number;
  readonly y: number;
}

/** A rectangle along the axes. */
export interface Box {
  readonly minX: number;
  readonly minY: number;
  readonly maxX: number;
  readonly maxY: number;
}

/** The value, or the bound that it exceeds. */
export const clamp = (value: number, low: number, high: number): number => Math.min(high, Math.max(low, value));

/** The remainder in [0, of). */
export const mod = (value: number, of: number): number => value - of * Math.floor(value / of);

/** The value at a share of the way from a to b. */
export const mix = (a: number, b: number, share: number): number => a + (b - a) * share;

/** An angle in degrees. */
export const degrees = (radians: number): number => (radians * 180) / Math.PI;

/** The angle wrapped to (−π, π]. */
export function wrapAngle(angle: number): number {
  const turn = 2 * Math.PI;
  const wrapped = angle - turn * Math.floor((angle + Math.PI) / turn);
  return wrapped === -Math.PI ? Math.PI : wrapped;
}

/** The smallest box around all points; null when there is none. */
export function boundsOf(points: Iterable<Point>): Box | null {
  let [minX, minY, maxX, maxY] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const { x, y } of points) {
    if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
    minX = Math.min(minX, x);
    minY = Math.min(minY, y);
    maxX = Math.max(maxX, x);
    maxY = Math.max(maxY, y);
  }
  return minX <= maxX ? { minX, minY, maxX, maxY } : null;
}

/** The next number of the series 1, 1.5, 2, 3, 4, 5, 6, 8, 10, 15 … that is not below `value`; value > 0. */
export function niceCeil(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  const step = [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find((factor) => factor * power >= value * (1 - 1e-12)) ?? 10;
  return step * power;
}

/** Smallest and largest finite value; null without any. */
export function extent(values: ArrayLike<number>): [number, number] | null {
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; i < values.length; ++i) {
    const value = values[i] ?? NaN;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high && Number.isFinite(low) && Number.isFinite(high) ? [low, high] : null;
}

/** Index of the first of these ascending times that is not before `since`. */
export function firstSince(times: ArrayLike<number>, since: number): number {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times[middle] ?? NaN) < since) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The pose `seconds` after a frame with constant speed and yaw rate: on an arc. */
export function extrapolate(
  pose: { x: number; y: number; yaw: number },
  motion: { vx: number; vy: number; yawRate: number },
  seconds: number,
): { x: number; y: number; yaw: number } {
  const rate = Number.isFinite(motion.yawRate) ? motion.yawRate : 0;
  const vy = Number.isFinite(motion.vy) ? motion.vy : 0;
  const middle = pose.yaw + (rate * seconds) / 2;
  const [cos, sin] = [Math.cos(middle), Math.sin(middle)];
  return {
    x: pose.x + (motion.vx * cos - vy * sin) * seconds,
    y: pose.y + (motion.vx * sin + vy * cos) * seconds,
    yaw: pose.yaw + rate * seconds,
  };
}
