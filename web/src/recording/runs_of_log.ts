import { complete, type Frame, type Lap, type Run } from '../protocol/topics';
import { LapSamples, momentOf } from '../state/lap_samples';
import type { McapLog } from './mcap_log';

/** The laps of one run of a recording, along the road. */
export interface LoggedRun {
  readonly name: string; // of the recording, with a number where it holds several runs
  readonly recording: string;
  readonly run: Run;
  readonly laps: Lap[];
  readonly samples: LapSamples;
}

/** Runs of a recording: another one begins where time goes back, or a run is described anew. */
export async function runsOf(log: McapLog): Promise<LoggedRun[]> {
  const runs: Omit<LoggedRun, 'name' | 'recording'>[] = [];
  let last: Frame | null = null;
  let known: Run | null = null;
  const messages = log.messages(['/chicane/run', '/chicane/frame', '/chicane/lap'], 0, log.duration);
  for await (const { topic, message } of messages) {
    if (topic === '/chicane/run') {
      known = complete('/chicane/run', message as Run);
      last = null;
    } else if (topic === '/chicane/frame') {
      const frame = complete('/chicane/frame', message as Frame);
      if (known && (last === null || frame.time_s < last.time_s)) {
        runs.push({ run: known, laps: [], samples: new LapSamples() });
        runs.at(-1)?.samples.setLength(known.track_length_m);
      }
      runs.at(-1)?.samples.push(frame.lap, momentOf(frame), frame.last_lap_time_s);
      last = frame;
    } else {
      const lap = complete('/chicane/lap', message as Lap);
      runs.at(-1)?.laps.push(lap);
      runs.at(-1)?.samples.complete(lap.lap - 1, lap.lap_time_s); // after the last lap no frame says so
    }
  }
  return runs.map((each, i) => ({
    ...each,
    recording: log.name,
    name: runs.length > 1 ? `${log.name}, run ${i + 1}` : log.name,
  }));
}
