// The cursor of the plots on the road: where the car was at its time, and the time of a clicked place.
import { firstSince } from '../lib/math';
import { Column } from './columns';
import type { LapChannel } from './lap_samples';
import { lapSamples } from './laps';
import { cursorPlace, cursorTime, freeze, plotted } from './plot_view';

/** Where and when the cursor stands: the same in plots, map, 3D picture, laps and explanations. */
export interface CursorMark {
  readonly x: number; // in W [m]
  readonly y: number;
  readonly yaw: number; // [rad]
}

/** The car under the cursor: of the run, or of a lap that is compared; null without a cursor. */
export function cursorMark(): CursorMark | null {
  const time = cursorTime.value;
  if (time !== null) {
    const history = plotted();
    const row = firstSince(history.column(Column.time_s), time - 1e-9);
    const at = (column: number): number => history.column(column)[row] ?? NaN;
    const mark = { x: at(Column.x_m), y: at(Column.y_m), yaw: at(Column.yaw_rad) };
    return Number.isFinite(mark.x) ? mark : null;
  }
  const on = cursorPlace.value;
  if (on === null) return null;
  const at = (name: LapChannel, place: number): number => lapSamples.at(on.lap, name, place);
  const [x, y] = [at('x_m', on.place), at('y_m', on.place)];
  if (!Number.isFinite(x)) return null;
  const ahead = on.place + 2;
  const yaw = Math.atan2(at('y_m', ahead) - y, at('x_m', ahead) - x);
  return { x, y, yaw: Number.isFinite(yaw) ? yaw : 0 };
}

/** Distance from the driven path beyond which a click on the road means nothing [m]; chosen. */
const REACH_M = 25;
/** An older place counts only where it is nearer by this [m]; chosen. */
const NEARER_M = 0.5;

/** The newest time at which the car was nearest to a point [s]; null when it was never near. */
export function timeNear(x: number, y: number): number | null {
  const history = plotted();
  const [times, xs, ys] = [Column.time_s, Column.x_m, Column.y_m].map((column) => history.column(column)) as [
    Float64Array,
    Float64Array,
    Float64Array,
  ];
  let [best, nearest] = [-1, REACH_M];
  for (let i = times.length - 1; i >= 0; --i) {
    const distance = Math.hypot((xs[i] ?? NaN) - x, (ys[i] ?? NaN) - y);
    if (distance < nearest - NEARER_M) [best, nearest] = [i, distance];
  }
  return best < 0 ? null : (times[best] ?? null);
}

/** Puts the cursor where the road was clicked, and holds the plots there; returns its time [s]. */
export function pointAt(x: number, y: number): number | null {
  const time = timeNear(x, y);
  cursorTime.value = time;
  if (time !== null) freeze();
  return time;
}
