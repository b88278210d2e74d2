import { expect, it } from 'vitest';
import type { Pose } from '../lib/poses';
import { frameWith } from '../state/test_messages';
import { LapRecorder, RecordedDrive } from './ghost';

const PERIOD = 0.05;

/** A recorder of laps of `times` seconds round a circle, from `start` seconds into the first. */
function drive(
  times: readonly number[],
  { recorder = new LapRecorder(), begin = 0, start = 0, offTrackIn = -1 } = {},
): LapRecorder {
  let time = begin;
  let events = 0;
  times.forEach((lapTime, lap) => {
    if (lap === offTrackIn) ++events;
    for (let t = lap === 0 ? start : 0; t < lapTime - 1e-9; t += PERIOD) {
      const angle = (2 * Math.PI * t) / lapTime;
      const ofLap = { lap, lap_time_s: t, last_lap_time_s: times[lap - 1] ?? NaN };
      const at = { x_m: 50 * Math.cos(angle), y_m: 50 * Math.sin(angle), yaw_rad: angle + Math.PI / 2 };
      const isOver = lap > offTrackIn || (lap === offTrackIn && t > 1);
      recorder.push(frameWith({ time_s: time, ...ofLap, ...at, off_track_events: isOver ? events : 0 }));
      time += PERIOD;
    }
  });
  return recorder;
}

it('is the best whole lap, and goes as it went', () => {
  const recorder = drive([12, 10, 11, 3]);
  const ghost = recorder.best;
  expect(ghost?.lapTime).toBe(10);
  expect(ghost?.label).toBe('best lap 0:10.000');
  const pose: Pose = { x: 0, y: 0, yaw: 0, steer: 0 };
  for (const time of [0, 2.51, 7.77, 9.9, 1.2]) {
    expect(ghost?.poseAt(time, pose)).toBe(true);
    const angle = (2 * Math.PI * time) / 10;
    expect(Math.hypot(pose.x - 50 * Math.cos(angle), pose.y - 50 * Math.sin(angle))).toBeLessThan(0.02);
    expect(pose.yaw).toBeCloseTo(angle + Math.PI / 2, 4);
  }
});

it('is nowhere before its lap and after it', () => {
  const recorder = drive([10, 1]);
  const pose: Pose = { x: 7, y: 7, yaw: 7, steer: 7 };
  for (const time of [-0.1, 10.01, NaN]) expect(recorder.best?.poseAt(time, pose)).toBe(false);
  expect(pose.x).toBe(7);
});

it('is another drive at the time of its clock', () => {
  const poses = { time_s: [1, 2], x_m: [0, 10], y_m: [3, 3], yaw_rad: [3.1, -3.1] };
  const pose: Pose = { x: 0, y: 0, yaw: 0, steer: 0 };
  let now = 1.25;
  const drive = new RecordedDrive('other', poses, Infinity, () => now);
  expect(drive.poseAt(0, pose)).toBe(true);
  expect(pose).toMatchObject({ x: 2.5, y: 3, yaw: expect.closeTo(3.1 + (2 * Math.PI - 6.2) / 4) });
  now = 2.1;
  expect(drive.poseAt(0, pose)).toBe(false);
});

it('is no lap that was joined half way, left the road, or is still being driven', () => {
  const recorder = drive([10, 1], { start: 4 });
  expect(recorder.best).toBeNull();
  drive([10, 12, 2], { recorder, begin: 100, offTrackIn: 0 });
  expect(recorder.best?.lapTime).toBe(12);
});

it('is no lap that was seen with a hole in it', () => {
  const recorder = new LapRecorder();
  const { push } = recorder;
  recorder.push = (frame) => {
    if (frame.lap !== 1 || frame.lap_time_s < 4 || frame.lap_time_s > 6) push.call(recorder, frame);
  };
  drive([12, 10, 11, 2], { recorder });
  expect(recorder.best?.lapTime).toBe(11);
});

it('stays after a reset, and is cleared with the track', () => {
  const recorder = drive([10, 3]);
  drive([9, 3], { recorder }); // from time 0 again
  expect(recorder.best?.lapTime).toBe(9);
  expect(recorder.best?.label).toBe('best lap 0:09.000');
  drive([11, 3], { recorder });
  expect(recorder.best?.lapTime).toBe(9);
  expect(recorder.best?.label).toBe('best lap before the reset 0:09.000');
  recorder.clear();
  expect(recorder.best).toBeNull();
});

it('has a line of about the length of the lap', () => {
  const recorder = drive([10, 1]);
  const line = recorder.best?.line ?? new Float32Array();
  let length = 0;
  for (let i = 2; i < line.length; i += 2)
    length += Math.hypot((line[i] ?? 0) - (line[i - 2] ?? 0), (line[i + 1] ?? 0) - (line[i - 1] ?? 0));
  expect(length).toBeGreaterThan(0.98 * 2 * Math.PI * 50);
  expect(length).toBeLessThan(2 * Math.PI * 50);
});

it('forgets a lap too long to keep', () => {
  const recorder = drive([31_000 * PERIOD, 1]);
  expect(recorder.best).toBeNull();
});
