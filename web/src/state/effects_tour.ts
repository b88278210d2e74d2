import type { Frame } from '../protocol/topics';
import { run } from './run';
import { entryOf, settings, startSettings } from './settings';
import { compareStep, isDriving, type Step, type Tour } from './tour_step';

// What N, dt, a weight and the latency do to a controller as the write-ups have it: each changed, seen, and taken back.
// docs/effects.md has the same changes with their laps.

const PRESET = 'fast-short-step';
const WATCHED_S = 5; // chosen
const MPH = 0.44704; // [m/s]

const isFasterThan = (mph: number) => (frame: Frame) => isDriving(frame) && frame.speed_mps > mph * MPH;
const isSlowerThan = (mph: number) => (frame: Frame) => isDriving(frame) && frame.speed_mps < mph * MPH;
/** Whether the car is farther from its line than the preset ever is, or not driven by the controller. */
const isWide = (frame: Frame): boolean => Math.abs(frame.lateral_error_m) > 1.5 || frame.rung !== 0;

/** An effect of a setting, and how it is seen. */
interface Effect extends Pick<Step, 'name' | 'title' | 'text'> {
  readonly key: string;
  /** What it is set to, or beyond. */
  readonly to: number;
  /** The two things to do before it is taken back. */
  readonly tasks: readonly [string, string];
  /** Whether a frame shows what the setting does. */
  isSeen(frame: Frame): boolean;
}

/** The step of the tour for an effect: set, seen, taken back. */
function stepOf({ key, to, tasks, isSeen, ...rest }: Effect): Step {
  return {
    ...rest,
    mode: 'try',
    where: `.setting[data-key="${key}"]`,
    search: key,
    tasks: [...tasks, 'Take it back'],
    isPossible: () => run.value?.controller === 'cubic-mpc' && settings.value.has(key),
    watch: () => (frame) => {
      const now = Number(settings.value.get(key));
      const start = Number(startSettings.value.get(key));
      const isSet = to > start ? now >= to : now <= to;
      return [isSet, isSet && isSeen(frame), now === start];
    },
  };
}

/** The effects, in the order of the tour. */
const EFFECTS: readonly Effect[] = [
  {
    name: 'horizon',
    title: 'N: look further ahead',
    text:
      'The plan looks N steps ahead: 25 of 0.025 s, the short line before the car. The longer it is, the more a ' +
      'higher speed saves: N = 40 is faster. Much longer plans cut the bends. Search for it; ↺ takes it back.',
    key: 'cubic_mpc.horizon_steps',
    to: 40,
    tasks: ['Set N, “Horizon steps”, to 40', 'Watch it drive faster than 60 mph: the preset reaches 50'],
    isSeen: isFasterThan(60),
  },
  {
    name: 'step',
    title: 'dt: longer steps',
    text:
      'dt is the time between two points of the plan. With 25 steps of 0.1 s the plan is four times as long and four ' +
      'times as coarse: the car drives up to 100 mph, and strays from its line where it should turn.',
    key: 'cubic_mpc.step_length_s',
    to: 0.1,
    tasks: ['Set dt, “Step length”, to 0.1 s', 'Watch it stray 1.5 m from its line, or the guard stop it'],
    isSeen: isWide,
  },
  {
    name: 'weight',
    title: 'A weight: the cost of the pedal',
    text:
      'The reference of 180 mph is never reached: the weight of the speed error pulls against the weight of the ' +
      'throttle. The write-up has 80 for 50 mph, and 48 for its fast lap. With 160 the same controller drives 29 mph.',
    key: 'cubic_mpc.weight_throttle',
    to: 160,
    tasks: ['Set “Weight throttle” to 160', 'Watch it slow down below 33 mph'],
    isSeen: isSlowerThan(33),
  },
  {
    name: 'latency',
    title: 'Latency: more than it counts on',
    text:
      'Commands act 100 ms late, and the controller rolls its state forward by 100 ms before it plans. With 300 ms ' +
      'it still compensates 100: it corrects errors that are being corrected already, and weaves.',
    key: 'latency_ms',
    to: 300,
    tasks: ['Set the latency to 300 ms', 'Watch it stray 1.5 m from its line, or the guard stop it'],
    isSeen: isWide,
  },
];

/** The step that brings the controller of the tour. */
const CHOOSE: Step = {
  name: 'choose',
  title: 'Choose a controller to change',
  text:
    `${PRESET} is the controller of one of five public write-ups: N, dt, weights and latency as its author ` +
    'describes them. The choice restarts the run.',
  mode: 'try',
  where: '.choices [data-key="preset"] select',
  tasks: [`Choose the preset ${PRESET}`, `Let it drive ${WATCHED_S} s`],
  isPossible: () => run.value?.preset === PRESET || (entryOf('preset')?.choices.length ?? 0) > 0,
  watch() {
    let watched = 0;
    return (frame, seconds) => {
      const isChosen = run.value?.preset === PRESET;
      if (isChosen && isDriving(frame)) watched += seconds;
      return [isChosen, watched >= WATCHED_S];
    };
  },
};

const COMPARE = compareStep(
  'without',
  'Compare: without the roll-forward',
  'What is the roll-forward worth at 100 ms? Let the sliders change “A second car”, search for “latency handling” ' +
    'and choose none, then “Drive both”: two futures from the same moment.',
);

export const EFFECTS_TOUR: Tour = {
  name: 'effects',
  title: 'What N, dt, weights and latency do',
  steps: [CHOOSE, ...EFFECTS.map(stepOf), COMPARE],
  end: 'You have seen what N, dt, a weight and the latency do. docs/effects.md has their laps.',
};
