import type { MeshBuilder } from './mesh';

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
