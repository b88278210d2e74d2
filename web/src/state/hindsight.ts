// Comparison of a past plan with the path that the car has driven since.
import { firstSince } from '../lib/math';
import { type Pose, poseAt } from '../lib/poses';
import type { Plan } from '../protocol/topics';
import { Column } from './columns';
import { planOf } from './explain';
import type { History } from './history';

/** Age of the plan that is compared with the driven path [s]; chosen. */
export const HINDSIGHT_S = 1;

/** A past plan and the path driven since, as lines of the centre of mass in world coordinates [m]. */
export interface Hindsight {
  readonly plan: Plan;
  readonly drivenX: Float64Array; // path from the plan's first point to now
  readonly drivenY: Float64Array;
  readonly predicted: Pose | null; // planned pose for the present time; null beyond the plan's end
}

/** Pose that a plan predicts for a time of the run [s]; null outside its horizon. */
function poseOf(plan: Plan, time: number): Pose | null {
  const pose = { x: NaN, y: NaN, yaw: NaN, steer: NaN };
  return poseAt(plan, time, pose) ? pose : null;
}

/** Comparison of the plan of HINDSIGHT_S ago with `plots`; null before there is such a plan. `now`: time of the run. */
export function hindsight(plans: readonly Plan[], plots: History, now: number): Hindsight | null {
  const plan = planOf(plans, now, HINDSIGHT_S);
  if (!plan || plan.x_m.length < 2) return null;
  // The path begins one sample early, so that it covers the plan's first point.
  const from = Math.max(0, firstSince(plots.column(Column.time_s), plan.time_s[0] ?? NaN) - 1);
  return {
    plan,
    drivenX: plots.column(Column.x_m).subarray(from),
    drivenY: plots.column(Column.y_m).subarray(from),
    predicted: poseOf(plan, now),
  };
}
