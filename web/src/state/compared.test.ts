import { describe, expect, it, vi } from 'vitest';
import { frameWith, lapWith, runWith } from './test_messages';

const LENGTH = 400; // of the road [m]
const LAP_S = 40;

/** A page of its own: others may have been told to keep all laps for good. */
async function freshPage() {
  vi.resetModules();
  return {
    ...(await import('./compared')),
    ...(await import('./demultiplexer')),
    ...(await import('./lap_samples')),
    ...(await import('./laps')),
  };
}
type Page = Awaited<ReturnType<typeof freshPage>>;

/** Drives so many laps at 10 m/s; the first is the fastest by a hair. */
function drive(page: Page, count: number): void {
  page.receive('/chicane/run', runWith({ track: 'ring', track_length_m: LENGTH, is_closed: true }), 0);
  for (let second = 0; second <= count * LAP_S; second += 0.5) {
    const lap = Math.floor(second / LAP_S);
    const inLap = second - lap * LAP_S;
    const last = lap > 0 ? LAP_S + lap * 1e-3 : 0;
    const where = { time_s: second, lap, lap_time_s: inLap, s_m: 10 * inLap, last_lap_time_s: last };
    page.receive('/chicane/frame', frameWith({ ...where, speed_mps: 10 }), 1000 * second);
    if (lap > 0 && inLap === 0) page.receiveLap(lapWith(lap, last));
  }
}

describe('compared laps', () => {
  it('are named where the page has not kept their course', async () => {
    const page = await freshPage();
    const { KEPT_LAPS, chosen, forgotten, twoLaps } = page;
    drive(page, KEPT_LAPS + 6);
    expect(page.lapSamples.laps).not.toContain(2);
    chosen.value = [3, KEPT_LAPS + 5];
    await vi.waitFor(() => expect(forgotten.value).toEqual(['lap 3'])); // the table follows a moment later
    expect(twoLaps.value).toBeNull();
    chosen.value = [KEPT_LAPS + 4, KEPT_LAPS + 5];
    expect(twoLaps.value).not.toBeNull();
    expect(forgotten.value).toEqual([]);
  });
});
