import { persisted } from '../lib/persisted';

/** Lines over the road that a reader may want or not; kept by the browser. */
export const layers = {
  /** The plan of a second ago, beside what came of it. */
  hindsight: persisted<boolean>('layer.hindsight', false),
  /** The line of the fastest lap possible. */
  racingLine: persisted<boolean>('layer.racing-line', true),
} as const;

export type Layer = keyof typeof layers;

export function toggleLayer(layer: Layer): void {
  layers[layer].value = !layers[layer].value;
}
