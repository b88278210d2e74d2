import { persisted } from '../lib/persisted';

/** Optional lines over the road; the choice is kept in the browser's storage. */
export const layers = {
  /** The plan of a second ago and the path driven since. */
  hindsight: persisted<boolean>('layer.hindsight', false),
  /** The racing line: that of the fastest possible lap. */
  racingLine: persisted<boolean>('layer.racing-line', true),
} as const;

export type Layer = keyof typeof layers;

export function toggleLayer(layer: Layer): void {
  layers[layer].value = !layers[layer].value;
}
