// Answer of GET /rival.json, a race of two settings (docs/viewer.md): A is the run's own car, B the rival.
import { fixed } from '../lib/format';
import { columns, fields, list, number, text } from '../lib/json';
import { mod } from '../lib/math';
import { type LapSamples, UNKNOWN_MOMENT } from './lap_samples';

/** Difference of lap times below which nobody wins [s]; chosen. */
const SAME_S = 0.005;

/** Columns of B's poses: time of the race, place in the world, and distance driven since the start. */
export const POSE_COLUMNS = ['time_s', 'x_m', 'y_m', 'yaw_rad', 'steer_rad', 'speed_mps', 'distance_m'] as const;
export type RacePoses = Readonly<Record<(typeof POSE_COLUMNS)[number], readonly number[]>>;

export type Race = Readonly<ReturnType<typeof readRace>>;

/** Reads the laps of one car. */
const readLaps = (value: unknown) =>
  list(value)
    .map(fields)
    .map((each) => ({ lap: number(each.lap), time: number(each.lap_time_s), isClean: each.is_clean === true }));

const STATES = ['none', 'building', 'racing', 'ended', 'failed'] as const;

/** Race in a parsed /rival.json: the laps of both cars, and the newest poses of B. */
export function readRace(json: unknown) {
  const all = fields(json);
  return {
    id: number(all.id),
    state: STATES.find((state) => state === all.state) ?? 'none',
    why: text(all.why),
    a: readLaps(all.run),
    b: readLaps(all.rival),
    poses: columns(all.trace, POSE_COLUMNS),
  };
}

/**
 * Adds the poses of B that are newer than `since` [s] to `samples`, in which laps begin at `line` [m] along the road.
 * Returns the time of the newest pose [s].
 */
export function sampleRace(samples: LapSamples, { b, poses }: Race, line: number, since: number): number {
  const ends: number[] = [0]; // times at which B's laps end, from the start on
  for (const { time } of b) ends.push((ends.at(-1) ?? 0) + time);
  if (b.length > 0 && b[0]?.lap !== 1) return since; // without the first laps, the start of these is not known
  let newest = since;
  poses.time_s.forEach((time, row) => {
    if (!(time > newest)) return;
    newest = time;
    let lap = 0;
    while (lap + 1 < ends.length && time >= (ends[lap + 1] ?? Infinity)) ++lap;
    const at = (name: keyof RacePoses): number => poses[name][row] ?? NaN;
    const moment = {
      ...UNKNOWN_MOMENT,
      s_m: mod(line + at('distance_m'), samples.length),
      time_s: time - (ends[lap] ?? 0),
      speed_mps: at('speed_mps'),
      steer_rad: at('steer_rad'),
      x_m: at('x_m'),
      y_m: at('y_m'),
    };
    samples.push(lap, moment, b[lap - 1]?.time ?? 0);
  });
  return newest;
}

/** Winner of the newest lap that both cars have driven, and a sentence about it; no winner within SAME_S. */
export function standingOf({ a, b }: Race): { readonly winner: 'A' | 'B' | null; readonly text: string } {
  const other = [...b].reverse().find(({ lap }) => a.some((own) => own.lap === lap));
  const own = a.find(({ lap }) => lap === other?.lap);
  if (!own || !other) return { winner: null, text: 'No lap is driven by both yet.' };
  const gap = other.time - own.time;
  if (Math.abs(gap) < SAME_S) return { winner: null, text: `Lap ${own.lap}: as fast as each other.` };
  const [winner, best] = gap < 0 ? (['B', other] as const) : (['A', own] as const);
  const how = best.isClean ? '' : ', off the road';
  return { winner, text: `Lap ${own.lap}: ${winner} is ${fixed(Math.abs(gap), 3)} s faster${how}.` };
}
