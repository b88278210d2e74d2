import { computed } from '@preact/signals';
import { hasBit } from '../lib/bits';
import { persisted } from '../lib/persisted';
import { store } from '../lib/store';
import type { Frame } from '../protocol/topics';
import { frameListeners, restartListeners } from './demultiplexer';
import { services } from './link';
import { run } from './run';
import { schema, settingChanges, settings } from './settings';
import type { Tab } from './tab';
import { answer } from './what_if';

// A tour of the dashboard for newcomers: seven things to do. What was done is read from the run, not from clicks.

/** Says for each task of a step whether this frame shows that it is done; `seconds` since the frame before. */
type Watch = (frame: Frame, seconds: number) => readonly boolean[];

export interface Step {
  readonly name: string;
  readonly title: string;
  readonly text: string;
  /** The panel on which it is done. */
  readonly tab: Tab;
  /** What the step is about, on that panel: a selector, as in tour.css, which marks it. */
  readonly where: string;
  /** In their order: a task counts when those before it are done. */
  readonly tasks: readonly string[];
  isPossible(): boolean;
  /** Begins to watch. */
  watch(): Watch;
}

const BY_HAND_M = 30;
const ALONE_S = 5;
const TUNED_S = 3;
const MOVING_MPS = 3;

const hasFault = (group: readonly string[]): boolean =>
  schema.value.some(({ key, fault }) => fault && group.includes(fault.group) && settings.value.has(key));

function isFaulty(frame: Frame, groups: readonly string[]): boolean {
  const names = run.value?.fault_names ?? [];
  return schema.value.some(
    ({ key, fault }) =>
      fault && groups.includes(fault.group) && hasBit(frame.active_faults, names.indexOf(key.replace(/^fault\./, ''))),
  );
}

const isDriving = (frame: Frame): boolean =>
  !frame.is_manual && frame.rung === 0 && !frame.is_off_track && frame.speed_mps > MOVING_MPS;

/** How the settings differ from the start of the run, as one text. */
const changesNow = (): string => settingChanges.value.map(({ key, to }) => `${key}=${to}`).join();

export const STEPS: readonly Step[] = [
  {
    name: 'drive',
    title: 'Drive it yourself',
    text:
      'Take the wheel with the button or the key M. Then the arrow keys steer, drive and brake; a ' +
      'finger or the mouse does it on the pad. At speed that is hard: Reset (R) puts the car to the start, at rest.',
    tab: 'drive',
    where: '.manual-row button',
    tasks: ['Take the wheel', `Drive ${BY_HAND_M} m`],
    isPossible: () => settings.value.has('manual.is_on'),
    watch() {
      let metres = 0;
      return (frame, seconds) => {
        if (frame.is_manual) metres += frame.speed_mps * seconds;
        return [frame.is_manual, metres >= BY_HAND_M];
      };
    },
  },
  {
    name: 'let',
    title: 'Let it drive',
    text:
      'Hand back with the button or Esc: the controller goes on from where you are. From far off the ' +
      'road, Reset (R) puts the car back to the start.',
    tab: 'drive',
    where: '.manual-row button',
    tasks: ['Hand back', `Let it drive ${ALONE_S} s on the road; from far off it, press Reset first`],
    isPossible: () => settings.value.has('manual.is_on'),
    watch() {
      let alone = 0;
      return (frame, seconds) => {
        if (isDriving(frame)) alone += seconds;
        return [!frame.is_manual, alone >= ALONE_S];
      };
    },
  },
  {
    name: 'slow',
    title: 'Slow it',
    text:
      'In slow motion you see it think: the coloured band is where the car will be during the next two ' +
      'seconds, the sentence on the picture says why it is no faster.',
    tab: 'drive',
    where: '.pace .segments',
    tasks: ['Press 0.25× or twice the key [', 'Press 1× again'],
    isPossible: () => settings.value.has('run.pace'),
    watch: () => (frame) => [frame.pace <= 0.5, frame.pace >= 1],
  },
  {
    name: 'blind',
    title: 'Blind it',
    text:
      'Take its measurements away: click the card “Link lost” below. It drives on by what it knew, and brakes if it ' +
      'has to wait for long.',
    tab: 'faults',
    where: '.fault-card:has([data-key="fault.link_lost"])',
    tasks: ['Inject a fault of the sensors or the link', 'Wait until it is over and the controller drives again'],
    isPossible: () => hasFault(['sensor', 'link']),
    watch: () => (frame) => [isFaulty(frame, ['sensor', 'link']), frame.active_faults === 0 && isDriving(frame)],
  },
  {
    name: 'break',
    title: 'Break it',
    text:
      'Some things no controller can mend: click the card “Steering stuck” below, shortly before a bend. The frame ' +
      'of the picture turns red.',
    tab: 'faults',
    where: '.fault-card:has([data-key="fault.steering_stuck"])',
    tasks: ['Let the car leave the road, or the guard stop it', 'Wait until it drives again, or press Reset'],
    isPossible: () => hasFault(['actuator', 'road']),
    watch() {
      let isBroken = false; // a stop for another reason does not count
      return (frame) => {
        isBroken ||= isFaulty(frame, ['actuator', 'road']);
        return [
          isBroken && !frame.is_manual && (frame.is_off_track || frame.rung !== 0),
          frame.active_faults === 0 && isDriving(frame),
        ];
      };
    },
  },
  {
    name: 'tune',
    title: 'Tune it',
    text:
      'Every setting acts at once. Search for “speed limit” and set it to 15 m/s, or move any slider: ' +
      'the list of changes keeps what you did, and takes it back.',
    tab: 'tune',
    where: '#tune-search',
    tasks: ['Change a setting', `Watch it for ${TUNED_S} s`],
    isPossible: () =>
      schema.value.some(({ key, is_live, is_fixed }) => is_live && !is_fixed && settings.value.has(key)),
    watch() {
      const before = changesNow();
      let tuned = 0;
      return (frame, seconds) => {
        const isChanged = settingChanges.value.length > 0 && changesNow() !== before;
        if (isChanged && isDriving(frame)) tuned += seconds;
        return [isChanged, tuned >= TUNED_S];
      };
    },
  },
  {
    name: 'compare',
    title: 'Compare',
    text:
      'Was that better? “As at the start” undoes your change, or choose a setting and another value for it; then ' +
      '“Drive both”: the program drives both futures from the same moment, and sets them side by side.',
    tab: 'whatif',
    where: '.what-if-search',
    tasks: ['Get an answer'],
    isPossible: () => services.value.has('/what_if'),
    watch() {
      const before = answer.value;
      return () => [answer.value !== null && answer.value !== before];
    },
  },
];

const isStep = (value: unknown): boolean =>
  Number.isInteger(value) && Number(value) >= 0 && Number(value) <= STEPS.length;

/** The step that is shown or will be gone on with; the number of steps: all are behind. Kept by the browser. */
export const stepNumber = persisted<number>('tour.step', 0, isStep);
export const isTourOpen = persisted<boolean>('tour.open', false);
/** Steps that were left out. */
const left = persisted<string>('tour.skipped', '');
export const skipped = computed<readonly string[]>(() => left.value.split(',').filter((name) => name !== ''));

export const step = computed<Step | null>(() => STEPS[stepNumber.value] ?? null);
/** For each task of the step whether it is done. */
export const done = store.signal<readonly boolean[]>('page', []);
export const isStepDone = computed(() => done.value.length > 0 && done.value.every(Boolean));

const watching = store.data('page', () => ({
  watch: null as Watch | null,
  step: null as Step | null,
  lastTime: NaN,
}));

function begin(): void {
  watching.step = step.value;
  watching.watch = step.value?.watch() ?? null;
  done.value = (step.value?.tasks ?? []).map(() => false);
  watching.lastTime = NaN;
}

/** Opens the tour where it was left; from the beginning when it was finished. */
export function openTour(): void {
  if (stepNumber.value >= STEPS.length) {
    stepNumber.value = 0;
    left.value = '';
  }
  isTourOpen.value = true;
  begin();
}

export function leaveTour(): void {
  isTourOpen.value = false;
}

/** On to the next step: when this one is done, or left out. */
export function goOn(): void {
  if (!isStepDone.value && step.value) left.value = [...skipped.value, step.value.name].join();
  stepNumber.value = Math.min(STEPS.length, stepNumber.value + 1);
  begin();
}

/** Looks at a frame of the run. */
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
