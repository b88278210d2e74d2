// Laps as functions of the distance along the road, sampled from frames.
import { mix, mod } from '../lib/math';
import type { Frame } from '../protocol/topics';
import { LONGEST_SILENCE_S } from './silence';

/** Channels of a lap, sampled at equal distances along the road, and their values in a frame. */
const CHANNELS = {
  time_s: (frame: Frame) => frame.lap_time_s,
  speed_mps: (frame: Frame) => frame.speed_mps,
  lateral_error_m: (frame: Frame) => frame.lateral_error_m,
  steer_rad: (frame: Frame) => frame.steer_applied_rad,
  throttle: (frame: Frame) => frame.throttle_applied,
  x_m: (frame: Frame) => frame.x_m,
  y_m: (frame: Frame) => frame.y_m,
  grip: (frame: Frame) => Math.max(frame.front_tire_use, frame.rear_tire_use),
  step_time_us: (frame: Frame) => frame.step_time_us,
  iterations: (frame: Frame) => frame.iterations,
  cost: (frame: Frame) => frame.cost,
  delay_s: (frame: Frame) => frame.delay_s,
  prediction_error_m: (frame: Frame) => frame.prediction_error_m,
} as const;
export type LapChannel = keyof typeof CHANNELS;
export const LAP_CHANNELS = Object.keys(CHANNELS) as readonly LapChannel[];

/** A sample of a lap; `s_m` is measured along the centre line, whose origin need not be the start line. */
export type LapMoment = Readonly<Record<LapChannel, number>> & { readonly s_m: number };

/** A sample of which nothing is known. */
export const UNKNOWN_MOMENT = Object.fromEntries(['s_m', ...LAP_CHANNELS].map((name) => [name, NaN])) as LapMoment;

/** The sample that a frame gives of its lap. */
export function momentOf(frame: Frame): LapMoment {
  const moment = { s_m: frame.s_m } as Record<LapChannel | 's_m', number>;
  for (const name of LAP_CHANNELS) moment[name] = CHANNELS[name](frame);
  return moment;
}

/** Points of a lap: one every few metres of road; chosen. */
const POINTS = 1000;
/** Number of laps that are kept, beside the best one; chosen. */
export const KEPT_LAPS = 16;

/** Memory of one lap. */
interface Slot {
  lap: number; // -1: free
  isComplete: boolean;
  time: number; // of the completed lap [s]
  readonly channels: Readonly<Record<LapChannel, Float64Array>>;
}

/** All channels, interpolated linearly between two samples. */
function between(from: LapMoment, to: LapMoment, share: number): LapMoment {
  const moment = { s_m: mix(from.s_m, to.s_m, share) } as Record<LapChannel | 's_m', number>;
  for (const name of LAP_CHANNELS) moment[name] = mix(from[name], to[name], share);
  return moment;
}

/**
 * Laps as functions of the distance along the road, in fixed memory: the newest ones and the fastest. Between two
 * frames every channel is interpolated linearly in s, unless frames are missing in between: a stretch without data
 * stays unknown. The start line is where the lap count changes.
 */
export class LapSamples {
  readonly points = POINTS;
  /** How many laps have been completed here so far. */
  completed = 0;
  readonly #slots: Slot[];
  #length = NaN; // of the road [m]
  #line = NaN; // where laps begin; not-a-number: not known yet [m]
  #current: Slot | null = null; // of the lap that is driven now
  #last: (LapMoment & { lap: number }) | null = null; // newest sample

  constructor(kept = KEPT_LAPS) {
    const channels = () =>
      Object.fromEntries(LAP_CHANNELS.map((name) => [name, new Float64Array(POINTS)])) as Slot['channels'];
    this.#slots = Array.from({ length: kept + 2 }, () => ({
      lap: -1,
      isComplete: false,
      time: NaN,
      channels: channels(),
    }));
  }

  clear(): void {
    for (const slot of this.#slots) slot.lap = -1;
    this.#current = null;
    this.#last = null;
    this.#line = NaN;
  }

  /** Sets the length of the road; another length clears all laps. */
  setLength(length: number): void {
    if (Object.is(length, this.#length)) return;
    this.clear();
    this.#length = length;
  }

  /** Where laps begin, along the centre line from its first point [m]; 0 before any lap has begun. */
  get line(): number {
    return this.#line || 0;
  }

  /** Length of the road [m]; not-a-number before it is known. */
  get length(): number {
    return this.#length;
  }

  /** Distance of a point from the start line along the road [m]. */
  s(point: number): number {
    return (this.#firstPoint + point) * this.#spacing - this.#line;
  }

  /** Distance of a point along the centre line, from its origin [m]. */
  place(point: number): number {
    return index(this.#firstPoint + point) * this.#spacing;
  }

  /** Numbers of the complete laps, ascending. */
  get laps(): number[] {
    return this.#done.map((slot) => slot.lap).sort((a, b) => a - b);
  }

  /** The fastest lap that is kept; −1 without any. */
  get best(): number {
    return this.#done.reduce<Slot | null>((a, b) => (a && a.time <= b.time ? a : b), null)?.lap ?? -1;
  }

  /** A channel of a lap at a distance along the road, linear between points; NaN where unknown. */
  at(lap: number, name: LapChannel, s: number): number {
    const slot = this.#done.find((each) => each.lap === lap);
    if (!slot || !Number.isFinite(s)) return NaN;
    const place = s / this.#spacing;
    const values = slot.channels;
    const [below, above] = [index(Math.floor(place)), index(Math.floor(place) + 1)];
    const isOverTheLine = (values.time_s[above] ?? NaN) < (values.time_s[below] ?? NaN);
    return isOverTheLine ? NaN : mix(values[name][below] ?? NaN, values[name][above] ?? NaN, place - Math.floor(place));
  }

  /**
   * A channel of a lap from the start line on; null when that lap is not kept. NaN where the lap has no data.
   */
  channel(lap: number, name: LapChannel): Float64Array | null {
    const values = this.#done.find((slot) => slot.lap === lap)?.channels[name];
    if (!values) return null;
    return rotated(values, index(this.#firstPoint));
  }

  /** A channel of the lap that is driven now, from the start line on, NaN ahead of the car; null before any. */
  present(name: LapChannel): Float64Array | null {
    const slot = this.#current;
    if (!slot || !(this.#length > 0)) return null;
    return rotated(slot.channels[name], Number.isFinite(this.#line) ? index(this.#firstPoint) : 0);
  }

  /** Adds a sample; `lap` counts completed laps, `lastLapTime` is the time of the lap before [s]. */
  push(lap: number, moment: LapMoment, lastLapTime: number): void {
    if (!(this.#length > 0) || !Number.isFinite(moment.s_m)) return;
    const last = this.#last;
    this.#last = { ...moment, lap };
    if (last?.lap === lap) {
      if (moment.time_s - last.time_s <= LONGEST_SILENCE_S) this.#fill(last, this.#after(last, moment));
      return;
    }
    // A run begins on the start line.
    if (!last && lap === 0 && moment.time_s <= LONGEST_SILENCE_S) this.#line = mod(moment.s_m, this.#length);
    if (last && this.#current && lap === last.lap + 1) this.#cross(last, this.#after(last, moment), lap, lastLapTime);
    else this.#drop(lap);
  }

  /** Closes a lap with its lap time [s], for the end of a recording, which has no frame beyond the line. */
  complete(lap: number, time: number): void {
    const slot = this.#current;
    const last = this.#last;
    if (slot?.lap !== lap || slot.isComplete || last?.lap !== lap) return;
    const rest = time - last.time_s;
    if (!(rest >= 0 && rest <= LONGEST_SILENCE_S)) return; // a lap of another run with the same number
    if (!Number.isFinite(this.#line)) this.#line = mod(last.s_m + last.speed_mps * rest, this.#length);
    this.#fill(last, this.#after(last, { ...last, s_m: this.#line, time_s: time }));
    slot.isComplete = true;
    slot.time = time;
    ++this.completed;
  }

  /** Slots of complete laps. */
  get #done(): Slot[] {
    return this.#slots.filter((slot) => slot.lap >= 0 && slot.isComplete);
  }

  /** Distance between points [m]. */
  get #spacing(): number {
    return this.#length / POINTS;
  }

  /** The first point behind the start line. */
  get #firstPoint(): number {
    return Math.ceil(this.#line / this.#spacing - 1e-9);
  }

  /** The same sample with s unwrapped relative to an earlier sample. */
  #after(before: LapMoment, moment: LapMoment): LapMoment {
    const step = moment.s_m - before.s_m;
    return { ...moment, s_m: before.s_m + step - this.#length * Math.round(step / this.#length) };
  }

  /** Ends the old lap and begins the new one on the start line, which lies between two frames. */
  #cross(last: LapMoment, moment: LapMoment, lap: number, lastLapTime: number): void {
    const rest = lastLapTime - last.time_s; // of the old lap [s]
    const isHeard = rest + moment.time_s <= LONGEST_SILENCE_S;
    if (!isHeard && !Number.isFinite(this.#line)) {
      this.#drop(lap); // the position of the line is unknown
      return;
    }
    const line = between(last, moment, Math.min(1, Math.max(0, rest / (rest + moment.time_s))));
    if (!Number.isFinite(this.#line)) this.#line = mod(line.s_m, this.#length);
    // Each crossing is found a little elsewhere: the first point belongs to the new lap, whatever this one says.
    const first = this.#after(last, { ...line, s_m: this.#firstPoint * this.#spacing }).s_m;
    if (isHeard) this.#fill(last, { ...line, time_s: lastLapTime }, -Infinity, first);
    if (this.#current) {
      if (!this.#current.isComplete) ++this.completed;
      this.#current.isComplete = true;
      this.#current.time = lastLapTime;
    }
    this.#begin(lap);
    if (isHeard) this.#fill({ ...line, time_s: 0 }, moment, first);
  }

  /** Discards the lap in progress, which will not be complete. */
  #drop(next: number): void {
    if (this.#current && !this.#current.isComplete) this.#current.lap = -1;
    this.#begin(next);
  }

  /** Begins a lap in a free slot, or in that of the oldest lap. */
  #begin(lap: number): void {
    const slot = this.#slots.find((each) => each.lap < 0) ?? this.#oldest();
    slot.lap = lap;
    slot.isComplete = false;
    slot.time = NaN;
    for (const name of LAP_CHANNELS) slot.channels[name].fill(NaN);
    this.#current = slot;
  }

  /** The oldest lap except for the fastest. */
  #oldest(): Slot {
    const { best } = this;
    return this.#done.filter((slot) => slot.lap !== best).reduce((a, b) => (b.lap < a.lap ? b : a));
  }

  /** Fills the points between two samples, of those from `first` to before `end` [m]. */
  #fill(from: LapMoment, to: LapMoment, first = -Infinity, end = Infinity): void {
    const slot = this.#current;
    const span = to.s_m - from.s_m;
    if (!slot || !(span > 0)) return;
    const [begin, stop] = [Math.max(from.s_m, first), Math.min(to.s_m, end)];
    for (let point = Math.ceil(begin / this.#spacing - 1e-9); point * this.#spacing < stop - 1e-9; ++point) {
      const share = (point * this.#spacing - from.s_m) / span;
      for (const name of LAP_CHANNELS) slot.channels[name][index(point)] = mix(from[name], to[name], share);
    }
  }
}

/** The index of a point, wrapped to one lap. */
const index = (point: number): number => mod(point, POINTS);

/** The same values from the point `first` on. */
function rotated(values: Float64Array, first: number): Float64Array {
  const turned = new Float64Array(POINTS);
  turned.set(values.subarray(first));
  turned.set(values.subarray(0, first), POINTS - first);
  return turned;
}
