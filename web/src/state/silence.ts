/**
 * Between frames further apart than this, in time of the run, nothing is drawn or interpolated [s].
 */
export const LONGEST_SILENCE_S = 1;
