import { signal } from '@preact/signals';
import type { Frame, Plan } from '../protocol/topics';
import { live } from './live';
import { everyFrame } from './ticker';

// The last seconds of the run once more, in the page, while the run goes on or after it is over.

export const REPLAY_S = 10;
const MOST_KEPT = 1200;

export interface Moment {
  readonly frame: Frame;
  readonly plan: Plan | null;
}

let recent: Moment[] = [];
let shownAgain: readonly Moment[] = [];
let stop: () => void = () => undefined;

/** Seconds of the replay that are left; null while none is shown. */
export const replayLeft = signal<number | null>(null);

/** Called with each frame that is shown again, and with the newest one at the end. */
export const replayListeners = new Set<(frame: Frame, now: number) => void>();

export const isReplaying = (): boolean => shownAgain.length > 0;

/** Keeps the frames of the last seconds. */
export function keepRecent(frame: Frame, plan: Plan | null): void {
  const last = recent.at(-1)?.frame;
  if (last && frame.time_s < last.time_s) recent = [];
  recent.push({ frame, plan });
  const from = frame.time_s - REPLAY_S;
  let old = 0;
  while ((recent[old]?.frame.time_s ?? Infinity) < from || recent.length - old > MOST_KEPT) ++old;
  // In blocks: to shift one by one would move the whole row each time.
  if (old > 64 || recent.length > MOST_KEPT) recent.splice(0, old);
}

export function forgetRecent(): void {
  endReplay();
  recent = [];
}

export const canReplay = (): boolean => recent.length > 1;

function show({ frame, plan }: Moment, now: number): void {
  live.frame = frame;
  live.plan = plan;
  live.receivedAt = now;
  for (const listener of replayListeners) listener(frame, now);
}

/** Shows the last seconds again, at the pace they were driven. */
export function startReplay(): void {
  const end = recent.at(-1)?.frame.time_s ?? NaN;
  showAgain(recent.filter(({ frame }) => frame.time_s >= end - REPLAY_S));
}

/** Shows moments, by their time, at the pace they were driven. */
export function showAgain(moments: readonly Moment[]): void {
  shownAgain = moments;
  const end = moments.at(-1)?.frame.time_s ?? NaN;
  if (shownAgain.length < 2) {
    endReplay();
    return;
  }
  stop();
  let [at, time, clock] = [0, shownAgain[0]?.frame.time_s ?? 0, NaN];
  stop = everyFrame((now) => {
    if (Number.isFinite(clock)) time += Math.min(now - clock, 250) / 1000;
    clock = now;
    const first = at;
    while (at < shownAgain.length && (shownAgain[at]?.frame.time_s ?? Infinity) <= time) ++at;
    const moment = shownAgain[at - 1];
    if (moment && at > first) show(moment, now);
    replayLeft.value = Math.max(0, Math.ceil(end - time));
    if (at >= shownAgain.length) endReplay();
  });
}

/** Back to the newest frame. */
export function endReplay(): void {
  stop();
  stop = () => undefined;
  shownAgain = [];
  replayLeft.value = null;
  const newest = recent.at(-1);
  if (newest) show(newest, performance.now());
}
