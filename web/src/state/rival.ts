// Race of two settings on one stage: the program drives a second car, which the page draws as the ghost and samples by
// laps.
import { effect } from '@preact/signals';
import { type Pose, poseAt } from '../lib/poses';
import { store } from '../lib/store';
import type { GhostSource } from '../scene3d/ghost';
import type { Course } from './comparison';
import { recordedCourse } from './courses';
import { restartListeners } from './demultiplexer';
import { ghosts } from './ghost_shown';
import { LapSamples } from './lap_samples';
import { lapSamples } from './laps';
import { link, notice } from './link';
import { live } from './live';
import { ask, can, canSet, requests } from './operate';
import { programPage } from './program_page';
import { type Race, type RacePoses, readRace, sampleRace } from './rival_answer';
import { run } from './run';
import { entryOf } from './settings';
import type { ChosenSetting } from './what_if';

/** State of the race; null without one. */
export const race = store.signal<Race | null>('page', null);
/** The settings of B. */
export const raced = store.signal<readonly ChosenSetting[]>('page', []);
export const raceProblem = store.signal('page', '');

/** Whether the program offers races. */
export const canRace = (): boolean => can('/rival');

/** Longest time by which B is extrapolated beyond its newest pose [s]; chosen: three times POLL_MS. */
const AHEAD_S = 0.6;

/** B's pose at the time of the run's newest frame; B's poses arrive later, and are extrapolated until then. */
export function poseOf(poses: RacePoses, time: number, into: Pose): boolean {
  if (poseAt(poses, time, into)) return true;
  const last = poses.time_s.length - 1;
  const at = (name: keyof RacePoses): number => poses[name][last] ?? NaN;
  const ahead = time - at('time_s');
  if (!(ahead > 0) || ahead > AHEAD_S) return false;
  const way = at('speed_mps') * ahead;
  into.yaw = at('yaw_rad');
  into.x = at('x_m') + way * Math.cos(into.yaw);
  into.y = at('y_m') + way * Math.sin(into.yaw);
  into.steer = at('steer_rad');
  return true;
}

/** B as a ghost. */
const ghost: GhostSource = {
  label: 'B',
  lapTime: Infinity,
  line: new Float32Array(0),
  poseAt: (_time, into) => race.value !== null && poseOf(race.value.poses, live.frame?.time_s ?? NaN, into),
};

effect(() => {
  ghosts.race = race.value?.state === 'racing' ? ghost : null;
});

/** B's laps as functions of the distance, sampled from its poses. */
const driven = { samples: new LapSamples(), id: NaN };
/** Number of laps of B that are sampled to their end. */
const sampled = store.signal('page', 0);
/** Time of the race up to which its poses are sampled [s]. */
const known = store.data('page', () => ({ since: -1 }));

/** Samples the new poses of B; begins anew for another race or another road. */
function sample(now: Race): void {
  const length = run.value?.track_length_m ?? NaN;
  if (now.id !== driven.id || driven.samples.length !== length || (now.poses.time_s.at(-1) ?? 0) < known.since) {
    driven.samples.clear();
    driven.samples.setLength(length);
    [driven.id, known.since] = [now.id, -1];
  }
  known.since = sampleRace(driven.samples, now, lapSamples.line, known.since);
  sampled.value = driven.samples.completed;
}

/** The laps of B at the points of `onto`, the newest first. */
export function raceCourses(onto: LapSamples): Course[] {
  void sampled.value;
  const { samples } = driven;
  return (race.value?.b ?? [])
    .filter(({ lap }) => samples.laps.includes(lap - 1))
    .map(({ lap, time }) => recordedCourse({ recording: 'B, the ghost', lap, time, samples }, onto))
    .reverse();
}

const POLL_MS = 200; // chosen
const next = store.data('page', () => ({ look: undefined as ReturnType<typeof setTimeout> | undefined, asked: 0 }));

/** Asks the program for the race, and again as long as it goes on; passes over an answer after a later question. */
async function look(): Promise<void> {
  clearTimeout(next.look);
  const question = ++next.asked;
  if (!canRace()) return;
  const text = await programPage('rival.json').catch(() => null);
  if (question !== next.asked) return;
  const now = text === null ? null : readRace(JSON.parse(text));
  race.value = now === null || now.state === 'none' ? null : now;
  if (race.value) sample(race.value);
  if (now && (now.state === 'racing' || now.state === 'building')) next.look = setTimeout(() => void look(), POLL_MS);
}

// A page that comes while a race goes on shows it.
effect(() => {
  if (link.value === 'live' && canRace()) void look();
});
restartListeners.add(() => void look());

/** Both cars begin at the line, B with these settings. */
export async function startRace(chosenSettings: readonly ChosenSetting[]): Promise<void> {
  const settings = Object.fromEntries(chosenSettings.map(({ key, value }) => [key, value]));
  const answer = await ask('/rival', JSON.stringify({ settings }));
  raceProblem.value = answer.isTaken ? '' : answer.message;
  if (!answer.isTaken) return;
  raced.value = chosenSettings;
  void look();
}

/** Ends the race; the run goes on. */
export async function endRace(): Promise<void> {
  await ask('/rival', '{}');
  race.value = null;
  void look();
}

/** The run goes on with the settings of the winner, alone. */
export async function keepWinner(winner: 'A' | 'B'): Promise<void> {
  if (winner === 'B') {
    for (const { key, value } of raced.value) if (canSet(key)) await requests.set(key, value);
    const fixed = raced.value.map(({ key }) => key).filter((key) => entryOf(key)?.is_fixed === true);
    if (fixed.length > 0) notice.value = `Fixed when a run starts, and not kept: ${fixed.join(', ')}`;
  }
  await endRace();
}
