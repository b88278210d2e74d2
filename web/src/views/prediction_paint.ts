import { extent, niceCeil } from '../lib/math';
import { Column } from '../state/columns';
import { type LocalLine, rowsSince, toLocal } from '../state/explain';
import { hindsight } from '../state/hindsight';
import { live } from '../state/live';
import type { Paint } from './canvas_view';
import { chartColours } from './plot_colours';

/** A column over time, from 0 up. */
export const paintSparkline =
  (column: number, seconds: number): Paint =>
  (context, width, height) => {
    const colours = chartColours();
    const from = rowsSince(live.plots, seconds);
    const times = live.plots.column(Column.time_s).subarray(from);
    const values = live.plots.column(column).subarray(from);
    const top = niceCeil(Math.max(0.05, extent(values)?.[1] ?? 0));
    const end = times.at(-1) ?? 0;
    context.fillStyle = colours.faint;
    context.font = `11px ${colours.font}`;
    context.fillText(`${Math.round(top * 1000) / 10} cm`, 2, 11);
    context.strokeStyle = colours.grid;
    context.strokeRect(0.5, 0.5, width - 1, height - 1);
    context.beginPath();
    let isDown = false;
    for (let i = 0; i < values.length; ++i) {
      const value = values[i] ?? NaN;
      const [x, y] = [width * (1 - (end - (times[i] ?? 0)) / seconds), height - 2 - (value / top) * (height - 4)];
      if (!Number.isFinite(value)) isDown = false;
      else if (isDown) context.lineTo(x, y);
      else context.moveTo(x, y);
      isDown = Number.isFinite(value);
    }
    context.strokeStyle = colours.series[0] ?? colours.text;
    context.lineWidth = 1.5;
    context.stroke();
  };

function strokeLine(
  context: CanvasRenderingContext2D,
  line: LocalLine,
  x: (ahead: number) => number,
  y: (left: number) => number,
): void {
  context.beginPath();
  line.ahead.forEach((ahead, i) => context.lineTo(x(ahead), y(line.left[i] ?? 0)));
  context.stroke();
}

/**
 * The plan of a second ago in the car's axes at that time, with the path driven since; stretched sideways to show
 * centimetres.
 */
export const paintPrediction: Paint = (context, width, height) => {
  const colours = chartColours();
  const seen = hindsight(live.pastPlans, live.plots, live.frame?.time_s ?? NaN);
  context.font = `11px ${colours.font}`;
  context.fillStyle = colours.faint;
  if (!seen) return context.fillText('No plan yet', 8, 16);
  const { plan, drivenX, drivenY } = seen;
  const pose = { x: plan.x_m[0] ?? 0, y: plan.y_m[0] ?? 0, yaw: plan.yaw_rad[0] ?? 0 };
  const planned = toLocal(plan.x_m, plan.y_m, pose);
  const driven = toLocal(drivenX, drivenY, pose);

  const reach = Math.max(10, (planned.ahead.at(-1) ?? 0) * 1.02);
  const [low, high] = extent([...planned.left, ...driven.left]) ?? [0, 0];
  const tall = Math.max(2, (high - low) * 1.25);
  const middle = (low + high) / 2;
  const x = (ahead: number): number => 8 + (ahead / reach) * (width - 16);
  const y = (left: number): number => height / 2 - ((left - middle) / tall) * (height - 18);
  context.lineJoin = context.lineCap = 'round';
  context.lineWidth = 6;
  context.globalAlpha = 0.4;
  context.strokeStyle = colours.series[1] ?? colours.text;
  strokeLine(context, planned, x, y);
  context.globalAlpha = 1;
  context.lineWidth = 2;
  context.strokeStyle = colours.series[0] ?? colours.text;
  strokeLine(context, driven, x, y);
  context.textAlign = 'right';
  context.fillText(`${reach.toFixed(0)} m ahead, ${tall.toFixed(1)} m across`, width - 4, height - 5);
  context.textAlign = 'left';
  context.fillStyle = colours.series[1] ?? colours.text;
  context.fillText('planned', 6, 12);
  context.fillStyle = colours.series[0] ?? colours.text;
  context.fillText('driven', 56, 12);
};
