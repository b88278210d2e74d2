import { expect, it } from 'vitest';
import { headlineOf } from '../state/comparison';
import { compareIn, coursesOf, firstPair, leadOf, type RunsDocument, readRuns, verdictOf } from './runs';

const LENGTH = 400; // of the ring [m]
const STEP_S = 0.25;

/** Laps of a ring, each at its speed [m/s], as the program writes them. */
function documentOf(name: string, speeds: readonly number[], more: object = {}): RunsDocument['logs'][number] {
  const rows: Record<string, number>[] = [];
  let [time, last] = [0, 0];
  speeds.forEach((speed, lap) => {
    for (let since = lap === 0 ? 0 : STEP_S / 2; since < LENGTH / speed; since += STEP_S) {
      const angle = (2 * Math.PI * since * speed) / LENGTH;
      const where = { s_m: since * speed, x_m: 64 * Math.cos(angle), y_m: 64 * Math.sin(angle), speed_mps: speed };
      const when = { time_s: time + since, lap, lap_time_s: since, last_lap_time_s: last };
      rows.push({ ...when, ...where, rung: 0, is_gated: 0, active_faults: lap === 1 ? 1 : 0, off_track_events: 0 });
    }
    last = LENGTH / speed;
    time += last;
  });
  const columns = Object.keys(rows[0] ?? {});
  const circle = Array.from({ length: 201 }, (_, i) => (2 * Math.PI * i) / 200);
  const choice = { track: ['ring'], car: ['udacity'], preset: ['default'] };
  return {
    name,
    settings: 'track: ring\n',
    runs: [
      {
        run: { ...choice, track_length_m: [LENGTH], latency_s: [0.1], fault_names: ['blind'] },
        limit: null,
        laps: speeds.map((speed, i) => ({
          lap: [i + 1],
          lap_time_s: [LENGTH / speed],
          is_clean: [1],
          min_edge_distance_m: [1.25 - i / 10],
        })),
        changes: [{ name: ['latency_ms'], value: ['60.000000000000003'], 'stamp.sec': [3], 'stamp.nanosec': [5e8] }],
        centre: { x_m: circle.map((angle) => 64 * Math.cos(angle)), y_m: circle.map((angle) => 64 * Math.sin(angle)) },
        frames: Object.fromEntries(columns.map((column) => [column, rows.map((row) => row[column] ?? null)])),
        steps: { count: rows.length, p50_us: 100, p99_us: 200, longest_us: 300, mean_iterations: 3 },
        ...more,
      },
    ],
  };
}

it('says what was driven, and what was unusual', () => {
  const [run] = readRuns({ kind: 'runs', logs: [documentOf('a.mcap', [10, 16, 15])] });
  if (!run) throw new Error('no run');
  expect(verdictOf(run)).toEqual({ text: 'Three clean laps of ring. The best took ', time: '0:25.000', behind: '' });
  expect(leadOf(run)).toBe(
    'The udacity by default, 100 ms late. No tyre left the road; the nearest was 1.05 m from the edge. ' +
      'Faults: blind at 40.1 s. Changed: latency_ms = 60 at 3.5 s.',
  );
  expect(run.samples.laps).toEqual([0, 1, 2]);
});

it('compares the best lap with the limit, of the same rounding', () => {
  const places = Array.from({ length: 101 }, (_, i) => i * 4);
  const columns = { s_m: places, time_s: places.map((s) => s / 20), speed_mps: places.map(() => 20) };
  const limit = { is_known: [1], lap_time_s: [20], first_lap: [1], ...columns };
  const runs = readRuns({ kind: 'runs', logs: [documentOf('a.mcap', [10, 16, 15], { limit })] });
  const [run] = runs;
  const courses = coursesOf(runs);
  expect(courses.map(({ id }) => id)).toEqual(['lap 1', 'lap 2', 'lap 3', 'limit']);
  const pair = firstPair(runs, courses);
  const both = run && pair && compareIn(run, ...pair);
  if (!run || !both) throw new Error('nothing to compare');
  expect(verdictOf(run).behind).toBe('5.00 s');
  expect([both.a.id, headlineOf(both).amount, both.b.id]).toEqual(['lap 2', '5.00 s', 'limit']);
});

it('compares the best laps of two recordings of one road', () => {
  const runs = readRuns({ kind: 'runs', logs: [documentOf('a.mcap', [10, 16]), documentOf('b.mcap', [10, 20])] });
  const courses = coursesOf(runs);
  const pair = firstPair(runs, courses);
  const both = runs[0] && pair && compareIn(runs[0], ...pair);
  expect(both && [both.a.id, headlineOf(both).amount, both.b.id]).toEqual(['lap 2', '5.00 s', 'lap 2 of b.mcap']);
});

it('is one of runs that say nothing', () => {
  const empty = { run: null, limit: null, laps: [], changes: [], centre: null, frames: {} };
  const [run] = readRuns({ kind: 'runs', logs: [{ name: 'a.mcap', settings: '', runs: [empty] }] });
  expect(run && verdictOf(run).text).toMatch(/^No lap of/);
  expect(run && firstPair([run], coursesOf([run]))).toBeNull();
});
