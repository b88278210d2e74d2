import { lapSamples } from '../state/laps';
import { addOtherLaps, isSameRoad } from '../state/other_laps';
import { openFiles } from './open';
import { type LoggedRun, runsOf } from './runs_of_log';

/** Offers the laps of a recording's runs for comparison; returns how many of its runs were on this road. */
export function offerLaps(runs: readonly LoggedRun[]): number {
  const same = runs.filter(({ samples }) => isSameRoad(samples, lapSamples));
  for (const { name, laps, samples } of same) addOtherLaps(name, laps, samples);
  return same.length;
}

/** Reads recordings, and offers their laps for comparison. Rejects with a reason. */
export async function addLapsOf(files: readonly File[]): Promise<void> {
  const { logs } = await openFiles(files);
  for (const log of logs) {
    const runs = await runsOf(log);
    if (offerLaps(runs) > 0) continue;
    const track = runs[0]?.run.track ?? 'another track';
    throw new Error(`${log.name} was driven on another road (${track}): its laps cannot be compared with these`);
  }
}
