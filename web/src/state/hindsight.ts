import { firstSince } from '../lib/math';
import { type Pose, poseAt } from '../lib/poses';
import type { Plan } from '../protocol/topics';
import { Column } from './columns';
import { planOf } from './explain';
import type { History } from './history';

/** Age of the plan that is compared with the driven path [s]. */
export const HINDSIGHT_S = 1;

/** A past plan and the path driven since; lines of the centre of mass in W. */
export interface Hindsight {
  readonly plan: Plan;
  readonly drivenX: Float64Array; // since the plan's first point
  readonly drivenY: Float64Array;
  readonly predicted: Pose | null; // the plan's pose for the present time; null beyond its end
}

/** The pose that a plan predicts for a time of the run; null outside its horizon. */
function poseOf(plan: Plan, time: number): Pose | null {
  const pose = { x: NaN, y: NaN, yaw: NaN, steer: NaN };
  return poseAt(plan, time, pose) ? pose : null;
}

/** The plan of a second ago and the path driven since; null before there is one. */
export function hindsight(plans: readonly Plan[], plots: History, now: number): Hindsight | null {
  const plan = planOf(plans, now, HINDSIGHT_S);
  if (!plan || plan.x_m.length < 2) return null;
  const from = Math.max(0, firstSince(plots.column(Column.time_s), plan.time_s[0] ?? NaN) - 1);
  return {
    plan,
    drivenX: plots.column(Column.x_m).subarray(from),
    drivenY: plots.column(Column.y_m).subarray(from),
    predicted: poseOf(plan, now),
  };
}
