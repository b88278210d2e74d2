// Tour of the dashboard: drive, let drive, slow, blind, break, tune, compare.
import { hasBit } from '../lib/bits';
import type { Frame } from '../protocol/topics';
import { run } from './run';
import { schema, settingChanges, settings } from './settings';
import { compareStep, isDriving, type Step, type Tour } from './tour_step';

/** Way or time after which a task is done; chosen. */
const BY_HAND_M = 30;
const ALONE_S = 5;
const TUNED_S = 3;

/** Whether the program offers a fault of these groups. */
const hasFault = (group: readonly string[]): boolean =>
  schema.value.some(({ key, fault }) => fault && group.includes(fault.group) && settings.value.has(key));

/** Whether a fault of these groups is active in a frame. */
function isFaulty(frame: Frame, groups: readonly string[]): boolean {
  const names = run.value?.fault_names ?? [];
  return schema.value.some(
    ({ key, fault }) =>
      fault && groups.includes(fault.group) && hasBit(frame.active_faults, names.indexOf(key.replace(/^fault\./, ''))),
  );
}

/** How the settings differ from the start of the run, as one text. */
const changesNow = (): string => settingChanges.value.map(({ key, to }) => `${key}=${to}`).join();

/** The steps, in their order. */
const STEPS: readonly Step[] = [
  {
    name: 'drive',
    title: 'Drive it yourself',
    text:
      'Take the wheel with the key M, or in the menu under “chicane”. Then the arrow keys steer, drive and brake; on ' +
      'a phone a finger on the pad. At speed that is hard: Start again (R) puts the car to the start, at rest.',
    mode: 'watch',
    where: '.name',
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
      'road, Start again (R) puts the car back to the start.',
    mode: 'watch',
    where: '.keys',
    tasks: ['Hand back', `Let it drive ${ALONE_S} s on the road; from far off it, start again first (R)`],
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
      'In slow motion you see it think: the yellow band is where the car will be during the next two ' +
      'seconds, the sentence below the picture says what it does.',
    mode: 'watch',
    where: '.name',
    tasks: ['Press twice the key [, or 0.25× in the menu', 'Back: twice the key ], or 1×'],
    isPossible: () => settings.value.has('run.pace'),
    watch: () => (frame) => [frame.pace <= 0.5, frame.pace >= 1],
  },
  {
    name: 'blind',
    title: 'Blind it',
    text:
      'Take its measurements away: press “Link lost” among the faults. It drives on by what it knew, and brakes ' +
      'if it has to wait for long.',
    mode: 'try',
    where: '[data-key="fault.link_lost"]',
    tasks: ['Inject a fault of the sensors or the link', 'Wait until it is over and the controller drives again'],
    isPossible: () => hasFault(['sensor', 'link']),
    watch: () => (frame) => [isFaulty(frame, ['sensor', 'link']), frame.active_faults === 0 && isDriving(frame)],
  },
  {
    name: 'break',
    title: 'Break it',
    text:
      'Some things no controller can mend: press “Steering stuck” shortly before a bend. An alarm in the ' +
      'strip says what happened, and what ends it.',
    mode: 'try',
    where: '[data-key="fault.steering_stuck"]',
    tasks: ['Let the car leave the road, or the guard stop it', 'Wait until it drives again, or press Start again (R)'],
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
    mode: 'try',
    where: '#search',
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
  compareStep(
    'compare',
    'Compare',
    'Was that better? Press “Drive both”: the program drives the run as it is and as it was at the start, or with ' +
      'what you change for “A second car”, from the same moment, and says what it comes to.',
  ),
];

export const DASHBOARD_TOUR: Tour = {
  name: 'dashboard',
  title: 'What the dashboard can do',
  steps: STEPS,
  end: 'You have driven, slowed, blinded, broken, tuned and compared it.',
};
