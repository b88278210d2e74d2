import { firstSince } from '../draw/axis';
import { fixed } from '../lib/format';
import { extent, mix, niceCeil } from '../lib/math';
import { store } from '../lib/store';
import { Column } from '../state/columns';
import { cursorTime, isFrozen, plotted, timeRange } from '../state/plot_view';
import { shown } from '../state/shown';
import { CanvasView } from './canvas_view';
import { chartColours } from './plot_colours';

const G = 9.80665; // standard gravity [m/s²]

/**
 * The radius of the grip circle [m/s²]: the acceleration at which the axle that uses more of its grip would use all of
 * it, extrapolated linearly. Known in fast bends only, where the tyre forces accelerate the car; on a straight most of
 * them balance the drag. NaN elsewhere, and where the use of grip is unknown.
 */
export function gripRadius(lateral: number, frontUse: number, rearUse: number): number {
  const use = Math.max(frontUse, rearUse);
  return use > 0.5 && Math.abs(lateral) > 3 ? Math.abs(lateral) / use : NaN;
}

/** What the diagram reaches to, so that trail and grip circle lie within it, in the unit of both. */
export const reachOf = (most: number, radius: number): number =>
  niceCeil(Math.max(0.5, most * 1.08, Number.isFinite(radius) ? radius * 1.02 : 0));

const circle = store.data('page', () => ({ radius: NaN })); // smoothed [g]

function paint(context: CanvasRenderingContext2D, width: number, height: number): void {
  const colours = chartColours();
  const history = plotted();
  const times = history.column(Column.time_s);
  const [from, to] = timeRange();
  const [first, end] = [firstSince(times, from), firstSince(times, to + 1e-9)];
  const across = history.column(Column.lateral_acceleration_mps2).subarray(first, end);
  const along = history.column(Column.longitudinal_acceleration_mps2).subarray(first, end);
  const most = Math.max(...[across, along].flatMap((values) => (extent(values) ?? [0, 0]).map(Math.abs))) / G;
  const newest = across.length - 1;
  renewGrip(newest + first);
  const { radius } = circle;
  const scale = reachOf(most, radius);
  const [middleX, middleY] = [width / 2, height / 2];
  const pixels = (Math.min(width, height) / 2 - 16) / scale;

  context.lineWidth = 1;
  context.font = `11px ${colours.font}`;
  context.fillStyle = colours.faint;
  const step = scale > 4 ? 2 : scale > 1.5 ? 1 : 0.5;
  for (let ring = step; ring <= scale + 1e-9; ring += step) {
    context.strokeStyle = colours.grid;
    context.beginPath();
    context.arc(middleX, middleY, ring * pixels, 0, 2 * Math.PI);
    context.stroke();
    context.fillText(`${ring} g`, middleX + 4, middleY - ring * pixels - 3);
  }
  context.beginPath();
  for (const [dx, dy] of [
    [1, 0],
    [0, 1],
  ] as const) {
    context.moveTo(middleX - dx * scale * pixels, middleY - dy * scale * pixels);
    context.lineTo(middleX + dx * scale * pixels, middleY + dy * scale * pixels);
  }
  context.strokeStyle = colours.grid;
  context.stroke();

  drawGrip(context, middleX, middleY, pixels);
  // Left is positive in the data and on the left on the screen; accelerating is up.
  const x = (i: number): number => middleX - ((across[i] ?? NaN) / G) * pixels;
  const y = (i: number): number => middleY - ((along[i] ?? NaN) / G) * pixels;
  drawTrail(context, x, y, across.length);
  const mark = cursorTime.value === null ? newest : firstSince(times, cursorTime.value - 1e-9) - first;
  if (mark < 0 || mark > newest) return;
  context.beginPath();
  context.arc(x(mark), y(mark), 5.5, 0, 2 * Math.PI);
  context.fillStyle = colours.series[1] ?? colours.text;
  context.strokeStyle = colours.panel;
  context.lineWidth = 2;
  context.fill();
  context.stroke();
}

/** The trail, fading with age; drawn in sixteen strokes. */
function drawTrail(
  context: CanvasRenderingContext2D,
  x: (i: number) => number,
  y: (i: number) => number,
  count: number,
): void {
  const colours = chartColours();
  context.lineWidth = 1.75;
  context.lineJoin = 'round';
  context.strokeStyle = colours.series[0] ?? colours.text;
  for (let part = 0; part < 16; ++part) {
    const [from, to] = [Math.floor((part * count) / 16), Math.floor(((part + 1) * count) / 16)];
    context.globalAlpha = 0.1 + 0.9 * ((part + 1) / 16) ** 2;
    context.beginPath();
    for (let i = Math.max(0, from - 1); i < to; ++i) context.lineTo(x(i), y(i));
    context.stroke();
  }
  context.globalAlpha = 1;
}

function renewGrip(row: number): void {
  const history = plotted();
  const value = (column: number): number => history.column(column)[row] ?? NaN;
  const now =
    gripRadius(value(Column.lateral_acceleration_mps2), value(Column.front_tire_use), value(Column.rear_tire_use)) / G;
  if (Number.isFinite(now)) circle.radius = Number.isFinite(circle.radius) ? mix(circle.radius, now, 0.2) : now;
}

function drawGrip(context: CanvasRenderingContext2D, x: number, y: number, pixels: number): void {
  const { radius } = circle;
  if (!Number.isFinite(radius)) return;
  context.beginPath();
  context.arc(x, y, radius * pixels, 0, 2 * Math.PI);
  context.setLineDash([5, 4]);
  context.lineWidth = 1.5;
  context.strokeStyle = chartColours().bad;
  context.stroke();
  context.setLineDash([]);
}

/** The g-g diagram: lateral and longitudinal acceleration, now and over the time shown. */
export function GgView() {
  const frame = shown.value;
  const [across, along] = [
    (frame?.lateral_acceleration_mps2 ?? NaN) / G,
    (frame?.longitudinal_acceleration_mps2 ?? NaN) / G,
  ];
  return (
    <section class="plot square" aria-label="Acceleration">
      <header>
        <h2>
          Acceleration <span class="unit">g, braking down</span>
        </h2>
        <p>
          <span class="key">
            <b>{fixed(Math.hypot(across, along), 2)}</b>
          </span>
          <span class="key">
            <span class="stroke dashed" style={{ borderColor: 'var(--lost)' }} />
            grip
          </span>
        </p>
      </header>
      <CanvasView
        label="Acceleration across against along the car, with the circle of grip"
        paint={paint}
        version={() => `${plotted().newest(Column.time_s)} ${timeRange().join()} ${isFrozen.value} ${cursorTime.value}`}
        interval={100}
      />
    </section>
  );
}
