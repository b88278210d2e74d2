// What the map shows on the road and beside it.

/** A corner on the map; places along the centre line [m]. */
export interface MarkedCorner {
  readonly number: number;
  readonly from: number;
  readonly to: number;
  readonly apex: number;
  readonly turn: number; // [rad], left positive
}

/** The driven line of a lap in pieces, with what was lost on each [s]. */
export interface Losses {
  readonly line: { readonly x: ArrayLike<number>; readonly y: ArrayLike<number> }; // in W [m]
  readonly pieces: readonly { readonly first: number; readonly end: number; readonly lost: number }[];
  /** The end of the colour scale [s]. */
  readonly most: number;
}
