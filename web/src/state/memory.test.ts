import { expect, it, vi } from 'vitest';
import { frameWith, planWith, runWith } from './test_messages';

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
  receive('/chicane/run', runWith({ track_length_m: 1000 }), 0);
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
      const s = distance % 1000;
      const ofLap = { lap, s_m: s, lap_time_s: s / SPEED, last_lap_time_s: lap > 0 ? 1000 / SPEED : 0 };
      const events = { is_gated: i % 200 === 0, active_faults: i % 300 === 0 ? 1 : 0 };
      receive('/chicane/frame', frameWith({ time_s: i / 60, x_m: distance, ...ofLap, ...events }), i);
      receive('/chicane/plan', planWith({ stamp: { sec: Math.floor(i / 60), nsec: 0 } }), i);
    }
  };
  drive(0, FRAMES);
  const full = sizes();
  expect(full).toEqual([3600, 4000, 96, 17, 60]);
  drive(FRAMES, 1.5 * FRAMES);
  expect(sizes()).toEqual(full);
});
