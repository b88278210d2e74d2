import { expect, it, vi } from 'vitest';
import type { Frame, Plan, Run } from '../protocol/topics';

// A page of its own, whatever other tests have loaded.
vi.resetModules();
const { receive } = await import('./demultiplexer');
const { store } = await import('../lib/store');
const { events } = await import('./event_log');
const { lapSamples } = await import('./laps');
const { live } = await import('./live');

const FRAMES = 30_000; // eight minutes at sixty a second: longer than anything the page keeps
const SPEED = 45; // [m/s]

it('what the page keeps stops growing', () => {
  store.reset('moment');
  receive('/chicane/run', { track_length_m: 1000 } as Run, 0);
  const sizes = () => [
    live.plots.length,
    live.trace.length,
    live.pastPlans.length,
    lapSamples.laps.length,
    events.value.length,
  ];
  const drive = (from: number, to: number): void => {
    for (let i = from; i < to; ++i) {
      const distance = (i * SPEED) / 60;
      const lap = Math.floor(distance / 1000);
      receive(
        '/chicane/frame',
        {
          cycle: BigInt(i),
          time_s: i / 60,
          s_m: distance % 1000,
          lap,
          lap_time_s: (distance % 1000) / SPEED,
          last_lap_time_s: lap > 0 ? 1000 / SPEED : 0,
          x_m: distance,
          y_m: 0,
          speed_mps: SPEED,
          step_time_us: 200 + (i % 997),
          is_gated: i % 200 === 0,
          cost_terms: [1, 2, 3],
          active_faults: i % 300 === 0 ? 1 : 0,
        } as unknown as Frame,
        i,
      );
      receive(
        '/chicane/plan',
        { stamp: { sec: Math.floor(i / 60), nsec: 0 }, speed_mps: [SPEED] } as unknown as Plan,
        i,
      );
    }
  };
  drive(0, FRAMES);
  const full = sizes();
  expect(full).toEqual([3600, 4000, 96, 17, 60]);
  drive(FRAMES, 1.5 * FRAMES);
  expect(sizes()).toEqual(full);
});
