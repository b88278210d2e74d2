import { afterEach, expect, it, vi } from 'vitest';
import { restartListeners } from './demultiplexer';
import { LapSamples } from './lap_samples';
import { link, services } from './link';
import { pause } from './program_page';
import { poseOf, race } from './rival';
import { readRace, sampleRace, standingOf } from './rival_answer';

const lap = (number: number, time: number, isClean = true) => ({ lap: number, time, isClean });
const none = readRace({ state: 'racing' });

const before = [link.value, services.value] as const;
afterEach(() => {
  [link.value, services.value, race.value] = [...before, null];
  vi.unstubAllGlobals();
});

it('says who drove the newest lap of both faster', () => {
  const race = { ...none, a: [lap(1, 30), lap(2, 24), lap(3, 24)], b: [lap(1, 30), lap(2, 23.902)] };
  expect(standingOf(race)).toEqual({ winner: 'B', text: 'Lap 2: B is 0.098 s faster.' });
  expect(standingOf({ ...race, b: [lap(1, 29, false)] }).text).toBe('Lap 1: B is 1.000 s faster, off the road.');
  expect(standingOf(none)).toEqual({ winner: null, text: 'No lap is driven by both yet.' });
  expect(standingOf({ ...race, b: race.a }).winner).toBe(null);
});

it('passes over an answer that a later question has overtaken', async () => {
  const answers: ((text: string) => void)[] = [];
  const text = (): Promise<string> => new Promise((answer) => answers.push(answer));
  vi.stubGlobal('fetch', () => Promise.resolve({ ok: true, text }));
  services.value = new Set(['/rival']);
  link.value = 'live'; // asks
  for (const listener of restartListeners) listener(); // asks again
  await pause(1);
  answers[1]?.('{"state": "ended", "why": "newer"}');
  answers[0]?.('{"state": "ended", "why": "older"}');
  await pause(1);
  expect([answers.length, race.value?.why]).toEqual([2, 'newer']);
});

it('the other car has laps along the road, from its poses', () => {
  const samples = new LapSamples();
  samples.setLength(100);
  const times = Array.from({ length: 221 }, (_, i) => i / 10);
  const driven = { distance_m: times.map((time) => 10 * time), speed_mps: times.map(() => 10) };
  const poses = { ...none.poses, ...driven, time_s: times, x_m: times };
  const newest = sampleRace(samples, { ...none, b: [lap(1, 10), lap(2, 10)], poses }, 40, -1);
  expect(newest).toBe(22);
  expect(samples.laps).toEqual([0, 1]);
  expect(samples.channel(1, 'time_s')?.[500]).toBeCloseTo(5, 1);
  expect(samples.place(0)).toBeCloseTo(40, 0);
  expect(sampleRace(samples, { ...none, b: [lap(7, 10)], poses }, 40, 0)).toBe(0); // the first laps are not known
});

it('reads what the program tells, whatever is missing', () => {
  const rival = [{ lap: 2, lap_time_s: 26.5, sector_times_s: [8, 9, null], is_clean: true }];
  const read = readRace({ id: 3, state: 'ended', why: 'lost', rival, trace: { time_s: [1, 2] } });
  expect([read.id, read.state, read.why, read.a]).toEqual([3, 'ended', 'lost', []]);
  expect(read.b[0]).toEqual({ lap: 2, time: 26.5, isClean: true });
  expect(read.poses.x_m).toEqual([]);
  expect(readRace(null).state).toBe('none');
});

it('shows the other car at the time that is shown: between two poses, and a moment beyond the last', () => {
  const places = { time_s: [10, 11], x_m: [0, 20], y_m: [0, 0], distance_m: [0, 20] };
  const poses = { ...places, yaw_rad: [3.1, -3.1], steer_rad: [0.1, 0.2], speed_mps: [20, 20] };
  const pose = { x: NaN, y: NaN, yaw: NaN, steer: NaN };
  expect(poseOf(poses, 10.5, pose)).toBe(true);
  expect(pose.x).toBeCloseTo(10);
  expect(Math.cos(pose.yaw)).toBeLessThan(-0.999); // the short way round
  expect(poseOf(poses, 11.5, pose)).toBe(true);
  expect(pose.x).toBeCloseTo(20 + 10 * Math.cos(-3.1));
  for (const time of [12, 9.9]) expect(poseOf(poses, time, pose)).toBe(false);
  expect(poseOf(none.poses, 10, pose)).toBe(false);
});
