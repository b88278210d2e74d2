// Levels of quality of the 3D picture, and their choice by the time that pictures take.

/** A level of quality. */
export interface Quality {
  readonly pixelRatio: number; // pixels drawn for each CSS pixel, at most
  readonly hasShadow: boolean;
  readonly interval: number; // least time between pictures [ms]
}

/** Levels of quality, from expensive to cheap; chosen. */
export const LEVELS: readonly Quality[] = [
  { pixelRatio: 2, hasShadow: true, interval: 0 },
  { pixelRatio: 1.5, hasShadow: true, interval: 0 },
  { pixelRatio: 1, hasShadow: true, interval: 0 },
  { pixelRatio: 1, hasShadow: false, interval: 0 },
  { pixelRatio: 0.75, hasShadow: false, interval: 30 },
  { pixelRatio: 0.6, hasShadow: false, interval: 40 },
  { pixelRatio: 0.5, hasShadow: false, interval: 50 },
];

/** Index of the first and most expensive level with software rendering. */
export const SOFTWARE_LEVEL = 4;

/**
 * Pictures that are judged together: WINDOW of them, or LEAST_WINDOW where those take longer than LONG_WINDOW_MS;
 * chosen.
 */
const WINDOW = 40;
const LONG_WINDOW_MS = 3000;
const LEAST_WINDOW = 8;
/** Multiples of the intended interval above which pictures are late, and below which they are on time; chosen. */
const LATE = 1.45;
const ON_TIME = 1.15;
/** Consecutive windows on time before a more expensive level is tried; chosen. */
const CALM_WINDOWS = 6;

/** Chooses the highest level at which pictures are on time, from the measured time between them. */
export class QualityGovernor {
  level: number;
  readonly #best: number; // level that is not exceeded
  #gaps: number[] = []; // times of this window [ms]
  #calm = 0; // consecutive windows on time
  #patience = CALM_WINDOWS; // windows on time before the next level is tried

  constructor(isSoftware: boolean) {
    this.level = isSoftware ? SOFTWARE_LEVEL : 0;
    this.#best = this.level;
  }

  get quality(): Quality {
    return LEVELS[this.level] as Quality;
  }

  /**
   * Takes the time since the last picture and the time drawing took on the main thread [ms]; true when the level
   * changed.
   */
  picture(gap: number, cost: number): boolean {
    if (!(gap > 0) || gap > 500) return false; // hidden, or just started
    this.#gaps.push(Math.max(gap, cost * 2)); // at most half of the main thread
    const isLong = this.#gaps.length >= LEAST_WINDOW && this.#gaps.reduce((a, b) => a + b) > LONG_WINDOW_MS;
    if (this.#gaps.length < WINDOW && !isLong) return false;
    const sorted = this.#gaps.sort((a, b) => a - b);
    const typical = sorted[Math.floor(sorted.length * 0.6)] ?? 0;
    this.#gaps = [];
    const meant = Math.max(this.quality.interval, 1000 / 60);
    if (typical > LATE * meant && this.level < LEVELS.length - 1) {
      this.#patience *= 2; // the higher level was too expensive: wait longer before trying it again
      this.#calm = 0;
      ++this.level;
      return true;
    }
    this.#calm = typical < ON_TIME * meant ? this.#calm + 1 : 0;
    if (this.#calm < this.#patience || this.level <= this.#best) return false;
    this.#calm = 0;
    --this.level;
    return true;
  }
}
