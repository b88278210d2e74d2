/** Time of the run between two frames beyond which nothing is drawn or interpolated between them [s]; chosen. */
export const LONGEST_SILENCE_S = 1;
