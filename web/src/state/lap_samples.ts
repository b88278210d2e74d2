import { mix } from '../lib/math';

/** What is kept of a lap, at equal distances along the road. */
export const LAP_CHANNELS = ['time_s', 'speed_mps', 'lateral_error_m', 'steer_rad', 'throttle', 'x_m', 'y_m'] as const;
export type LapChannel = (typeof LAP_CHANNELS)[number];

/** One moment of a lap. */
export type LapMoment = Readonly<Record<LapChannel, number>> & { readonly s_m: number };

/** Every channel, linear from one moment to another. */
function between(from: LapMoment, to: LapMoment, share: number): LapMoment {
  const moment = { s_m: mix(from.s_m, to.s_m, share) } as Record<LapChannel | 's_m', number>;
  for (const name of LAP_CHANNELS) moment[name] = mix(from[name], to[name], share);
  return moment;
}

const POINTS = 1000;
const KEPT = 16; // laps beside the best

interface Slot {
  lap: number; // -1: free
  isComplete: boolean;
  time: number; // of the completed lap [s]
  readonly channels: Readonly<Record<LapChannel, Float64Array>>;
}

/**
 * Laps as functions of the distance along the road, in fixed memory: the newest ones and the fastest. Frames come at
 * equal times; between two of them everything is taken as linear in s.
 */
export class LapSamples {
  readonly points = POINTS;
  readonly #slots: Slot[];
  #length = NaN; // of the road [m]
  #current: Slot | null = null;
  #last: (LapMoment & { lap: number }) | null = null;
  #next = 0; // first point of the current lap not written yet

  constructor(kept = KEPT) {
    const channels = () => Object.fromEntries(LAP_CHANNELS.map((name) => [name, new Float64Array(POINTS)])) as Slot['channels'];
    this.#slots = Array.from({ length: kept + 2 }, () => ({ lap: -1, isComplete: false, time: NaN, channels: channels() }));
  }

  clear(): void {
    for (const slot of this.#slots) slot.lap = -1;
    this.#current = null;
    this.#last = null;
  }

  /** Another road: nothing of before can be compared. */
  setLength(length: number): void {
    if (Object.is(length, this.#length)) return;
    this.clear();
    this.#length = length;
  }

  /** Distance along the road of a point [m]. */
  s(point: number): number {
    return (point * this.#length) / (POINTS - 1);
  }

  /** Numbers of the laps that are kept whole, rising. */
  get laps(): number[] {
    return this.#slots
      .filter((slot) => slot.lap >= 0 && slot.isComplete)
      .map((slot) => slot.lap)
      .sort((a, b) => a - b);
  }

  /** The fastest lap that is kept; −1 without any. */
  get best(): number {
    const done = this.#slots.filter((slot) => slot.lap >= 0 && slot.isComplete);
    return done.reduce<Slot | null>((a, b) => (a && a.time <= b.time ? a : b), null)?.lap ?? -1;
  }

  /** A channel of a lap at a distance along the road, linear between points; not-a-number where it is not known. */
  at(lap: number, name: LapChannel, s: number): number {
    const values = this.channel(lap, name);
    const point = (s / this.#length) * (POINTS - 1);
    const below = Math.min(Math.floor(point), POINTS - 2);
    return values ? mix(values[below] ?? NaN, values[below + 1] ?? NaN, point - below) : NaN;
  }

  /** A channel of a lap; null when that lap is not kept. Points the lap did not pass are not-a-number. */
  channel(lap: number, name: LapChannel): Float64Array | null {
    return this.#slots.find((slot) => slot.lap === lap && slot.isComplete)?.channels[name] ?? null;
  }

  /** Takes one moment; `lap` counts completed laps, `lastLapTime` is of the lap before. */
  push(lap: number, moment: LapMoment, lastLapTime: number): void {
    if (!(this.#length > 0) || !Number.isFinite(moment.s_m)) return;
    if (this.#last?.lap !== lap) this.#turn(lap, moment, lastLapTime);
    else this.#fill(this.#last, moment);
    this.#last = { ...moment, lap };
  }

  #turn(lap: number, moment: LapMoment, lastLapTime: number): void {
    const last = this.#last;
    const crossed = this.#current !== null && last !== null && lap === last.lap + 1;
    if (!crossed) {
      if (this.#current && !this.#current.isComplete) this.#current.lap = -1;
      return this.#begin(lap);
    }
    // The line lies between two frames: the old lap ends, and the new one begins, on it.
    const rest = this.#length - last.s_m;
    const line = between(last, moment, rest / (rest + moment.s_m));
    this.#fill(last, { ...line, s_m: this.#length, time_s: lastLapTime });
    if (this.#current) {
      this.#current.isComplete = true;
      this.#current.time = lastLapTime;
    }
    this.#begin(lap);
    this.#fill({ ...line, s_m: 0, time_s: 0 }, moment);
  }

  #begin(lap: number): void {
    const slot = this.#slots.find((each) => each.lap < 0) ?? this.#oldest();
    slot.lap = lap;
    slot.isComplete = false;
    slot.time = NaN;
    for (const name of LAP_CHANNELS) slot.channels[name].fill(NaN);
    this.#current = slot;
    this.#next = 0;
  }

  /** The oldest lap but for the fastest. */
  #oldest(): Slot {
    const done = this.#slots.filter((slot) => slot.isComplete);
    const best = done.reduce((a, b) => (b.time < a.time ? b : a), done[0] as Slot);
    return done.filter((slot) => slot !== best).reduce((a, b) => (b.lap < a.lap ? b : a));
  }

  #fill(from: LapMoment, to: LapMoment): void {
    const slot = this.#current;
    const span = to.s_m - from.s_m;
    if (!slot || !(span > 0)) return;
    if (this.s(this.#next) < from.s_m) this.#next = Math.ceil((from.s_m / this.#length) * (POINTS - 1));
    for (; this.#next < POINTS && this.s(this.#next) <= to.s_m + 1e-9; ++this.#next) {
      const share = (this.s(this.#next) - from.s_m) / span;
      for (const name of LAP_CHANNELS) slot.channels[name][this.#next] = mix(from[name], to[name], share);
    }
  }
}

/** Time lost by lap `a` to lap `b` up to each point [s]: rising where `a` is slower. */
export const timeGap = (a: Float64Array, b: Float64Array): Float64Array => a.map((time, i) => time - (b[i] ?? NaN));
