import { effect } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import { store } from '../lib/store';
import 'uplot/dist/uPlot.min.css';
import { firstSince, secondsBack, silencesIn } from '../draw/axis';
import { onThemeChange } from '../draw/theme';
import { fixed } from '../lib/format';
import { onScreen } from '../lib/on_screen';
import { Column } from '../state/columns';
import type { History } from '../state/history';
import {
  cursorTime,
  isFrozen,
  markTime,
  plotted,
  thaw,
  timeRange,
  windowSeconds,
  zoomed,
  zoomTo,
} from '../state/plot_view';
import { shown } from '../state/shown';
import { LONGEST_SILENCE_S } from '../state/silence';
import { everyFrame } from '../state/ticker';
import { drawFaultBands } from './plot_bands';
import { type ChartColours, chartColours, toneOf } from './plot_colours';

export interface Series {
  readonly column: number; // one of them, or
  readonly compute?: (history: History, first: number, end: number) => Float64Array; // from rows of all
  readonly label: string;
  readonly colour: number; // of plot_colours.ts, from 0
  readonly isDashed?: boolean;
  readonly isFilled?: boolean; // down to the previous series, or to 0
  readonly factor?: number; // from the column's unit to the plot's
}

export interface PlotSpec {
  readonly title: string;
  readonly unit: string;
  readonly decimals: number;
  readonly series: readonly Series[];
  readonly range: (columns: readonly ArrayLike<number>[]) => [number, number];
  /** Strokes under the lines. */
  readonly under?: (plot: uPlot, colours: ChartColours) => void;
}

const axisNumber = (value: number): string => String(Number(value.toPrecision(6))).replace('-', '−');

function timeAxis(low: number, high: number): number[] {
  const span = high - low;
  // Zoomed in, labels are times of the run: long ones, so fewer.
  const most = zoomed.value ? 4 : 6;
  const step = [0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20].find((each) => span / each <= most) ?? 20;
  if (!zoomed.value) return secondsBack(high, Math.ceil(span / step) * step, step).filter((time) => time >= low - 1e-9);
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, i) => (first + i) * step);
}

/** Labels relative to now while the plot follows the run; run time when zoomed in. */
const timeLabel = (time: number, last: number): string =>
  zoomed.value
    ? `${axisNumber(time)} s`
    : time === last
      ? isFrozen.value
        ? `${fixed(time, 1)} s`
        : 'now'
      : `−${axisNumber(Math.round((last - time) * 10) / 10)} s`;

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
    ...spec.series.map(({ column, compute, factor = 1 }) => {
      if (compute) return compute(history, first, end);
      return factor === 1 ? part(column) : part(column).map((value) => value * factor);
    }),
  ];
}

/** Gaps of the lines, as pairs of pixels of the canvas. */
function gapsOf(
  plot: uPlot,
  _series: number,
  first: number,
  last: number,
  found: uPlot.Series.Gaps,
): uPlot.Series.Gaps {
  const pixel = (time: number): number => Math.round(plot.valToPos(time, 'x', true));
  const silences = silencesIn(plot.data[0], first, last, LONGEST_SILENCE_S).map(
    ([from, to]): uPlot.Series.Gap => [pixel(from), pixel(to)],
  );
  return [...found, ...silences];
}

function seriesOptions({ label, colour, isDashed, isFilled }: Series, colours: ChartColours): uPlot.Series {
  const stroke = colours.series[colour] ?? colours.text;
  return {
    label,
    stroke,
    width: isFilled ? 1 : 1.75,
    dash: isDashed ? [5, 4] : [],
    points: { show: false },
    gaps: gapsOf,
  };
}

function optionsOf(spec: PlotSpec, colours: ChartColours): uPlot.Options {
  const axis = {
    stroke: colours.faint,
    grid: { stroke: colours.grid, width: 1 },
    ticks: { show: false },
    font: `11px ${colours.font}`,
  };
  const fill = (colour: number): string =>
    `color-mix(in srgb, ${colours.series[colour] ?? colours.text} 55%, ${colours.panel})`;
  return {
    width: 300,
    height: 120,
    legend: { show: false },
    cursor: {
      sync: { key: 'plots', setSeries: false },
      drag: { x: true, y: false, setScale: false, dist: 5 },
      points: { size: 7 },
      bind: {
        dblclick: () => () => {
          thaw();
          return null;
        },
      },
    },
    padding: [8, 18, 0, 0],
    scales: { x: { time: false, range: () => timeRange() }, y: { range: () => spec.range(dataOf(spec).slice(1)) } },
    axes: [
      {
        ...axis,
        size: 22,
        splits: (_plot, _axis, low, high) => timeAxis(low, high),
        values: (_plot, ticks) => ticks.map((tick) => timeLabel(tick, ticks.at(-1) ?? 0)),
      },
      { ...axis, size: 44, space: 24, values: (_plot, ticks) => ticks.map(axisNumber) },
    ],
    series: [
      {},
      ...spec.series.map((each) => ({
        ...seriesOptions(each, colours),
        ...(each.isFilled && each === spec.series[0] ? { fill: fill(each.colour) } : {}),
      })),
    ],
    bands: spec.series.flatMap((each, i) =>
      each.isFilled && i > 0 ? [{ series: [i + 1, i] as [number, number], fill: fill(each.colour) }] : [],
    ),
    hooks: {
      drawClear: [(plot) => drawFaultBands(plot, colours)],
      drawAxes: [(plot) => spec.under?.(plot, colours)],
      draw: [(plot) => drawMark(plot, colours)],
      ready: [markByClick],
      setSelect: [
        (plot) => {
          const { left, width } = plot.select;
          if (width > 0) zoomTo(plot.posToVal(left, 'x'), plot.posToVal(left + width, 'x'));
          plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        },
      ],
      setCursor: [
        (plot) => {
          const { idx } = plot.cursor;
          const time = idx === null || idx === undefined ? null : (plot.data[0][idx] ?? null);
          if (plot.cursor.event !== undefined || time === null) cursorTime.value = time;
        },
      ],
    },
  };
}

/** The value of a series at a time, or the newest. */
function valueAt({ column, compute, factor = 1 }: Series, time: number | null): number {
  const history = plotted();
  const row = time === null ? history.length - 1 : firstSince(history.column(Column.time_s), time - 1e-9);
  if (row < 0) return NaN;
  return compute ? (compute(history, row, row + 1)[0] ?? NaN) : (history.column(column)[row] ?? NaN) * factor;
}

/** The value under the cursor, or the newest; with a mark, the difference from there, too. */
function readout(series: Series, decimals: number): string {
  const value = valueAt(series, cursorTime.value);
  const mark = markTime.value;
  if (mark === null) return fixed(value, decimals);
  const difference = value - valueAt(series, mark);
  return `${fixed(value, decimals)} (Δ ${difference > 0 ? '+' : ''}${fixed(difference, decimals)})`;
}

/** A dashed line where the mark is. */
function drawMark(plot: uPlot, colours: ChartColours): void {
  const time = markTime.value;
  const { left, top, width, height } = plot.bbox;
  if (time === null) return;
  const x = Math.round(plot.valToPos(time, 'x', true));
  if (x < left || x > left + width) return;
  const { ctx } = plot;
  ctx.save();
  ctx.strokeStyle = colours.text;
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
  ctx.beginPath();
  ctx.moveTo(x, top);
  ctx.lineTo(x, top + height);
  ctx.stroke();
  ctx.restore();
}

/** A click, no drag, sets the mark where it is. */
function markByClick(plot: uPlot): void {
  let from = NaN;
  plot.over.addEventListener('mousedown', ({ clientX }) => (from = clientX));
  plot.over.addEventListener('mouseup', ({ clientX, detail }) => {
    if (Math.abs(clientX - from) < 5 && detail === 1) markTime.value = cursorTime.value;
  });
}

const PACE_MS = 100; // as often as text
const PHASES = 6; // plots take turns, so that no repaint draws all of them
const plotsMade = store.data('page', () => ({ count: 0 }));

/**
 * Time between repaints of a plot [ms]: until its lines have moved by one pixel, at most as long as between updates of
 * text.
 */
const paceOf = (plot: uPlot): number =>
  plot.bbox.width > 0 ? Math.min(PACE_MS, (1000 * windowSeconds.value) / plot.bbox.width) : 0;

export function TimePlot({ spec }: { spec: PlotSpec }) {
  const host = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = host.current;
    if (!element) return undefined;
    const create = (): uPlot =>
      new uPlot(optionsOf(spec, chartColours()), dataOf(spec) as unknown as uPlot.AlignedData, element);
    let plot = create();
    let drawn = NaN;
    const redraw = (): void => plot.setData(dataOf(spec) as unknown as uPlot.AlignedData);
    const fit = (): void => plot.setSize(box);
    const box = onScreen(element, fit);
    let last = performance.now() - (PACE_MS / PHASES) * (plotsMade.count++ % PHASES);
    const stop = everyFrame((now) => {
      const newest = plotted().newest(Column.time_s);
      // Half a repaint of tolerance, as in everyFrame().
      if (Object.is(newest, drawn) || !box.isSeen || now - last < paceOf(plot) - 8) return;
      drawn = newest;
      last = now;
      redraw();
    });
    const unwatch = onThemeChange(() => {
      plot.destroy();
      plot = create();
      fit();
    });
    const unfollow = effect(() => {
      void [isFrozen.value, zoomed.value, windowSeconds.value, markTime.value];
      drawn = NaN;
    });
    // A cursor that was set elsewhere, on the map for one.
    const point = effect(() => {
      const time = cursorTime.value;
      if (plot.cursor.event?.type === 'mousemove') return;
      plot.setCursor({ left: time === null ? -10 : plot.valToPos(time, 'x'), top: time === null ? -10 : 10 }, false);
    });
    return () => {
      stop();
      unwatch();
      unfollow();
      point();
      box.end();
      plot.destroy();
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
            <span key={series.label} class="key">
              <span class={series.isDashed ? 'stroke dashed' : 'stroke'} style={{ '--tone': toneOf(series.colour) }} />
              {spec.series.length > 1 ? `${series.label} ` : ''}
              {spec.series.some(({ isFilled }) => isFilled) ? null : <b>{readout(series, spec.decimals)}</b>}
            </span>
          ))}
        </p>
      </header>
      <div class="plot-area" ref={host} />
    </section>
  );
}
