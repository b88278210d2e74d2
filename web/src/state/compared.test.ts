import { expect, it, vi } from 'vitest';
import { UNKNOWN_LIMIT } from '../protocol/messages';
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

it('is the newest lap, with the limit where it holds, else with the best', async () => {
  const page = await freshPage();
  drive(page, 3);
  await vi.waitFor(() => expect(page.pair.value.map((each) => each?.id)).toEqual(['lap 3', 'lap 2']));
  const limit = { ...UNKNOWN_LIMIT, is_known: true, lap_time_s: 30, first_lap: 2 };
  const road = { s_m: Float64Array.of(0, 200, 400), speed_mps: Float64Array.of(13, 13, 13) };
  page.receive('/chicane/limit', { ...limit, ...road, time_s: Float64Array.of(0, 15, 30) }, 0);
  expect(page.pair.value.map((each) => each?.id)).toEqual(['lap 3', 'limit']);
  expect(page.comparison.value?.total).toBeCloseTo(LAP_S + 3e-3 - 30);
  page.chosen.value = ['lap 1', null]; // the grip was another then
  expect(page.pair.value[1]?.id).toBe('lap 2');
});

it('is offered only where the page has its course', async () => {
  const page = await freshPage();
  drive(page, page.KEPT_LAPS + 6);
  page.chosen.value = ['lap 3', null]; // forgotten
  await vi.waitFor(() => expect(page.pair.value[0]?.id).toBe(`lap ${page.KEPT_LAPS + 6}`));
  expect(page.courses.value.map(({ id }) => id)).not.toContain('lap 3');
  expect(page.comparison.value).not.toBeNull();
});
