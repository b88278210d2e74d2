// Dimensions, colours and surfaces that the bodies of cars share.
import { colourOf, type MeshBuilder } from './mesh';

/** Colours of the parts of cars; chosen. */
export const WHITE = colourOf('#f1f3f7');
export const ACCENT = colourOf('#2158c9');
export const CARBON = colourOf('#2a313a');
export const SOOT = colourOf('#171b20');
export const RUBBER = colourOf('#23262b');
export const METAL = colourOf('#aab3bf');
export const GLASS = colourOf('#1d2732');
export const LAMP = colourOf('#ff2a1c');
export const LIGHT = colourOf('#fff4d8');

/** The dimensions that the parts are built from [m]. */
export interface Measures {
  readonly k: number; // scale: 1 for a car of 4.5 m
  readonly front: number; // axles, and ends of the body
  readonly rear: number;
  readonly nose: number;
  readonly tail: number;
  readonly radius: number; // of the wheels
  readonly tyre: number; // width
  readonly halfTrack: number;
  readonly halfWidth: number;
  readonly inner: number; // half the room between the wheels
  readonly tub: number; // half widths
  readonly pod: number;
  readonly length: number;
  /** Along the car: 0 at the rear axle, 1 at the front axle. */
  at(share: number): number;
}

/** Meshes under construction, one for each kind of surface. */
export interface Parts {
  readonly paint: MeshBuilder;
  readonly dark: MeshBuilder;
  readonly lamps: MeshBuilder;
  readonly headlamps: MeshBuilder;
}
