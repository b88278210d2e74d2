import { describe, expect, it } from 'vitest';
import { poseOf } from './rival';
import { gapsOf, type RaceLap, readRace, verdictOf } from './rival_answer';

const lap = (number: number, sectors: number[], more: Partial<RaceLap> = {}): RaceLap => ({
  lap: number,
  time: sectors.reduce((a, b) => a + b, 0),
  sectors,
  isClean: true,
  slowest: [20, 20, 20],
  fastest: [40, 40, 40],
  errors: [1, 1, 1],
  ...more,
});
const none = readRace({ state: 'racing' });

describe('the gap between two cars', () => {
  it('is told third by third, with what the other did otherwise, the newest lap first', () => {
    const race = {
      ...none,
      a: [lap(1, [10, 10, 10]), lap(2, [8, 8, 8]), lap(3, [8, 8, 8])],
      b: [
        lap(1, [10, 10, 10]),
        lap(2, [7.5, 8.002, 8.4], { slowest: [22, 20, 20], fastest: [40, 40, 38], errors: [1, 1.5, 1] }),
      ],
    };
    const [newest, first] = gapsOf(race);
    expect(newest?.lap).toBe(2);
    expect(newest?.thirds.map(({ gap }) => gap.toFixed(3))).toEqual(['-0.500', '0.002', '0.400']);
    expect(newest?.thirds.map(({ cause }) => cause)).toEqual([
      '4.5 mph more where it is slowest',
      '0.5 m farther from the line',
      '4.5 mph less at the top',
    ]);
    expect(first?.thirds[0]?.cause).toBe('the same');
    expect(verdictOf(race)).toEqual({ winner: 'B', text: 'Lap 2: B is 0.098 s faster.' });
  });

  it('is no victory of one that left the road without saying so', () => {
    const race = { ...none, a: [lap(1, [10, 10, 10])], b: [lap(1, [9, 10, 10], { isClean: false })] };
    expect(verdictOf(race).text).toBe('Lap 1: B is 1.000 s faster, off the road.');
    expect(verdictOf(none)).toEqual({ winner: null, text: 'No lap is driven by both yet.' });
    expect(verdictOf({ ...race, b: race.a }).winner).toBe(null);
  });
});

it('reads what the program tells, whatever is missing', () => {
  const read = readRace({
    id: 3,
    state: 'ended',
    why: 'lost',
    rival: [{ lap: 2, lap_time_s: 26.5, sector_times_s: [8, 9, null], is_clean: true }],
    trace: { time_s: [1, 2] },
  });
  expect([read.id, read.state, read.why, read.a]).toEqual([3, 'ended', 'lost', []]);
  expect(read.b[0]).toMatchObject({ lap: 2, time: 26.5, sectors: [8, 9, NaN], isClean: true, slowest: [] });
  expect(read.poses.x_m).toEqual([]);
  expect(readRace(null).state).toBe('none');
});

it('shows the other car at the time that is shown: between two poses, and a moment beyond the last', () => {
  const poses = {
    time_s: [10, 11],
    x_m: [0, 20],
    y_m: [0, 0],
    yaw_rad: [3.1, -3.1],
    steer_rad: [0.1, 0.2],
    speed_mps: [20, 20],
    distance_m: [0, 20],
  };
  const pose = { x: NaN, y: NaN, yaw: NaN, steer: NaN };
  expect(poseOf(poses, 10.5, pose)).toBe(true);
  expect(pose.x).toBeCloseTo(10);
  expect(Math.cos(pose.yaw)).toBeLessThan(-0.999); // the short way round
  expect(poseOf(poses, 11.5, pose)).toBe(true);
  expect(pose.x).toBeCloseTo(20 + 10 * Math.cos(-3.1));
  expect(poseOf(poses, 12, pose)).toBe(false);
  expect(poseOf(poses, 9.9, pose)).toBe(false);
  expect(poseOf(none.poses, 10, pose)).toBe(false);
});
