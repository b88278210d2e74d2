/**
 * Between frames further apart than this, in the car's time, nobody knows what was: nothing is drawn or interpolated
 * [s].
 */
export const LONGEST_SILENCE_S = 1;
