/** Length of the car for which the widths of marks and lines are meant [m]. */
const FULL_LENGTH_M = 4.5;
/** Length below which a car is a model car, on a road of its size [m]; chosen. */
const SMALL_M = 2;

/** Scale of lines, marks and paint on the road: 1 for full-size cars, less for model cars. */
export const paintSize = ({ body_length_m: length }: { readonly body_length_m: number }): number =>
  length > 0 && length < SMALL_M ? length / FULL_LENGTH_M : 1;
