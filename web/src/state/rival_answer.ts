import { inSpeedUnit, speedUnit } from '../lib/units';

// A race of two settings, as GET /rival.json gives it (docs/viewer_laps.md): A is the run's own car, B the rival.

/** A lap of one car; each list has three values, one for each third. */
export interface RaceLap {
  readonly lap: number;
  readonly time: number; // [s]
  readonly sectors: readonly number[]; // [s]
  readonly isClean: boolean;
  readonly slowest: readonly number[]; // [m/s]
  readonly fastest: readonly number[]; // [m/s]
  readonly errors: readonly number[]; // largest, from the track's line [m]
}

export const POSE_COLUMNS = ['time_s', 'x_m', 'y_m', 'yaw_rad', 'steer_rad', 'speed_mps', 'distance_m'] as const;
export type Poses = Readonly<Record<(typeof POSE_COLUMNS)[number], readonly number[]>>;

export interface Race {
  readonly id: number;
  readonly state: 'none' | 'building' | 'racing' | 'ended' | 'failed';
  readonly why: string;
  readonly a: readonly RaceLap[];
  readonly b: readonly RaceLap[];
  /** The newest poses of B. */
  readonly poses: Poses;
}

type Fields = Readonly<Record<string, unknown>>;
const fields = (value: unknown): Fields => (typeof value === 'object' && value !== null ? (value as Fields) : {});
const list = (value: unknown): readonly unknown[] => (Array.isArray(value) ? value : []);
const number = (value: unknown): number => (typeof value === 'number' ? value : NaN);
const numbers = (value: unknown): readonly number[] => list(value).map(number);

const readLaps = (value: unknown): RaceLap[] =>
  list(value)
    .map(fields)
    .map((each) => ({
      lap: number(each.lap),
      time: number(each.lap_time_s),
      sectors: numbers(each.sector_times_s),
      isClean: each.is_clean === true,
      slowest: numbers(each.slowest_mps),
      fastest: numbers(each.fastest_mps),
      errors: numbers(each.largest_error_m),
    }));

const STATES: readonly Race['state'][] = ['none', 'building', 'racing', 'ended', 'failed'];

/** Reads a parsed /rival.json. */
export function readRace(json: unknown): Race {
  const all = fields(json);
  const trace = fields(all.trace);
  return {
    id: number(all.id),
    state: STATES.find((state) => state === all.state) ?? 'none',
    why: typeof all.why === 'string' ? all.why : '',
    a: readLaps(all.run),
    b: readLaps(all.rival),
    poses: Object.fromEntries(POSE_COLUMNS.map((name) => [name, numbers(trace[name])])) as unknown as Poses,
  };
}

/** One third of a lap that both have driven. */
export interface Third {
  readonly sector: number;
  /** How much later B was at its end than at its beginning, against A [s]; negative: B gained. */
  readonly gap: number;
  /** Why, in words. */
  readonly cause: string;
}

export interface LapGap {
  readonly lap: number;
  readonly a: number; // [s]
  readonly b: number; // [s]
  readonly thirds: readonly Third[];
}

const MENTIONED_MPS = 0.25;
const MENTIONED_M = 0.2;
const SAME_S = 0.005;

/** What B did otherwise in a third of a lap: where it was slowest and fastest, and how far from the line. */
export function causeOf(a: RaceLap, b: RaceLap, third: number): string {
  const unit = speedUnit();
  const difference = (name: 'slowest' | 'fastest' | 'errors'): number =>
    (b[name][third] ?? NaN) - (a[name][third] ?? NaN);
  const [slowest, fastest, errors] = [difference('slowest'), difference('fastest'), difference('errors')];
  const speed = (mps: number): string =>
    `${Math.abs(inSpeedUnit(mps)).toFixed(1)} ${unit.name} ${mps > 0 ? 'more' : 'less'}`;
  const parts = [
    Math.abs(slowest) >= MENTIONED_MPS ? `${speed(slowest)} where it is slowest` : '',
    Math.abs(fastest) >= MENTIONED_MPS ? `${speed(fastest)} at the top` : '',
    Math.abs(errors) >= MENTIONED_M
      ? `${Math.abs(errors).toFixed(1)} m ${errors > 0 ? 'farther from' : 'nearer to'} the line`
      : '',
  ].filter((part) => part !== '');
  const gap = (b.sectors[third] ?? NaN) - (a.sectors[third] ?? NaN);
  if (parts.length > 0) return parts.join(', ');
  return Math.abs(gap) < SAME_S ? 'the same' : 'another way at nearly the same speeds';
}

/** The laps that both have driven, the newest first. */
export function gapsOf({ a, b }: Race): LapGap[] {
  return b
    .flatMap((other) => {
      const own = a.find(({ lap }) => lap === other.lap);
      if (!own) return [];
      const thirds = [0, 1, 2].map((i) => ({
        sector: i + 1,
        gap: (other.sectors[i] ?? NaN) - (own.sectors[i] ?? NaN),
        cause: causeOf(own, other, i),
      }));
      return [{ lap: own.lap, a: own.time, b: other.time, thirds }];
    })
    .reverse();
}

/** Who is ahead, by the laps that both have driven and that are no standing start where there is another. */
export function verdictOf(race: Race): { readonly winner: 'A' | 'B' | null; readonly text: string } {
  const gaps = gapsOf(race);
  const newest = gaps[0];
  if (!newest) return { winner: null, text: 'No lap is driven by both yet.' };
  const gap = newest.b - newest.a;
  const isB = gap < 0;
  if (Math.abs(gap) < SAME_S) return { winner: null, text: `Lap ${newest.lap}: as fast as each other.` };
  const unclean = (isB ? race.b : race.a).find(({ lap }) => lap === newest.lap)?.isClean === false;
  const winner = isB ? 'B' : 'A';
  const how = unclean ? ', off the road' : '';
  return { winner, text: `Lap ${newest.lap}: ${winner} is ${Math.abs(gap).toFixed(3)} s faster${how}.` };
}
