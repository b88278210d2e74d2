import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { onThemeChange } from '../draw/theme';
import { fixed } from '../lib/format';
import { type ChartColours, chartColours } from './plot_colours';

/** Curves against the distance along the road. */
export interface DistanceCurves {
  readonly title: string;
  readonly unit: string;
  readonly decimals: number;
  readonly places: readonly number[]; // [m]
  readonly curves: readonly { readonly label: string; readonly colour: number; readonly values: readonly number[] }[];
  readonly range: (columns: readonly ArrayLike<number>[]) => [number, number];
}

const withGaps = (values: readonly number[]): (number | null)[] =>
  values.map((value) => (Number.isFinite(value) ? value : null));

function optionsOf(
  { curves, range }: DistanceCurves,
  colours: ChartColours,
  read: (plot: uPlot) => void,
): uPlot.Options {
  const axis = {
    stroke: colours.faint,
    grid: { stroke: colours.grid, width: 1 },
    ticks: { show: false },
    font: `11px ${colours.font}`,
  };
  const columns = curves.map(({ values }) => values.filter(Number.isFinite));
  return {
    width: 300,
    height: 150,
    legend: { show: false },
    cursor: { sync: { key: 'distance', setSeries: false }, drag: { x: true, y: false }, points: { size: 7 } },
    padding: [8, 18, 0, 0],
    scales: { x: { time: false }, y: { range: () => range(columns) } },
    axes: [
      { ...axis, size: 22, values: (_plot, ticks) => ticks.map((tick) => `${tick} m`) },
      {
        ...axis,
        size: 44,
        space: 24,
        values: (_plot, ticks) => ticks.map((tick) => String(Number(tick.toPrecision(6))).replace('-', '−')),
      },
    ],
    series: [
      {},
      ...curves.map(({ colour }) => ({ stroke: colours.series[colour] ?? '', width: 1.75, points: { show: false } })),
    ],
    hooks: { setCursor: [read] },
  };
}

/** The plot of some curves; another object is another plot. */
export function DistancePlot({ of }: { of: DistanceCurves }) {
  const host = useRef<HTMLDivElement>(null);
  const reading = useRef<HTMLParagraphElement>(null);
  const { title, unit, decimals, places, curves } = of;
  useEffect(() => {
    const element = host.current;
    if (!element) return undefined;
    const read = (plot: uPlot): void => {
      if (!reading.current) return;
      const at = plot.cursor.idx ?? -1;
      const values = curves.map(({ values: column }) => fixed(column[at] ?? NaN, decimals));
      reading.current.textContent = at < 0 ? '' : `${fixed(places[at] ?? NaN, 0)} m: ${values.join(' / ')}`;
    };
    const data = [places, ...curves.map(({ values }) => withGaps(values))] as unknown as uPlot.AlignedData;
    const fit = (): void => plot.setSize({ width: element.clientWidth, height: element.clientHeight });
    const create = (): uPlot => new uPlot(optionsOf(of, chartColours(), read), data, element);
    let plot = create();
    fit();
    const watcher = new ResizeObserver(fit);
    watcher.observe(element);
    const unwatch = onThemeChange(() => {
      plot.destroy();
      plot = create();
      fit();
    });
    return () => {
      unwatch();
      watcher.disconnect();
      plot.destroy();
    };
  }, [of]);
  return (
    <section class="plot" aria-label={`${title} of both futures`}>
      <header>
        <h2>
          {title} <span class="unit">{unit}</span>
        </h2>
        <p>
          {curves.map(({ label, colour }) => (
            <span key={label} class="key">
              <span class="stroke" style={{ borderColor: `var(--series-${colour + 1})` }} />
              {label}
            </span>
          ))}
        </p>
        <p class="reading" ref={reading} />
      </header>
      <div class="plot-area" ref={host} />
    </section>
  );
}
