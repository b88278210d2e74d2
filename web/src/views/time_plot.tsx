// One plot over time, on a canvas, with its legend and cursor.
import { effect } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import { ticksOf } from '../draw/axis';
import { type Chart, chartOn, drawAxes, drawCurve, ROOM } from '../draw/chart';
import { Paper } from '../draw/paper';
import { onThemeChange, theme, toneOf } from '../draw/theme';
import { fixed } from '../lib/format';
import { firstSince } from '../lib/math';
import { tidy } from '../lib/scale';
import { store } from '../lib/store';
import { Column } from '../state/columns';
import { cursorTime, isFrozen, markTime, plotted, thaw, timeRange, windowSeconds, zoomed } from '../state/plot_view';
import { shown } from '../state/shown';
import { LONGEST_SILENCE_S } from '../state/silence';
import { everyFrame } from '../state/ticker';
import { drawFaultBands } from './plot_bands';
import { PlotPointer } from './plot_pointer';

/** A curve of a plot: a column of the history. */
export interface Series {
  readonly column: number;
  readonly label: string;
  readonly colour: number; // of Theme.series, from 0
  readonly isDashed?: boolean;
  readonly isFilled?: boolean; // down to the previous series, or to 0
  readonly factor?: number; // from the column's unit to the plot's
}

/** Content of a plot. */
export interface PlotSpec {
  readonly title: string;
  readonly unit: string;
  readonly decimals: number;
  readonly series: readonly Series[];
  readonly range: (columns: readonly ArrayLike<number>[]) => [number, number];
  /** Strokes under the lines. */
  readonly under?: (chart: Chart) => void;
}

/**
 * Ticks of the time axis: relative to now while the plot follows the run, so that the grid stands still; else run time.
 */
const ticksOfTime = (low: number, high: number): number[] =>
  // Times of the run are long labels, so fewer.
  zoomed.value ? ticksOf(low, high, 4.5) : ticksOf(low - high, 0, 6.5).map((back) => high + back);

/** Label of a tick of the time axis. */
function timeLabel(time: number, last: number): string {
  if (zoomed.value) return `${tidy(time)} s`;
  if (time !== last) return `−${tidy(Math.round((last - time) * 10) / 10)} s`;
  return isFrozen.value ? `${fixed(time, 1)} s` : 'now';
}

/** Time and columns of a plot over the range of its axis, with one more point on each side. */
function dataOf(spec: PlotSpec): Float64Array[] {
  const history = plotted();
  const times = history.column(Column.time_s);
  const [from, to] = timeRange();
  const first = Math.max(0, firstSince(times, from) - 1);
  const end = firstSince(times, to) + 2;
  const part = (column: number): Float64Array => history.column(column).subarray(first, end);
  return [
    part(Column.time_s),
    ...spec.series.map(({ column, factor = 1 }) =>
      factor === 1 ? part(column) : part(column).map((value) => value * factor),
    ),
  ];
}

/** The value of a series at a time; the newest one without a time. */
function valueAt({ column, factor = 1 }: Series, time: number | null): number {
  const history = plotted();
  const row = time === null ? history.length - 1 : firstSince(history.column(Column.time_s), time - 1e-9);
  return (history.column(column)[row] ?? NaN) * factor;
}

/** Text of the value under the cursor, or of the newest one; with a mark also the difference from the mark. */
function readout(series: Series, decimals: number): string {
  const value = valueAt(series, cursorTime.value);
  const mark = markTime.value;
  if (mark === null) return fixed(value, decimals);
  const difference = value - valueAt(series, mark);
  return `${fixed(value, decimals)} (Δ ${difference > 0 ? '+' : ''}${fixed(difference, decimals)})`;
}

/** Draws a dashed line where the mark is. */
function drawMark({ context, x, from, to, top, bottom }: Chart): void {
  const time = markTime.value;
  if (time === null || time < from || time > to) return;
  context.strokeStyle = theme().ink;
  context.lineWidth = 1;
  context.setLineDash([4, 3]);
  context.beginPath();
  context.moveTo(x(time), top);
  context.lineTo(x(time), bottom);
  context.stroke();
  context.setLineDash([]);
}

/** Draws a plot on its paper; null while that has no size. */
function drawPlot(spec: PlotSpec, paper: Paper): Chart | null {
  const ready = paper.prepare();
  if (!ready) return null;
  const { context, ratio } = ready;
  const colours = theme();
  const [times, ...columns] = dataOf(spec);
  const range = spec.range(columns);
  const chart = chartOn(context, paper.box, timeRange(), range);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, paper.box.width, paper.box.height);
  drawFaultBands(chart);
  const yTicks = ticksOf(...range, Math.max(2, (chart.bottom - chart.top) / 22));
  drawAxes(chart, ticksOfTime(chart.from, chart.to), yTicks, (tick) => timeLabel(tick, chart.to), colours);
  spec.under?.(chart);
  // Stacked layers reach down to 0: the lower ones cover the higher ones.
  const curves = spec.series.map(({ colour, isDashed = false, isFilled }, i) => {
    const tone = colours.series[colour] ?? colours.ink;
    const fill = isFilled ? { fill: `color-mix(in srgb, ${tone} 55%, ${colours.sheet})` } : {};
    return { values: columns[i] ?? [], colour: tone, isDashed, ...fill };
  });
  if (spec.series[0]?.isFilled) curves.reverse();
  for (const curve of curves) drawCurve(chart, times ?? [], curve, LONGEST_SILENCE_S);
  drawMark(chart);
  return chart;
}

const PACE_MS = 100; // longest time between repaints of a plot: as often as text
const PHASES = 6; // plots take turns, so that no repaint draws all of them; chosen
const plotsMade = store.data('page', () => ({ count: 0 }));

/**
 * Time between repaints of a plot [ms]: until its lines have moved by one pixel, at most as long as between updates of
 * text.
 */
const paceOf = ({ box }: Paper): number => Math.min(PACE_MS, (1000 * windowSeconds.value) / Math.max(1, box.width));

/** The plotted area, which receives the pointer. */
function PointerArea({
  pointer,
  label,
  children,
}: {
  pointer: PlotPointer;
  label: string;
  children: ComponentChildren;
}) {
  return (
    <div
      class="plot-over"
      role="img"
      aria-label={label}
      style={{ inset: `${ROOM.top}px ${ROOM.right}px ${ROOM.bottom}px ${ROOM.left}px` }}
      onPointerDown={({ currentTarget, pointerId, offsetX, button }) => {
        currentTarget.setPointerCapture(pointerId);
        pointer.press(offsetX, button);
      }}
      onPointerMove={({ offsetX }) => pointer.move(offsetX)}
      onPointerUp={({ offsetX }) => pointer.release(offsetX)}
      onPointerCancel={() => pointer.cancel()}
      onPointerLeave={() => pointer.leave()}
      onDblClick={thaw}
    >
      {children}
    </div>
  );
}

/** A plot over time, repainted only when it has changed and its turn has come. */
export function TimePlot({ spec }: { spec: PlotSpec }) {
  const host = useRef<HTMLDivElement>(null);
  const [dragged, select] = useState<readonly [number, number] | null>(null);
  const [pointer] = useState(
    () => new PlotPointer(() => host.current?.querySelector('.plot-over')?.clientWidth ?? 0, select),
  );
  useEffect(() => {
    const canvas = host.current?.querySelector('canvas');
    if (!canvas) return undefined;
    const marks = [...(host.current?.querySelectorAll<HTMLElement>('.plot-cursor, .plot-dot') ?? [])];
    let drawn: number | null = null; // the newest time that is drawn; null: draw again
    const again = (): void => {
      drawn = null;
    };
    const paper = new Paper(canvas, again);
    /** Cursor and dots are elements: moving them draws no curve. */
    const placeCursor = (): void => {
      const [time, on] = [cursorTime.value, pointer.chart];
      const isShown = time !== null && on !== null && time >= on.from && time <= on.to;
      marks.forEach((mark, i) => {
        const series = spec.series[i - 1];
        const y = on && series ? on.y(valueAt(series, time)) : 0;
        mark.hidden = !isShown || !Number.isFinite(y);
        if (isShown) mark.style.transform = `translate(${on.x(time)}px, ${y}px)`;
      });
    };
    let last = performance.now() - (PACE_MS / PHASES) * (plotsMade.count++ % PHASES);
    const stop = everyFrame((now) => {
      const newest = plotted().newest(Column.time_s);
      // Half a repaint of tolerance, as in everyFrame().
      const isDue = drawn === null || now - last >= paceOf(paper) - 8;
      if (Object.is(newest, drawn) || !paper.box.isSeen || !isDue) return;
      drawn = newest;
      last = now;
      pointer.chart = drawPlot(spec, paper);
      pointer.follow();
      placeCursor();
    });
    const unwatch = onThemeChange(again);
    const unfollow = effect(() => {
      void [isFrozen.value, zoomed.value, windowSeconds.value, markTime.value];
      again();
    });
    const unpoint = effect(placeCursor);
    return () => {
      stop();
      unwatch();
      unfollow();
      unpoint();
      paper.box.end();
    };
  }, [spec]);

  void shown.value; // updates the numbers in the title as often as other text
  return (
    <section class="plot" aria-label={spec.title}>
      <header class="row">
        <h2>
          {spec.title} <span class="unit">{spec.unit}</span>
        </h2>
        <p class="row">
          {spec.series.map((series) => (
            <span
              key={series.label}
              class={series.isDashed ? 'key dashed' : 'key'}
              style={{ '--tone': toneOf(series.colour) }}
            >
              {spec.series.length > 1 ? `${series.label} ` : ''}
              {spec.series.some(({ isFilled }) => isFilled) ? null : <b>{readout(series, spec.decimals)}</b>}
            </span>
          ))}
        </p>
      </header>
      <div class="plot-area" ref={host}>
        <canvas class="cover" />
        <i class="plot-cursor" hidden />
        {spec.series.map(({ label, colour }) => (
          <i key={label} class="plot-dot" style={{ '--tone': toneOf(colour) }} hidden />
        ))}
        <PointerArea pointer={pointer} label={`${spec.title} over time`}>
          {dragged && (
            <i class="plot-select" style={{ left: `${dragged[0]}px`, width: `${dragged[1] - dragged[0]}px` }} />
          )}
        </PointerArea>
      </div>
    </section>
  );
}
