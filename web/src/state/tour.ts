// Progress of the tour that is taken: its step, and which tasks of the step are done.
import { computed } from '@preact/signals';
import { persisted } from '../lib/persisted';
import { store } from '../lib/store';
import type { Frame } from '../protocol/topics';
import { DASHBOARD_TOUR } from './dashboard_tour';
import { frameListeners, restartListeners } from './demultiplexer';
import { EFFECTS_TOUR } from './effects_tour';
import type { Step, Tour, Watch } from './tour_step';

/** All tours, in the order of their list. */
export const TOURS: readonly Tour[] = [EFFECTS_TOUR, DASHBOARD_TOUR];

/** The tour that is taken; empty: none is chosen. */
const tourName = persisted<string>('tour.name', '');
export const tour = computed<Tour | null>(() => TOURS.find(({ name }) => name === tourName.value) ?? null);
/** Index of the current step; the number of steps when all are done. Kept by the browser. */
export const stepNumber = persisted<number>(
  'tour.step',
  0,
  (value) => Number.isInteger(value) && Number(value) >= 0 && Number(value) <= (tour.value?.steps.length ?? 0),
);
/** Whether the tour is shown; kept by the browser. */
export const isTourOpen = persisted<boolean>('tour.open', false);
/** Names of the steps that were skipped. */
const left = persisted<string>('tour.skipped', '');
export const skipped = computed<readonly string[]>(() => left.value.split(',').filter((name) => name !== ''));

/** The current step; null at the end. */
export const step = computed<Step | null>(() => tour.value?.steps[stepNumber.value] ?? null);
/** For each task of the step whether it is done. */
export const done = store.signal<readonly boolean[]>('page', []);
export const isStepDone = computed(() => done.value.length > 0 && done.value.every(Boolean));

/** The step that is watched, and the time of the newest frame [s]. */
const watching = store.data('page', () => ({
  watch: null as Watch | null,
  step: null as Step | null,
  lastTime: NaN,
}));

/** Begins to watch the current step. */
function begin(): void {
  watching.step = step.value;
  watching.watch = step.value?.watch() ?? null;
  done.value = (step.value?.tasks ?? []).map(() => false);
  watching.lastTime = NaN;
}

/** Opens the tour where it was left; the list of tours when it was finished. */
export function openTour(): void {
  if (tour.value && stepNumber.value >= tour.value.steps.length) tourName.value = '';
  isTourOpen.value = true;
  begin();
}

/** Begins a tour; an empty name: the list of tours. */
export function chooseTour(name: string): void {
  stepNumber.value = 0;
  left.value = '';
  tourName.value = name;
  begin();
}

/** Closes the tour, to be gone on with. */
export function leaveTour(): void {
  isTourOpen.value = false;
}

/** On to the next step: when this one is done, or left out. */
export function goOn(): void {
  if (!isStepDone.value && step.value) left.value = [...skipped.value, step.value.name].join();
  stepNumber.value = Math.min(tour.value?.steps.length ?? 0, stepNumber.value + 1);
  begin();
}

/** Marks the tasks that a frame shows to be done. */
export function lookAt(frame: Frame): void {
  if (!isTourOpen.value || !step.value) return;
  if (watching.step !== step.value) begin(); // the page was opened in the middle of a tour
  const seconds = frame.time_s - watching.lastTime;
  watching.lastTime = frame.time_s;
  const seen = watching.watch?.(frame, seconds > 0 && seconds < 1 ? seconds : 0) ?? [];
  let areAll = true;
  const now = done.value.map((was, i) => {
    areAll &&= was || seen[i] === true;
    return areAll;
  });
  if (now.some((each, i) => each !== done.value[i])) done.value = now;
}

frameListeners.add(lookAt);
restartListeners.add(() => (watching.lastTime = NaN));
