import { firstSince } from '../draw/axis';
import { mix, wrapAngle } from '../lib/math';
import type { Plan } from '../protocol/topics';
import { Column } from './columns';
import { planOf } from './explain';
import type { History } from './history';

/** Age of the plan that is compared with the driven path [s]. */
export const HINDSIGHT_S = 1;

export interface Pose {
  readonly x: number;
  readonly y: number;
  readonly yaw: number;
}

/** A past plan and the path driven since; lines of the centre of mass in W. */
export interface Hindsight {
  readonly plan: Plan;
  readonly drivenX: Float64Array; // since the plan's first point
  readonly drivenY: Float64Array;
  readonly predicted: Pose | null; // the plan's pose for the present time; null beyond its end
}

/** The pose that a plan predicts for a time of the run, linear between its points; null outside its horizon. */
export function poseOf(plan: Plan, time: number): Pose | null {
  const times = plan.time_s;
  const next = firstSince(times, time);
  const first = times[0] ?? NaN;
  if (next >= times.length || !(time >= first)) return null;
  if (next === 0) return { x: plan.x_m[0] ?? NaN, y: plan.y_m[0] ?? NaN, yaw: plan.yaw_rad[0] ?? NaN };
  const at = (values: ArrayLike<number>, i: number): number => values[i] ?? NaN;
  const share = (time - at(times, next - 1)) / (at(times, next) - at(times, next - 1));
  const yaw = at(plan.yaw_rad, next - 1);
  return {
    x: mix(at(plan.x_m, next - 1), at(plan.x_m, next), share),
    y: mix(at(plan.y_m, next - 1), at(plan.y_m, next), share),
    yaw: yaw + wrapAngle(at(plan.yaw_rad, next) - yaw) * share,
  };
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
