import { computed } from '@preact/signals';
import { persisted } from '../lib/persisted';
import type { Lap } from '../protocol/topics';
import { changesOf } from './lap_setup';
import { run } from './run';
import { settingChanges, startSettings } from './settings';

// The best lap of each who drove, for each track and car, over all runs that this browser has seen: people against
// controllers. A lap counts when it is clean, driven by one alone, and without faults.

export interface Score {
  readonly track: string;
  readonly car: string;
  readonly who: string;
  readonly time: number; // [s]
}

export const BY_HAND = 'by hand';
const MOST_KEPT = 200;

const isScore = (value: unknown): value is Score => {
  const { track, car, who, time } = (value ?? {}) as Partial<Score>;
  return [track, car, who].every((each) => typeof each === 'string') && typeof time === 'number' && time > 0;
};

const kept = persisted<string>('leaderboard', '[]');
export const scores = computed<readonly Score[]>(() => {
  try {
    const all: unknown = JSON.parse(kept.value);
    return Array.isArray(all) ? all.filter(isScore) : [];
  } catch {
    return [];
  }
});

/** Who drove a lap; null where it does not count. `name`: of the controller. */
export function whoDrove(lap: Lap, name: string, isChanged: boolean): string | null {
  if (!lap.is_clean || lap.is_mixed || lap.faults.length > 0 || !(lap.lap_time_s > 0)) return null;
  const suffix = isChanged ? ', changed' : '';
  if (lap.by_hand_share > 0.999) return `${BY_HAND}${suffix}`;
  return lap.by_hand_share === 0 ? `${name}${suffix}` : null;
}

/** With a lap more: it takes the place of a slower one of the same driver. The slowest of very many are forgotten. */
export function withScore(all: readonly Score[], more: Score): readonly Score[] {
  const isSame = (each: Score): boolean => each.track === more.track && each.car === more.car && each.who === more.who;
  if (all.some((each) => isSame(each) && each.time <= more.time)) return all;
  return [...all.filter((each) => !isSame(each)), more].slice(-MOST_KEPT);
}

/** Of the track and car that are driven, the fastest first. */
export const board = computed<readonly Score[]>(() => {
  const now = run.value;
  const here = scores.value.filter(({ track, car }) => track === now?.track && car === now.car);
  return [...here].sort((a, b) => a.time - b.time);
});

export function forgetBoard(): void {
  const now = run.value;
  kept.value = JSON.stringify(scores.value.filter(({ track, car }) => track !== now?.track || car !== now.car));
}

const CHOICES = ['track', 'car', 'preset', 'controller', 'seed'];

/** A lap of the run that is shown was completed. */
export function noteScore(lap: Lap): void {
  const now = run.value;
  if (now?.mode !== 'drive') return;
  const name = now.preset === now.controller ? now.controller : `${now.controller}, ${now.preset}`;
  const isChanged =
    changesOf(lap, startSettings.value).size > 0 || settingChanges.value.some(({ key }) => !CHOICES.includes(key));
  const who = whoDrove(lap, name, isChanged);
  if (who === null) return;
  const all = withScore(scores.value, { track: now.track, car: now.car, who, time: lap.lap_time_s });
  if (all !== scores.value) kept.value = JSON.stringify(all);
}
