// What the map shows on the road and beside it.
import type { Corner } from './corners';

/** A corner on the map, with its number from the start line on. */
export interface MarkedCorner extends Corner {
  readonly number: number;
}

/** The driven line of a lap in pieces, with what was lost on each [s]. */
export interface Losses {
  readonly line: { readonly x: ArrayLike<number>; readonly y: ArrayLike<number> }; // in W [m]
  readonly pieces: readonly { readonly first: number; readonly end: number; readonly lost: number }[];
  /** The end of the colour scale [s]. */
  readonly most: number;
}
