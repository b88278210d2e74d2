// Distributes messages, by topic, to the modules that hold their content; and clears these when the run changes or a
// recording jumps to another time.
import { store } from '../lib/store';
import { complete, type Frame, type Plan, type TopicName, type Topics } from '../protocol/topics';
import { forgetFrameEvents, noteChange, noteEvents, noteNotices, setFaultNames } from './event_log';
import { forgetFaultMarks, noteFaultChange, noteFaultMarks } from './faults';
import { forgetSamples, noteLap, receiveLap } from './laps';
import { receiveLimit } from './limit';
import { forgetRows, keepFrame, keepPlan, live } from './live';
import { Past } from './past';
import { isReplaying, keepRecent } from './replay';
import { receiveReference, receiveRoadLine } from './road';
import { receiveRun, run } from './run';
import { receiveSituation } from './situation';

/** Called with each frame on arrival, also while the page is hidden; `now` as of performance.now() [ms]. */
export const frameListeners = new Set<(frame: Frame, now: number) => void>();

/** Called when the run that is shown has begun again. */
export const restartListeners = new Set<() => void>();

/** Called when all frames of the run follow once more, because older ones have come. */
export const rebuildListeners = new Set<() => void>();

/** The newest frame and plan. */
const last = store.data('moment', () => ({ frame: null as Frame | null, plan: null as Plan | null }));
const past = new Past();

/** What each topic's messages are stored by; `now` as of performance.now() [ms]. */
const RECEIVERS: { readonly [T in TopicName]: (message: Topics[T], now: number) => void } = {
  '/chicane/frame': receiveFrame,
  '/chicane/past': (frame) => past.keepBefore(frame),
  '/chicane/situation': receiveSituation,
  '/chicane/plan': (plan) => {
    last.plan = plan;
    keepPlan(plan, !isReplaying());
  },
  '/chicane/run': (description) => {
    receiveRun(description);
    setFaultNames(description.fault_names);
    noteNotices(description.notices);
  },
  '/chicane/lap': receiveLap,
  '/chicane/limit': receiveLimit,
  '/chicane/change': (change) => {
    noteChange(change);
    noteFaultChange(change);
  },
  '/reference': receiveReference,
  '/track/left': (path) => receiveRoadLine('left', path),
  '/track/right': (path) => receiveRoadLine('right', path),
  '/track/centre': (path) => receiveRoadLine('centre', path),
};

/** Stores one message, also of an older program. `now` as of performance.now() [ms]. */
export function receive<T extends TopicName>(topic: T, sent: Topics[T], now: number): void {
  RECEIVERS[topic](complete(topic, sent), now);
}

/** Stores a frame; one with an earlier time begins the run again. */
function receiveFrame(frame: Frame, now: number): void {
  let before = last.frame;
  if (before && frame.time_s < before.time_s) {
    store.reset('moment');
    noteNotices(run.value?.notices ?? []);
    past.drop();
    for (const listener of restartListeners) listener();
    before = null;
  }
  const isNew = frame.time_s !== before?.time_s; // a paused run repeats its last frame
  const isShown = !isReplaying();
  last.frame = frame;
  keepFrame(frame, now, isNew, isShown);
  if (isNew) {
    past.keepNew(frame);
    keepRecent(frame, last.plan);
    noteEvents(frame, before);
    noteFaultMarks(frame, before);
    noteLap(frame);
  }
  if (isShown) for (const listener of frameListeners) listener(frame, now);
}

/**
 * Takes how many frames of the past are still to come. From time to time, and when all are here, history, samples of
 * laps and events are computed again from all frames.
 */
export function receivePastLeft(left: number, now: number): void {
  const frames = past.take(left, now);
  if (!frames) return;
  const [plan, isShown] = [live.plan, !isReplaying()];
  forgetRows();
  forgetSamples();
  forgetFrameEvents();
  forgetFaultMarks();
  for (const listener of rebuildListeners) listener();
  let before: Frame | null = null;
  for (const frame of frames) {
    keepFrame(frame, now, true, false); // the newest one is shown already
    noteEvents(frame, before);
    noteFaultMarks(frame, before);
    noteLap(frame);
    if (isShown) for (const listener of frameListeners) listener(frame, now);
    before = frame;
  }
  live.plan = plan;
}

/**
 * Clears the state before messages that describe a run from its beginning. The last frame of the same run stays on the
 * screen until they come.
 */
export function beginSession(isOtherRun = true): void {
  store.reset(isOtherRun ? 'run' : 'moment');
  past.expect();
}

/** Jumps to another time of a recording: its history is cleared and sent again. */
export function rewind(): void {
  store.reset('moment');
  noteNotices(run.value?.notices ?? []);
}
