import { effect } from '@preact/signals';
import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import * as lapsOfThePage from './laps';
import { forgetLaps, lapSamples, laps, noteLap, receiveLap } from './laps';
import { receiveRun } from './run';
import { frameWith, lapWith, runWith } from './test_messages';

beforeEach(() => {
  vi.useFakeTimers();
  forgetLaps();
});
afterEach(() => {
  vi.runAllTimers();
  vi.useRealTimers();
});

/** The frames of a lap of 10 s on a road of 100 m, and the first frame of the next lap. */
function driveLap(page: Pick<typeof lapsOfThePage, 'noteLap'>, lap: number): void {
  for (let i = 0; i <= 10; ++i) page.noteLap(frameWith({ lap, s_m: 10 * i, lap_time_s: i, last_lap_time_s: 0 }));
  page.noteLap(frameWith({ lap: lap + 1, s_m: 5, lap_time_s: 0.5, last_lap_time_s: 10 }));
}

it('are kept by number', () => {
  for (const each of [lapWith(2, 27), lapWith(1, 30), lapWith(2, 27.5)]) receiveLap(each);
  vi.runAllTimers();
  expect(laps.value.map(({ lap, lap_time_s }) => [lap, lap_time_s])).toEqual([
    [1, 30],
    [2, 27.5],
  ]);
  forgetLaps();
  expect(laps.value).toEqual([]);
});

it('are the newest thousand, and the best', () => {
  for (let lap = 1; lap <= 2000; ++lap) receiveLap(lapWith(lap, lap === 7 ? 20 : 30));
  vi.runAllTimers();
  expect(laps.value.map(({ lap }) => lap).slice(0, 3)).toEqual([7, 1001, 1002]);
  expect(laps.value).toHaveLength(1001);
});

it('are shown at once when they come one by one, and together when they come at once', () => {
  let published = -1; // the effect runs once by itself
  const end = effect(() => {
    void laps.value;
    ++published;
  });
  receiveLap(lapWith(1, 30));
  expect(published).toBe(1);
  vi.runAllTimers();
  expect(published).toBe(1);
  for (let lap = 2; lap <= 1000; ++lap) receiveLap(lapWith(lap, 30));
  vi.runAllTimers();
  expect(published).toBeLessThanOrEqual(3);
  expect(laps.value).toHaveLength(1000);
  end();
});

it('have a best time, from the frames', () => {
  const best: number[] = [];
  for (const time of [0, 30, 28, 29]) {
    noteLap(frameWith({ last_lap_time_s: time }));
    best.push(lapsOfThePage.bestLap.value);
  }
  expect(best).toEqual([NaN, 30, 28, 28]);
  forgetLaps();
  expect(lapsOfThePage.bestLap.value).toBeNaN();
});

it('are sampled along the road of the run', () => {
  receiveRun(runWith({ track_length_m: 100 }));
  driveLap(lapsOfThePage, 0);
  expect(lapSamples.laps).toEqual([0]);
  expect(lapSamples.at(0, 'time_s', 50)).toBeCloseTo(5, 6);
  forgetLaps();
  expect(lapSamples.laps).toEqual([]);
});

it('of a recording are all known at once, and stay sampled, whatever moment of it is shown', async () => {
  vi.resetModules(); // the page keeps all laps for good
  const page = await import('./laps');
  (await import('./run')).receiveRun(runWith({ track_length_m: 100 }));
  driveLap(page, 0);
  for (const lap of [1, 2, 3]) page.receiveLap(lapWith(lap, 30));
  page.keepAllLaps();
  expect(page.laps.value.map(({ lap }) => lap)).toEqual([1, 2, 3]);
  page.forgetLaps();
  driveLap(page, 1);
  expect(page.lapSamples.laps).toEqual([0]);
});
