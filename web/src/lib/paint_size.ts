/** Length of a car that marks and lines are drawn for in their own width [m]. */
const FULL_LENGTH_M = 4.5;
/** Shorter cars are model cars, on roads of their size [m]. */
const SMALL_M = 2;

/** Scale of lines, marks and paint on the road: 1 for full-size cars, less for model cars. */
export const paintSize = ({ body_length_m: length }: { readonly body_length_m: number }): number =>
  length > 0 && length < SMALL_M ? length / FULL_LENGTH_M : 1;
