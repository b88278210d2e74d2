import { expect, it, vi } from 'vitest';
import type { Frame, Run } from '../protocol/topics';
import { changeAt, frameWith } from './test_messages';

// A page of its own, whatever other tests have loaded.
vi.resetModules();
const { beginSession, frameListeners, rebuildListeners, restartListeners, receive, receivePastLeft } = await import(
  './demultiplexer'
);
const { Column } = await import('./columns');
const { events } = await import('./event_log');
const { faultMarks } = await import('./faults');
const { laps, lapSamples } = await import('./laps');
const { live } = await import('./live');
const { shown, behind, refreshText } = await import('./shown');
const { ageAtArrival, link } = await import('./link');

const SPEED = 50; // [m/s]
const frameAt = (i: number): Frame => {
  const distance = i * 0.2 * SPEED;
  const lap = Math.floor(distance / 1000);
  const s = distance % 1000;
  const ofLap = { lap, s_m: s, lap_time_s: s / SPEED, last_lap_time_s: lap > 0 ? 20 : 0 };
  const events = { is_gated: i === 30, active_faults: i === 40 ? 1 : 0 };
  return frameWith({ cycle: BigInt(i), time_s: 0.2 * i, x_m: distance, speed_mps: SPEED, ...ofLap, ...events });
};
const times = (): number[] => [...live.plots.column(Column.time_s)].map((time) => Math.round(time / 0.2));
const upTo = (first: number, last: number): number[] => Array.from({ length: last - first + 1 }, (_, i) => first + i);

/** A page that comes at frame 350, and sees the present up to 360; 400 frames are three laps and a third. */
function joined(): void {
  beginSession();
  receive('/chicane/run', { track_length_m: 1000, fault_names: ['noise'] } as unknown as Run, 0);
  receive('/chicane/change', changeAt(3, 'latency_ms', '60'), 0);
  for (let i = 350; i <= 360; ++i) receive('/chicane/frame', frameAt(i), i);
}

it('shows the present at once, and puts the past before it', () => {
  joined();
  expect(live.frame?.cycle).toBe(360n);
  for (let i = 350; i > 200; --i) receive('/chicane/past', frameAt(i), 1000);
  expect(times()).toEqual(upTo(350, 360));
  receivePastLeft(200, 2000);
  expect(times(), 'a first look').toEqual(upTo(201, 360));
  for (let i = 200; i > 100; --i) receive('/chicane/past', frameAt(i), 2500);
  receivePastLeft(100, 2900);
  expect(times(), 'not every page').toEqual(upTo(201, 360));
  receive('/chicane/frame', frameAt(361), 2950);
  for (let i = 100; i >= 0; --i) receive('/chicane/past', frameAt(i), 3000);
  const heard: bigint[] = [];
  const listen = (frame: Frame) => void heard.push(frame.cycle);
  const notices: string[] = [];
  rebuildListeners.add(() => void notices.push('all frames follow'));
  restartListeners.add(() => void notices.push('another run'));
  frameListeners.add(listen);
  receivePastLeft(0, 3000);
  frameListeners.delete(listen);
  rebuildListeners.clear();
  restartListeners.clear();
  expect(notices).toEqual(['all frames follow']);
  expect(times()).toEqual(upTo(0, 361));
  expect(live.frame?.cycle, 'the newest stays on the screen').toBe(361n);
  expect(heard.map(Number), 'in three dimensions, too').toEqual(upTo(0, 361));
  expect(lapSamples.laps).toEqual([0, 1, 2]);
  expect(events.value.map(({ text }) => text)).toEqual([
    'Fault: noise',
    'The gate changed the command',
    'latency_ms set to 60',
  ]);
  expect(faultMarks.value).toHaveLength(1);
});

it('goes on as if nothing had been behind', () => {
  joined();
  for (let i = 350; i >= 0; --i) receive('/chicane/past', frameAt(i), 1000);
  receivePastLeft(0, 1000);
  for (let i = 361; i <= 405; ++i) receive('/chicane/frame', frameAt(i), 2000 + i);
  expect(times()).toEqual(upTo(0, 405));
  expect(lapSamples.laps).toEqual([0, 1, 2, 3]);
  receive('/chicane/past', frameAt(7), 3000);
  receivePastLeft(0, 3000);
  expect(times(), 'what comes after its end is of no past').toEqual(upTo(0, 405));
});

it('drops what is on its way when the run begins anew', () => {
  joined();
  receive('/chicane/past', frameAt(340), 1000);
  receive('/chicane/frame', frameAt(2), 1100);
  receive('/chicane/past', frameAt(339), 1200);
  receivePastLeft(0, 1300);
  expect(times()).toEqual([2]);
  expect(laps.value).toEqual([]);
});

it('is live only while the newest frame is not old', () => {
  joined();
  link.value = 'live';
  const now = live.receivedAt;
  refreshText(now);
  expect(behind.value).toBe(0);
  ageAtArrival.value = 0.7;
  refreshText(now + 200);
  expect(behind.value).toBe(0);
  refreshText(now + 400);
  expect(behind.value).toBe(1);
  ageAtArrival.value = 4.2;
  refreshText(now);
  expect(behind.value).toBe(4);
  ageAtArrival.value = 0;
  shown.value = null;
});
