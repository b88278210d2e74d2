import { store } from '../lib/store';
import type { Frame, Plan } from '../protocol/topics';
import { live } from './live';
import { everyFrame } from './ticker';

// The last seconds of the run once more, in the page, while the run goes on or after it is over.

export const REPLAY_S = 10; // chosen
const MOST_KEPT = 1200; // frames: twice those of 10 s at 60 a second
/** Longest step of the replay, after a pause of the page [ms]; chosen. */
const LONGEST_STEP_MS = 250;

/** A frame of the run with the plan of its time. */
export interface Moment {
  readonly frame: Frame;
  readonly plan: Plan | null;
}

/** Moments of the last seconds, and those that are shown again. */
const replay = store.data('page', () => ({
  recent: [] as Moment[],
  shownAgain: [] as readonly Moment[],
  stop: (): void => undefined,
}));

/** Seconds of the replay that are left; null while none is shown. */
export const replayLeft = store.signal<number | null>('page', null);

/** Called with each frame that is shown again, and with the newest one at the end. */
export const replayListeners = new Set<(frame: Frame, now: number) => void>();

/** Whether moments are shown again. */
export const isReplaying = (): boolean => replay.shownAgain.length > 0;

/** Keeps the frames of the last seconds. */
export function keepRecent(frame: Frame, plan: Plan | null): void {
  const last = replay.recent.at(-1)?.frame;
  if (last && frame.time_s < last.time_s) replay.recent = [];
  replay.recent.push({ frame, plan });
  const from = frame.time_s - REPLAY_S;
  let old = 0;
  while ((replay.recent[old]?.frame.time_s ?? Infinity) < from || replay.recent.length - old > MOST_KEPT) ++old;
  // In blocks of 64, because removing one frame moves all others.
  if (old > 64 || replay.recent.length > MOST_KEPT) replay.recent.splice(0, old);
}

store.onReset('moment', () => {
  replay.recent = []; // first: nothing of it is shown at the end
  endReplay();
});

/** Whether there is something to show again. */
export const canReplay = (): boolean => replay.recent.length > 1;

/** Shows a moment in place of the newest one. */
function show({ frame, plan }: Moment, now: number): void {
  live.frame = frame;
  live.plan = plan;
  live.receivedAt = now;
  for (const listener of replayListeners) listener(frame, now);
}

/** Shows the last seconds again, at the pace they were driven. */
export function startReplay(): void {
  const end = replay.recent.at(-1)?.frame.time_s ?? NaN;
  showAgain(replay.recent.filter(({ frame }) => frame.time_s >= end - REPLAY_S));
}

/** Shows moments, by their time, at the pace they were driven. */
export function showAgain(moments: readonly Moment[]): void {
  replay.shownAgain = moments;
  const end = moments.at(-1)?.frame.time_s ?? NaN;
  if (replay.shownAgain.length < 2) {
    endReplay();
    return;
  }
  replay.stop();
  let [at, time, clock] = [0, replay.shownAgain[0]?.frame.time_s ?? 0, NaN];
  replay.stop = everyFrame((now) => {
    if (Number.isFinite(clock)) time += Math.min(now - clock, LONGEST_STEP_MS) / 1000;
    clock = now;
    const first = at;
    while (at < replay.shownAgain.length && (replay.shownAgain[at]?.frame.time_s ?? Infinity) <= time) ++at;
    const moment = replay.shownAgain[at - 1];
    if (moment && at > first) show(moment, now);
    replayLeft.value = Math.max(0, Math.ceil(end - time));
    if (at >= replay.shownAgain.length) endReplay();
  });
}

/** Ends the replay and shows the newest frame. */
export function endReplay(): void {
  replay.stop();
  replay.stop = () => undefined;
  replay.shownAgain = [];
  replayLeft.value = null;
  const newest = replay.recent.at(-1);
  if (newest) show(newest, performance.now());
}
