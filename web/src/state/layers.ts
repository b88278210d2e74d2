// Optional lines over the road, which the user switches on and off.
import { persisted } from '../lib/persisted';

/** The layers, true if drawn; the browser's storage keeps the choice. */
export const layers = {
  /** Plan of a second ago, and the path driven since (hindsight.ts). */
  hindsight: persisted<boolean>('layer.hindsight', false),
  /** Racing line of the fastest possible lap. */
  racingLine: persisted<boolean>('layer.racing-line', true),
} as const;

export type Layer = keyof typeof layers;

/** Switches a layer. */
export function toggleLayer(layer: Layer): void {
  layers[layer].value = !layers[layer].value;
}
