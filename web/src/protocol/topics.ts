import type { Change, Frame, Lap, Limit, Plan, Run, Situation } from './messages';

// What this page subscribes to. Messages of our own are made from their definitions (messages.ts).

export type { Change, Frame, Lap, Limit, Plan, Run, Situation, Stamp } from './messages';

/** The part of nav_msgs/msg/Path this page draws. */
export interface Path {
  poses: { pose: { position: { x: number; y: number } } }[];
}

/** The topics this page subscribes to, with their message types. */
export interface Topics {
  '/chicane/frame': Frame;
  '/chicane/situation': Situation;
  '/chicane/plan': Plan;
  '/chicane/run': Run;
  '/reference': Path;
  '/track/left': Path;
  '/track/right': Path;
  '/track/centre': Path;
  '/chicane/lap': Lap;
  '/chicane/change': Change;
  '/chicane/limit': Limit;
  /** Frames from before the page came, the newest first. */
  '/chicane/past': Frame;
}

export type TopicName = keyof Topics;

export const TOPIC_NAMES: readonly TopicName[] = [
  '/chicane/frame',
  '/chicane/situation',
  '/chicane/plan',
  '/chicane/run',
  '/reference',
  '/track/left',
  '/track/right',
  '/track/centre',
  '/chicane/lap',
  '/chicane/change',
  '/chicane/limit',
  '/chicane/past',
];
