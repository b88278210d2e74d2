// Report of recordings: reads the JSON of src/chicane/recording/html_report.cpp, samples the laps along the road and
// words the result.
import { begunBits } from '../lib/bits';
import { fixed, lapTime, plural } from '../lib/format';
import { capital } from '../lib/words';
import { UNKNOWN_CHANGE, UNKNOWN_FRAME, UNKNOWN_LAP, UNKNOWN_LIMIT, UNKNOWN_RUN } from '../protocol/messages';
import type { Change, Frame, Lap } from '../protocol/topics';
import { type Comparison, type Course, compare } from '../state/comparison';
import { cornersOf } from '../state/corners';
import { lapCourse, limitCourse, recordedCourse } from '../state/courses';
import { faultInWords } from '../state/event_log';
import { LapSamples, momentOf } from '../state/lap_samples';
import { shortly } from '../state/lap_setup';
import { bestOf } from '../state/lap_table';
import { isSameRoad } from '../state/other_laps';

/** Fields of a message, each as a list. */
type Lists = Readonly<Record<string, readonly (number | string | null)[]>>;

/** A report of recordings. */
export interface RunsDocument {
  readonly kind: 'runs';
  readonly logs: readonly {
    readonly name: string;
    readonly settings: string; // the scenario as YAML; empty where the recording has none
    readonly runs: readonly DrivenRun[];
  }[];
}

/** A run of a recording: its messages, and its frames as columns. */
interface DrivenRun {
  readonly run: Lists | null;
  readonly limit: Lists | null;
  readonly laps: readonly Lists[];
  readonly changes: readonly Lists[];
  readonly centre: Lists | null;
  readonly frames: Lists; // a list for each column
  readonly steps?: Readonly<Record<'count' | 'p50_us' | 'p99_us' | 'longest_us' | 'mean_iterations', number>>;
}

/** A message from lists, one for each of its fields; missing fields are as in `unknown`. */
function messageOf<T extends object>(unknown: T, lists: Lists): T {
  const numbers = (name: string): number[] =>
    (lists[name] ?? []).map((each) => (typeof each === 'number' ? each : NaN));
  const fields = Object.entries(unknown).map(([name, value]) => {
    if (!(name in lists)) return [name, value];
    if (value instanceof Float64Array) return [name, Float64Array.from(numbers(name))];
    if (Array.isArray(value)) return [name, (lists[name] ?? []).map(String)];
    if (typeof value === 'boolean') return [name, numbers(name)[0] === 1];
    if (typeof value === 'string') return [name, String(lists[name]?.[0] ?? '')];
    return [name, numbers(name)[0] ?? NaN];
  });
  return { ...unknown, ...Object.fromEntries(fields) } as T;
}

/** One run of a recording. */
export type ReportedRun = Readonly<ReturnType<typeof readRun>>;

/** Frames from a list for each of their columns. */
function framesOf(columns: Lists): Frame[] {
  const names = Object.keys(columns);
  return (columns.time_s ?? []).map((_, row) => {
    const frame: Record<string, unknown> = { ...UNKNOWN_FRAME };
    for (const name of names) frame[name] = columns[name]?.[row] ?? NaN;
    return frame as unknown as Frame;
  });
}

/** Reads one run; `name` is that of the recording, with a number where it holds several runs. */
function readRun(driven: DrivenRun, name: string, recording: string, settings: string) {
  const run = messageOf(UNKNOWN_RUN, driven.run ?? {});
  const laps = driven.laps.map((each) => messageOf(UNKNOWN_LAP, each));
  const frames = framesOf(driven.frames);
  const samples = new LapSamples();
  samples.setLength(run.track_length_m);
  const faults: string[] = [];
  let [offTrack, interventions, gated] = [0, 0, 0];
  let before: Frame | null = null;
  for (const frame of frames) {
    samples.push(frame.lap, momentOf(frame), frame.last_lap_time_s);
    offTrack = Math.max(offTrack, frame.off_track_events);
    if (frame.rung > 0 && !((before?.rung ?? 0) > 0)) ++interventions;
    if (frame.is_gated && !before?.is_gated) ++gated;
    for (const bit of begunBits(frame.active_faults, before?.active_faults))
      faults.push(`${faultInWords(run.fault_names[bit] ?? `#${bit + 1}`)} at ${fixed(frame.time_s, 1)} s`);
    before = frame;
  }
  for (const { lap, lap_time_s: time } of laps) samples.complete(lap - 1, time);
  const changes = driven.changes.flatMap((each) => {
    const { name: key, value }: Change = messageOf({ ...UNKNOWN_CHANGE }, each);
    const seconds = Number(each['stamp.sec']?.[0] ?? NaN) + Number(each['stamp.nanosec']?.[0] ?? 0) / 1e9;
    return /^(manual|fault)\./.test(key) ? [] : [`${key} = ${shortly(value)} at ${fixed(seconds, 1)} s`];
  });
  const [xs, ys] = [driven.centre?.x_m ?? [], driven.centre?.y_m ?? []];
  return {
    name,
    recording,
    run,
    laps,
    limit: driven.limit && messageOf(UNKNOWN_LIMIT, driven.limit),
    samples,
    corners: cornersOf(xs.map((x, i) => ({ x: Number(x), y: Number(ys[i]) }))),
    duration: before?.time_s ?? 0, // [s]
    offTrack, // times
    interventions, // times another than the controller drove
    gated, // times the gate changed a command
    leastEdge: Math.min(...laps.map(({ min_edge_distance_m: edge }) => edge)), // of all laps [m]
    faults, // "blind at 12.5 s"
    changes, // "latency_ms = 60 at 3.0 s"
    steps: driven.steps,
    settings,
  };
}

/** All runs of all recordings, with their laps sampled along the road. */
export const readRuns = ({ logs }: RunsDocument): ReportedRun[] =>
  logs.flatMap(({ name, settings, runs }) =>
    runs.map((run, i) => readRun(run, runs.length > 1 ? `${name}, run ${i + 1}` : name, name, i === 0 ? settings : '')),
  );

/** What can be compared: the laps and the limit of the first run, and the laps of others on its road. */
export function coursesOf([first, ...others]: readonly ReportedRun[]): Course[] {
  if (!first) return [];
  const { samples, laps, limit } = first;
  const isKnown = ({ lap }: Lap, of: LapSamples): boolean => of.laps.includes(lap - 1);
  return [
    ...laps.filter((lap) => isKnown(lap, samples)).map((lap) => lapCourse(lap, samples)),
    ...others
      .filter((other) => isSameRoad(other.samples, samples))
      .flatMap((other) =>
        other.laps
          .filter((lap) => isKnown(lap, other.samples))
          .map(({ lap, lap_time_s: time }) =>
            recordedCourse({ recording: other.name, lap, time, samples: other.samples }, samples),
          ),
      ),
    ...(limit ? [limitCourse(limit, samples)] : []),
  ];
}

/** A and B at first: the best lap against the best of another run, the limit, or the next best lap. */
export function firstPair(runs: readonly ReportedRun[], courses: readonly Course[]): [Course, Course] | null {
  const idOfBest = (laps: readonly Lap[]): string => `lap ${bestOf(laps)?.lap}`;
  const own = runs[0]?.laps ?? [];
  const find = (id: string): Course | undefined => courses.find((each) => each.id === id);
  const a = find(idOfBest(own));
  const rest = own.filter(({ lap }) => `lap ${lap}` !== a?.id);
  const b =
    runs
      .slice(1)
      .map(({ name, laps }) => find(`${idOfBest(laps)} of ${name}`))
      .find(Boolean) ??
    find('limit') ??
    find(idOfBest(rest));
  return a && b ? [a, b] : null;
}

/** A against B on the road of a run. */
export const compareIn = ({ samples, corners }: ReportedRun, a: Course, b: Course): Comparison | null =>
  compare(a, b, { samples, corners, line: samples.line });

/** Numbers up to twelve in words. */
const COUNTS = 'no one two three four five six seven eight nine ten eleven twelve'.split(' ');
const counted = (count: number, noun: string): string =>
  `${COUNTS[count] ?? count} ${plural(count, noun).replace(/^\d+ /, '')}`;

/** "Four clean laps of lakeside. The best took 0:26.279, 3.45 s more than the limit.", in parts. */
export function verdictOf({ laps, run, limit }: ReportedRun): { text: string; time: string; behind: string } {
  const best = bestOf(laps);
  if (!best) return { text: `No lap of ${run.track} was completed.`, time: '', behind: '' };
  const isClean = laps.every(({ is_clean }) => is_clean);
  const text = `${capital(counted(laps.length, isClean ? 'clean lap' : 'lap'))} of ${run.track}. The best took `;
  const behind = limit && best.lap >= limit.first_lap ? best.lap_time_s - limit.lap_time_s : NaN;
  return { text, time: lapTime(best.lap_time_s, 3), behind: Number.isFinite(behind) ? `${fixed(behind, 2)} s` : '' };
}

/** Sentences below the verdict: car and controller, the edge of the road, interventions, faults and changes. */
export function leadOf({ run, offTrack, interventions, leastEdge, faults, changes, laps }: ReportedRun): string {
  const byHand = laps.some(({ by_hand_share: share }) => share > 0);
  const edge = Number.isFinite(leastEdge) ? `; the nearest was ${fixed(leastEdge, 2)} m from the edge` : '';
  return [
    `The ${run.car} by ${run.preset || run.controller}, ${fixed(run.latency_s * 1000, 0)} ms late.`,
    offTrack === 0 ? `No tyre left the road${edge}.` : `Off the road ${counted(offTrack, 'time')}.`,
    interventions > 0 ? `Another than the controller drove ${counted(interventions, 'time')}.` : '',
    faults.length > 0 ? `Faults: ${faults.join(', ')}.` : '',
    changes.length > 0 ? `Changed: ${changes.join(', ')}.` : '',
    faults.length + changes.length === 0 && !byHand ? 'No fault, no change, no hand on the wheel.' : '',
  ]
    .filter(Boolean)
    .join(' ');
}
