import { beforeEach, describe, expect, it } from 'vitest';
import { store } from '../lib/store';
import { chosen, forgotten, twoLaps } from './compared';
import { receive } from './demultiplexer';
import { KEPT_LAPS } from './lap_samples';
import { lapSamples, receiveLap } from './laps';
import { frameWith, lapWith, runWith } from './test_messages';

const LENGTH = 400; // of the road [m]
const LAP_S = 40;

/** Drives so many laps at 10 m/s; the first is the fastest by a hair. */
function drive(count: number): void {
  receive('/chicane/run', runWith({ track: 'ring', track_length_m: LENGTH, is_closed: true }), 0);
  for (let second = 0; second <= count * LAP_S; second += 0.5) {
    const lap = Math.floor(second / LAP_S);
    const inLap = second - lap * LAP_S;
    const last = lap > 0 ? LAP_S + lap * 1e-3 : 0;
    const where = { time_s: second, lap, lap_time_s: inLap, s_m: 10 * inLap, last_lap_time_s: last };
    receive('/chicane/frame', frameWith({ ...where, speed_mps: 10 }), 1000 * second);
    if (lap > 0 && inLap === 0) receiveLap(lapWith(lap, last));
  }
}

describe('compared laps', () => {
  beforeEach(() => store.reset('run'));

  it('are named where the page has not kept their course', async () => {
    drive(KEPT_LAPS + 6);
    await new Promise((resolve) => setTimeout(resolve, 150)); // the table follows a moment later
    expect(lapSamples.laps).not.toContain(2);
    chosen.value = [3, KEPT_LAPS + 5];
    expect(twoLaps.value).toBeNull();
    expect(forgotten.value).toEqual(['lap 3']);
    chosen.value = [KEPT_LAPS + 4, KEPT_LAPS + 5];
    expect(twoLaps.value).not.toBeNull();
    expect(forgotten.value).toEqual([]);
  });
});
