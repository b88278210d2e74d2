// Topics that this page subscribes to, with the types and default values of their messages.
import {
  type Stamp,
  UNKNOWN_CHANGE,
  UNKNOWN_FRAME,
  UNKNOWN_LAP,
  UNKNOWN_LIMIT,
  UNKNOWN_PLAN,
  UNKNOWN_RUN,
  UNKNOWN_SITUATION,
} from './messages';

export type { Change, Frame, Lap, Limit, Plan, Run, Situation } from './messages';

/** When a message was sent, on the time line of the run [s]. */
export const timeOf = ({ stamp }: { readonly stamp: Stamp }): number => stamp.sec + stamp.nsec / 1e9;

/** The part of nav_msgs/msg/Path this page draws. */
export interface Path {
  poses: { pose: { position: { x: number; y: number } } }[];
}

const NO_PATH: Path = { poses: [] };

/** What this page subscribes to, with values for fields that a sender leaves out. */
const UNKNOWN = {
  '/chicane/frame': UNKNOWN_FRAME,
  '/chicane/situation': UNKNOWN_SITUATION,
  '/chicane/plan': UNKNOWN_PLAN,
  '/chicane/run': { ...UNKNOWN_RUN, kerb_width_m: 0 }, // programs without this field drew no kerbs
  '/reference': NO_PATH,
  '/track/left': NO_PATH,
  '/track/right': NO_PATH,
  '/track/centre': NO_PATH,
  '/chicane/lap': UNKNOWN_LAP,
  '/chicane/change': UNKNOWN_CHANGE,
  '/chicane/limit': UNKNOWN_LIMIT,
  '/chicane/past': UNKNOWN_FRAME, // frames from before the page came, the newest first
};

export type TopicName = keyof typeof UNKNOWN;
/** The topics with their message types. */
export type Topics = { readonly [T in TopicName]: (typeof UNKNOWN)[T] };

export const TOPIC_NAMES = Object.keys(UNKNOWN) as readonly TopicName[];

/** A message with every field; unknown where an older program or its recording leaves it out. */
export const complete = <T extends TopicName>(topic: T, message: Partial<Topics[T]>): Topics[T] =>
  ({ ...UNKNOWN[topic], ...message }) as Topics[T];
