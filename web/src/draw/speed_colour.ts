import { clamp, mix } from '../lib/math';
import type { SpeedUnit } from '../lib/units';

/** Slow to fast; equal steps look equally far apart and differ in lightness too, for colour-blind eyes. */
const STOPS: readonly (readonly [number, number, number])[] = [
  [72, 92, 220],
  [35, 150, 214],
  [38, 188, 150],
  [176, 208, 66],
  [252, 190, 56],
  [255, 112, 77],
];

/** Red, green, blue in [0, 255] for a share of the top speed in [0, 1]. */
export function speedRgb(share: number): readonly [number, number, number] {
  const at = clamp(Number.isFinite(share) ? share : 0, 0, 1) * (STOPS.length - 1);
  const i = Math.min(Math.floor(at), STOPS.length - 2);
  const [from, to] = [STOPS[i], STOPS[i + 1]];
  if (!from || !to) return [0, 0, 0];
  const channel = (k: 0 | 1 | 2): number => Math.round(mix(from[k], to[k], at - i));
  return [channel(0), channel(1), channel(2)];
}

/** The same as a CSS colour. */
export const speedColour = (share: number): string => `rgb(${speedRgb(share).join(' ')})`;

/** Cars shorter than this are models, whose speeds have a scale of their own [m]. */
const MODEL_CAR_M = 1.5;

/**
 * The upper end of the colour scale [m/s], round in the reader's unit. It depends on the size of the car only, so that
 * a colour means the same speed all the time; what is faster has the last colour.
 */
export const topOfScale = (bodyLength: number, { perMps, scaleTop, scaleTopOfModels }: SpeedUnit): number =>
  (bodyLength < MODEL_CAR_M ? scaleTopOfModels : scaleTop) / perMps;

/** The scale as a CSS gradient, for the legend. */
export const speedGradient = (): string =>
  `linear-gradient(to right, ${STOPS.map((c) => `rgb(${c.join(' ')})`).join(', ')})`;
