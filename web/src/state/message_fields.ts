import {
  UNKNOWN_CHANGE,
  UNKNOWN_FRAME,
  UNKNOWN_LAP,
  UNKNOWN_LIMIT,
  UNKNOWN_PLAN,
  UNKNOWN_RUN,
  UNKNOWN_SITUATION,
} from '../protocol/messages';
import type { TopicName, Topics } from '../protocol/topics';

/** Values for fields that a sender leaves out. */
const UNKNOWN: { readonly [T in TopicName]?: Topics[T] } = {
  '/chicane/frame': UNKNOWN_FRAME,
  '/chicane/past': UNKNOWN_FRAME,
  '/chicane/plan': UNKNOWN_PLAN,
  '/chicane/run': { ...UNKNOWN_RUN, kerb_width_m: 0 }, // programs without this field drew no kerbs
  '/chicane/lap': UNKNOWN_LAP,
  '/chicane/limit': UNKNOWN_LIMIT,
  '/chicane/change': UNKNOWN_CHANGE,
  '/chicane/situation': UNKNOWN_SITUATION,
};

/** A message with every field; unknown where an older program or its recording leaves it out. */
export const complete = <T extends TopicName>(topic: T, message: Partial<Topics[T]>): Topics[T] =>
  ({ ...UNKNOWN[topic], ...message }) as Topics[T];
