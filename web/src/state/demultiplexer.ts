import type { Change, Frame, Lap, Limit, Path, Plan, Run, TopicName, Topics } from '../protocol/topics';
import { forgetEvents, noteChange, noteEvents, setFaultNames } from './event_log';
import { forgetLaps, noteLap, receiveLap } from './laps';
import { forgetLimit, receiveLimit } from './limit';
import { forgetHistory, keepFrame, keepPlan, live } from './live';
import { complete } from './message_fields';
import { type RoadLines, receiveReference, receiveRoadLine } from './road';
import { receiveRun, run } from './run';
import { shown } from './shown';

// Messages into state: each topic's message goes to the files that hold what it says. And out of state again: what is
// forgotten when the run, or the moment of it that is shown, changes.

/** Called with each frame as it comes, also while the page is hidden; `now` as of performance.now(). */
export const frameListeners = new Set<(frame: Frame, now: number) => void>();

/** Takes one message in, of a program of any age. `now` as of performance.now(). */
export function receive<T extends TopicName>(topic: T, told: Topics[T], now: number): void {
  const message = complete(topic, told);
  switch (topic) {
    case '/chicane/frame':
      receiveFrame(message as Frame, now);
      break;
    case '/chicane/plan':
      keepPlan(message as Plan);
      break;
    case '/chicane/run':
      receiveRun(message as Run);
      setFaultNames(run.value?.fault_names ?? []);
      break;
    case '/chicane/lap':
      receiveLap(message as Lap);
      break;
    case '/chicane/limit':
      receiveLimit(message as Limit);
      break;
    case '/chicane/change':
      noteChange(message as Change);
      break;
    case '/reference':
      receiveReference(message as Path);
      break;
    case '/track/left':
    case '/track/right':
    case '/track/centre':
      receiveRoadLine(topic.slice('/track/'.length) as keyof RoadLines, message as Path);
  }
}

function receiveFrame(frame: Frame, now: number): void {
  let before = live.frame;
  if (before && frame.time_s < before.time_s) {
    forget();
    before = null;
  }
  const isNew = frame.time_s !== before?.time_s; // a paused run repeats its last frame
  keepFrame(frame, now, isNew);
  if (isNew) {
    noteEvents(frame, before);
    noteLap(frame);
  }
  for (const listener of frameListeners) listener(frame, now);
}

/**
 * Forgets where the car has been and what was plotted: it belongs to an earlier run, or to a later moment of this one.
 */
export function forget(): void {
  forgetHistory();
  forgetLaps();
  forgetEvents();
}

/** Begins another run: everything of the one before is forgotten, its last frame included. */
export function beginSession(): void {
  forget();
  forgetLimit();
  live.frame = null;
  shown.value = null;
}

/** Another moment of the same run: what was plotted is forgotten and comes again. */
export function rewind(): void {
  forget();
  live.frame = null;
}
