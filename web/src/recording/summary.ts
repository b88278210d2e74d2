import { hasBit } from '../lib/bits';
import { fixed, lapTime, plural } from '../lib/format';
import type { Severity } from '../lib/words';
import type { Change, Frame, Lap, Limit, Path, Run } from '../protocol/topics';
import { type Corner, cornersOf } from '../state/corners';
import { faultInWords } from '../state/event_log';
import { LapSamples, momentOf } from '../state/lap_samples';
import { bestsOf } from '../state/lap_table';
import { gapsToLimit } from '../state/limit';
import { complete } from '../state/message_fields';
import type { McapLog } from './mcap_log';

/** One run of a recording, in figures and traces. */
export interface RunReport {
  readonly name: string; // of the recording, with a number where it holds several runs
  readonly recording: string;
  readonly run: Run;
  readonly laps: readonly Lap[];
  readonly limit: Limit | null;
  readonly duration: number; // [s]
  readonly offTrackEvents: number;
  readonly interventions: number; // times another than the controller drove
  readonly gated: number; // times the gate changed a command
  readonly faults: readonly { readonly name: string; readonly time: number }[];
  readonly changes: readonly { readonly name: string; readonly value: string; readonly time: number }[];
  readonly trace: Trace;
  readonly settings: string; // the scenario as YAML; empty where the recording has none
  readonly samples: LapSamples;
  readonly corners: readonly Corner[];
}

export interface Trace {
  readonly time: number[]; // [s]
  readonly speed: number[]; // [m/s]
  readonly error: number[]; // lateral [m]
  readonly x: number[];
  readonly y: number[];
  readonly isBad: boolean[]; // off the road
}

type Draft = { -readonly [K in keyof RunReport]: RunReport[K] } & {
  laps: Lap[];
  faults: { name: string; time: number }[];
  changes: { name: string; value: string; time: number }[];
};

const begin = (run: Run): Draft => ({
  name: '',
  recording: '',
  run,
  laps: [],
  limit: null,
  duration: 0,
  offTrackEvents: 0,
  interventions: 0,
  gated: 0,
  faults: [],
  changes: [],
  trace: { time: [], speed: [], error: [], x: [], y: [], isBad: [] },
  settings: '',
  samples: new LapSamples(),
  corners: [],
});

function addFrame(draft: Draft, frame: Frame, before: Frame | null): void {
  const { trace } = draft;
  draft.duration = Math.max(draft.duration, frame.time_s);
  draft.offTrackEvents = Math.max(draft.offTrackEvents, frame.off_track_events);
  if (frame.rung > 0 && (before?.rung ?? 0) === 0) ++draft.interventions;
  if (frame.is_gated && !before?.is_gated) ++draft.gated;
  const begun = frame.active_faults & ~(before?.active_faults ?? 0);
  for (let bit = 0; bit < 32; ++bit)
    if (hasBit(begun, bit))
      draft.faults.push({ name: faultInWords(draft.run.fault_names[bit] ?? `#${bit + 1}`), time: frame.time_s });
  trace.time.push(frame.time_s);
  trace.speed.push(frame.speed_mps);
  trace.error.push(frame.lateral_error_m);
  trace.x.push(frame.x_m);
  trace.y.push(frame.y_m);
  trace.isBad.push(frame.is_off_track);
  draft.samples.setLength(draft.run.track_length_m);
  draft.samples.push(frame.lap, momentOf(frame), frame.last_lap_time_s);
}

/** The runs of a recording: another one begins where time goes back or another track, car or controller is told. */
export async function reportsOf(log: McapLog): Promise<RunReport[]> {
  const runs: Draft[] = [];
  let last: Frame | null = null;
  let known: Run | null = null;
  let limit: Limit | null = null;
  let corners: readonly Corner[] = [];
  const draft = (): Draft | undefined => runs.at(-1);
  const messages = log.messages(
    ['/chicane/run', '/chicane/frame', '/chicane/lap', '/chicane/change', '/chicane/limit', '/track/centre'],
    0,
    log.duration,
  );
  for await (const { topic, message } of messages) {
    if (topic === '/chicane/run') {
      known = complete('/chicane/run', message as Run);
      if (last !== null) limit = null;
      last = null;
    } else if (topic === '/chicane/limit') {
      const told = complete('/chicane/limit', message as Limit);
      limit = told.is_known ? told : null;
      const now = draft();
      if (now && last !== null) now.limit = limit;
    } else if (topic === '/chicane/frame') {
      const frame = complete('/chicane/frame', message as Frame);
      if (known && (last === null || frame.time_s < last.time_s)) {
        runs.push({ ...begin(known), limit, corners });
        last = null;
      }
      const now = draft();
      if (now) addFrame(now, frame, last);
      last = frame;
    } else if (topic === '/chicane/lap') {
      const lap = complete('/chicane/lap', message as Lap);
      draft()?.laps.push(lap);
      draft()?.samples.complete(lap.lap - 1, lap.lap_time_s); // after the last lap no frame says so
    } else if (topic === '/track/centre') {
      corners = cornersOf((message as Path).poses.map(({ pose }) => pose.position));
      const now = draft();
      if (now && last !== null) now.corners = corners;
    } else if (topic === '/chicane/change') {
      const { name, value, stamp } = message as Change;
      if (!/^(manual|fault)\./.test(name)) draft()?.changes.push({ name, value, time: stamp.sec + stamp.nsec / 1e9 });
    }
  }
  const settings = await log.settings();
  return runs.map((each, i) => ({
    ...each,
    settings: i === 0 ? settings : '',
    recording: log.name,
    name: runs.length > 1 ? `${log.name}, run ${i + 1}` : log.name,
  }));
}

/** The verdict on a run in one sentence, and how severe it is. */
export function verdictOf(report: RunReport): { severity: Severity; text: string } {
  const { laps, offTrackEvents, interventions, faults } = report;
  const bests = bestsOf(laps);
  const best = laps.find(({ lap }) => lap === bests.lap);
  const gap = best ? gapsToLimit(best, report.limit).lap : NaN;
  const parts = [
    laps.length > 0
      ? `${plural(laps.length, 'lap')}, the best in ${lapTime(bests.time, 3)}` +
        (Number.isFinite(gap) ? `, ${fixed(gap, 1)} % above the limit` : '')
      : 'no lap was completed',
    offTrackEvents === 0 ? 'never off the road' : `off the road ${plural(offTrackEvents, 'time')}`,
    interventions === 0
      ? 'the controller drove all the time'
      : `another than the controller drove ${plural(interventions, 'time')}`,
    faults.length > 0 ? `with ${plural(faults.length, 'fault')}` : '',
  ].filter(Boolean);
  const text = parts.join('; ');
  return {
    severity: offTrackEvents > 0 ? 'bad' : laps.length === 0 || interventions > 0 ? 'warning' : 'good',
    text: `${text[0]?.toUpperCase()}${text.slice(1)}.`,
  };
}
