// Detects that a restarted program drives another choice, and brings back the one before.
import { computed } from '@preact/signals';
import { store } from '../lib/store';
import { requests } from './operate';
import { run } from './run';

/** Settings that choose a run. */
const CHOICES = ['track', 'car', 'preset', 'controller'] as const;
type Choice = Readonly<Record<(typeof CHOICES)[number], string>>;

/** The choice that the last program drove. */
const before = store.signal<Choice | null>('page', null);

/** The choice of the run that this page showed before, where the program now drives another one. */
export const otherRun = computed<Choice | null>(() => {
  const [old, now] = [before.value, run.value];
  return old && now && CHOICES.some((key) => old[key] !== now[key]) ? old : null;
});

/** Another program will answer: remembers what the last one drove. */
export function rememberRun(): void {
  const now = run.value;
  if (now) before.value = { track: now.track, car: now.car, preset: now.preset, controller: now.controller };
}

/** Keeps the run that is driven now. */
export function forgetOtherRun(): void {
  before.value = null;
}

/** Chooses again what was driven before; several choices make one run. */
export async function chooseBefore(): Promise<void> {
  const old = before.value;
  before.value = null;
  for (const key of CHOICES) if (old && old[key] !== run.value?.[key]) await requests.set(key, old[key]);
}

/** A choice in words. */
export const inWords = ({ track, car, preset }: Choice): string => `${preset} with ${car} on ${track}`;
