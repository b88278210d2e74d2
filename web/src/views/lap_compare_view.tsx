import { computed, effect } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { rangeAboutZero, rangeInSteps } from '../draw/axis';
import { onThemeChange } from '../draw/theme';
import { fixed } from '../lib/format';
import { speedUnit } from '../lib/units';
import { lapName, samplesOf } from '../state/compared';
import { cursorMark } from '../state/cursor';
import { type LapChannel, timeGap } from '../state/lap_samples';
import { lapSamples } from '../state/laps';
import { cursorPlace, cursorTime } from '../state/plot_view';
import { type ChartColours, chartColours } from './plot_colours';

interface Curve {
  readonly title: string;
  readonly unit: string;
  readonly decimals: number;
  /** A curve for each lap, or for what each but lap B has lost to lap B. */
  data(numbers: readonly number[]): (Float64Array | null)[];
  readonly range: (columns: readonly ArrayLike<number>[]) => [number, number];
  /** Of differences from lap B; that of lap A is filled: red above zero, where it lost, green below it. */
  readonly isGap?: boolean;
}

const channel =
  (name: LapChannel, factor = 1) =>
  (numbers: readonly number[]): (Float64Array | null)[] =>
    numbers.map((lap) => samplesOf(lap, name)?.map((value) => value * factor) ?? null);

const SPEED = computed<Curve>(() => {
  const { name, perMps, axisStep, axisLeast } = speedUnit();
  return {
    title: 'Speed',
    unit: name,
    decimals: 1,
    data: channel('speed_mps', perMps),
    range: (columns) => rangeInSteps(columns, axisStep, axisLeast),
  };
});

const OTHERS: readonly Curve[] = [
  {
    title: 'Lateral error',
    unit: 'm, + left',
    decimals: 2,
    data: channel('lateral_error_m'),
    range: (columns) => rangeAboutZero(columns, 0.5),
  },
  {
    title: 'Time gap',
    unit: 's, + behind lap B',
    decimals: 3,
    data: (numbers) => {
      const [a, b, ...others] = channel('time_s')(numbers);
      return [a, ...others].map((each) => (each && b ? timeGap(each, b) : null));
    },
    range: (columns) => rangeAboutZero(columns, 0.1),
    isGap: true,
  },
];

/** Red above zero, green below it. */
function lossGradient(plot: uPlot, { bad, good }: ChartColours): CanvasGradient {
  const { top, height } = plot.bbox;
  const zero = Math.min(1, Math.max(0, (plot.valToPos(0, 'y', true) - top) / height));
  const gradient = plot.ctx.createLinearGradient(0, top, 0, top + height);
  for (const [at, colour] of [
    [0, bad],
    [zero, bad],
    [zero, good],
    [1, good],
  ] as const)
    gradient.addColorStop(at, `${colour}59`); // colours are #rrggbb
  return gradient;
}

/** Metres from the start line of a place along the road. */
function distanceFromLine(place: number): number {
  const length = lapSamples.s(lapSamples.points) - lapSamples.s(0);
  const from = place - lapSamples.place(0) + lapSamples.s(0);
  return from < 0 ? from + length : from;
}

/** uPlot draws gaps where a value is null, not where it is NaN. */
const withGaps = (values: Float64Array): (number | null)[] =>
  Array.from(values, (value) => (Number.isFinite(value) ? value : null));

/** The colour of a lap by its place among those drawn. */
const colourOf = (place: number): number => place % 10;

function CurvePlot({ curve, numbers }: { curve: Curve; numbers: readonly number[] }) {
  const host = useRef<HTMLDivElement>(null);
  const reading = useRef<HTMLParagraphElement>(null);
  const shown = curve.data(numbers);
  const lapA = numbers[0] ?? 0;
  useEffect(() => {
    const element = host.current;
    if (!element) return undefined;
    const columns = shown.filter((each): each is Float64Array => each !== null);
    const places = Float64Array.from({ length: lapSamples.points }, (_, point) => lapSamples.s(point));
    const create = (): uPlot => {
      const colours = chartColours();
      const axis = {
        stroke: colours.faint,
        grid: { stroke: colours.grid, width: 1 },
        ticks: { show: false },
        font: `11px ${colours.font}`,
      };
      const strokeOf = (i: number): string => {
        if (curve.isGap && i === 0) return colours.series[3] ?? '';
        return colours.series[colourOf(curve.isGap ? i + 1 : i)] ?? '';
      };
      const options: uPlot.Options = {
        width: element.clientWidth,
        height: element.clientHeight,
        legend: { show: false },
        cursor: { sync: { key: 'laps', setSeries: false }, drag: { x: true, y: false }, points: { size: 7 } },
        padding: [8, 18, 0, 0],
        scales: { x: { time: false }, y: { range: () => curve.range(columns) } },
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
          ...columns.map((_, i) => ({
            stroke: strokeOf(i),
            width: i < 2 ? 1.75 : 1.25,
            points: { show: false },
            ...(curve.isGap && i === 0 && { fill: (self: uPlot) => lossGradient(self, colours), fillTo: 0 }),
          })),
        ],
        hooks: {
          setCursor: [
            (plot) => {
              if (!reading.current) return;
              const at = plot.cursor.idx;
              if (plot.cursor.event)
                cursorPlace.value =
                  at === null || at === undefined || lapA < 1 ? null : { lap: lapA - 1, place: lapSamples.place(at) };
              const values =
                at === null || at === undefined
                  ? []
                  : columns.map((column) => fixed(column[at] ?? NaN, curve.decimals));
              reading.current.textContent =
                at === null || at === undefined ? '' : `${fixed(places[at] ?? NaN, 0)} m: ${values.join(' / ')}`;
            },
          ],
        },
      };
      return new uPlot(options, [places, ...columns.map(withGaps)] as uPlot.AlignedData, element);
    };
    let plot = create();
    // The cursor of the other plots, at its place on the road.
    const unfollow = effect(() => {
      if (cursorPlace.value !== null || (cursorTime.value === null && plot.cursor.event)) return;
      const mark = cursorTime.value === null ? null : cursorMark();
      const along = mark ? distanceFromLine(mark.place) : NaN;
      const left = Number.isFinite(along) ? plot.valToPos(along, 'x') : -10;
      plot.setCursor({ left, top: Number.isFinite(along) ? 10 : -10 });
    });
    const watcher = new ResizeObserver(() =>
      plot.setSize({ width: element.clientWidth, height: element.clientHeight }),
    );
    watcher.observe(element);
    const unwatch = onThemeChange(() => {
      plot.destroy();
      plot = create();
    });
    return () => {
      unfollow();
      cursorPlace.value = null;
      unwatch();
      watcher.disconnect();
      plot.destroy();
    };
    // A complete lap does not change, so its number identifies its data.
  }, [curve, numbers.join(' '), shown.filter((each) => each === null).length]);
  return (
    <section class="plot" aria-label={`${curve.title} along the track`}>
      <header>
        <h2>
          {curve.title} <span class="unit">{curve.unit}</span>
        </h2>
        {!curve.isGap && (
          <p>
            {numbers.map((lap, i) => (
              <span key={lap} class="key">
                <span class="stroke" style={{ borderColor: `var(--series-${colourOf(i) + 1})` }} />
                {lapName(lap)}
              </span>
            ))}
          </p>
        )}
        <p class="reading" ref={reading} />
      </header>
      <div class="plot-area" ref={host} />
    </section>
  );
}

/** Laps A and B, and those that are drawn beside them, over the distance along the road. */
export function LapCompareView({ numbers }: { numbers: readonly number[] }) {
  const missing = numbers.filter((lap) => !samplesOf(lap, 'time_s'));
  if (missing.length > 0) {
    return (
      <p class="empty">
        This page has not seen all of {missing.map(lapName).join(' and ')}: there is nothing to compare.
      </p>
    );
  }
  return (
    <div class="compare">
      {[SPEED.value, ...OTHERS].map((curve) => (
        <CurvePlot key={`${curve.title} ${curve.unit} ${numbers.join(' ')}`} curve={curve} numbers={numbers} />
      ))}
    </div>
  );
}
