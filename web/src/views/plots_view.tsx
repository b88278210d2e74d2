import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { firstSince, rangeAboutZero, rangeFromZero, secondsBack } from '../draw/axis';
import { onThemeChange, theme, type Theme } from '../draw/theme';
import { fixed } from '../lib/format';
import { Column, live, shown, WINDOW_S } from '../state/app_state';
import { everyFrame } from '../state/ticker';

interface Series {
  readonly column: number;
  readonly label: string;
  readonly isDashed?: boolean;
}

interface PlotSpec {
  readonly title: string;
  readonly unit: string;
  readonly decimals: number;
  readonly series: readonly Series[];
  readonly range: (columns: readonly ArrayLike<number>[]) => [number, number];
}

const PLOTS: readonly PlotSpec[] = [
  {
    title: 'Speed',
    unit: 'mph',
    decimals: 1,
    series: [
      { column: Column.speed, label: 'driven' },
      { column: Column.speedWanted, label: 'wanted', isDashed: true },
    ],
    range: (columns) => rangeFromZero(columns, 20),
  },
  {
    title: 'Lateral error',
    unit: 'm, + left',
    decimals: 2,
    series: [{ column: Column.lateralError, label: 'car' }],
    range: (columns) => rangeAboutZero(columns, 0.5),
  },
  {
    title: 'Steering',
    unit: '°, + left',
    decimals: 1,
    series: [
      { column: Column.steerApplied, label: 'applied' },
      { column: Column.steerAsked, label: 'asked', isDashed: true },
    ],
    range: (columns) => rangeAboutZero(columns, 2),
  },
  {
    title: 'Control step',
    unit: 'ms',
    decimals: 2,
    series: [{ column: Column.stepTime, label: 'taken' }],
    range: (columns) => rangeFromZero(columns, 0.5),
  },
];

function optionsOf(spec: PlotSpec, colours: Theme): uPlot.Options {
  const axis = { stroke: colours.faint, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, font: `11px ${colours.font}` };
  return {
    width: 300,
    height: 120,
    legend: { show: false },
    cursor: { sync: { key: 'plots' }, drag: { x: false, y: false }, points: { size: 7 } },
    padding: [8, 18, 0, 0],
    scales: { x: { time: false, range: (_plot, _low, high) => [high - WINDOW_S, high] }, y: { range: () => spec.range(dataOf(spec).slice(1)) } },
    axes: [
      {
        ...axis,
        size: 22,
        splits: (_plot, _axis, _low, high) => secondsBack(high, WINDOW_S, 5),
        values: (_plot, ticks) => ticks.map((tick) => (tick === ticks.at(-1) ? 'now' : `−${Math.round((ticks.at(-1) ?? 0) - tick)} s`)),
      },
      { ...axis, size: 42, space: 28, values: (_plot, ticks) => ticks.map((tick) => String(tick).replace('-', '−')) },
    ],
    series: [
      {},
      ...spec.series.map(({ label, isDashed }, i) => ({
        label,
        stroke: colours.series[i === 0 ? 0 : 1],
        width: 1.75,
        dash: isDashed ? [5, 4] : [],
        points: { show: false },
      })),
    ],
  };
}

/** Time and the columns of a plot, as far back as the plot reaches. */
function dataOf(spec: PlotSpec): Float64Array[] {
  const times = live.plots.column(Column.time);
  const first = firstSince(times, (times.at(-1) ?? 0) - WINDOW_S);
  return [Column.time, ...spec.series.map(({ column }) => column)].map((column) => live.plots.column(column).subarray(first));
}

function Plot({ spec }: { spec: PlotSpec }) {
  const host = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = host.current;
    if (!element) return undefined;
    const create = (): uPlot => new uPlot(optionsOf(spec, theme()), dataOf(spec) as unknown as uPlot.AlignedData, element);
    let plot = create();
    let drawn = NaN;
    const fit = (): void => plot.setSize({ width: element.clientWidth, height: element.clientHeight });
    const watcher = new ResizeObserver(fit);
    watcher.observe(element);
    const stop = everyFrame(() => {
      const newest = live.plots.newest(Column.time);
      if (Object.is(newest, drawn)) return;
      drawn = newest;
      plot.setData(dataOf(spec) as unknown as uPlot.AlignedData);
    }, 50);
    const unwatch = onThemeChange(() => {
      plot.destroy();
      plot = create();
      fit();
    });
    return () => {
      stop();
      unwatch();
      watcher.disconnect();
      plot.destroy();
    };
  }, [spec]);

  void shown.value; // renews the numbers in the title as often as other text
  return (
    <section class="panel plot" aria-label={spec.title}>
      <header>
        <h2>
          {spec.title} <span class="unit">({spec.unit})</span>
        </h2>
        <p>
          {spec.series.map(({ column, label }, i) => (
            <span key={label} class={`key series-${i + 1}`}>
              {spec.series.length > 1 ? `${label} ` : ''}
              <b>{fixed(live.plots.newest(column), spec.decimals)}</b>
            </span>
          ))}
        </p>
      </header>
      <div class="plot-area" ref={host} />
    </section>
  );
}

export function PlotsView() {
  return (
    <div class="plots">
      {PLOTS.map((spec) => (
        <Plot key={spec.title} spec={spec} />
      ))}
    </div>
  );
}
