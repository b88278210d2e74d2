import type { Frame } from '../protocol/topics';
import { services } from './link';
import type { Mode } from './mode';
import { answer } from './what_if';

// Parts of a tour. Whether a task is done is read from the run, not from clicks.

/** Says for each task of a step whether this frame shows that it is done; `seconds` since the frame before. */
export type Watch = (frame: Frame, seconds: number) => readonly boolean[];

/** A step of a tour. */
export interface Step {
  readonly name: string;
  readonly title: string;
  readonly text: string;
  /** The mode in which it is done. */
  readonly mode: Mode;
  /** What the step is about, in that mode: a selector; it is marked. */
  readonly where: string;
  /** What is searched for in Try; empty: nothing. */
  readonly search?: string;
  /** In their order: a task counts when those before it are done. */
  readonly tasks: readonly string[];
  isPossible(): boolean;
  /** Begins to watch. */
  watch(): Watch;
}

/** A tour. */
export interface Tour {
  readonly name: string;
  readonly title: string;
  readonly steps: readonly Step[];
  /** What was done, in one sentence, and what to do next. */
  readonly end: string;
}

const MOVING_MPS = 3; // chosen

/** Whether the controller drives the car, on the road. */
export const isDriving = (frame: Frame): boolean =>
  !frame.is_manual && frame.rung === 0 && !frame.is_off_track && frame.speed_mps > MOVING_MPS;

/** A step that asks What if; done when an answer comes. */
export const compareStep = (name: string, title: string, text: string): Step => ({
  name,
  title,
  text,
  mode: 'try',
  where: '.go',
  tasks: ['Get an answer'],
  isPossible: () => services.value.has('/what_if'),
  watch() {
    const before = answer.value;
    return () => [answer.value !== null && answer.value !== before];
  },
});
