import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import { store } from '../lib/store';
import 'uplot/dist/uPlot.min.css';
import { rangeAboutZero, rangeInSteps } from '../draw/axis';
import { onThemeChange } from '../draw/theme';
import { onScreen } from '../lib/on_screen';
import { type SpeedUnit, speedUnit } from '../lib/units';
import type { LapChannel } from '../state/lap_samples';
import { lapSamples } from '../state/laps';
import { limit, limitChannel } from '../state/limit';
import { shown } from '../state/shown';
import { everyFrame } from '../state/ticker';
import { registerDrawing } from './picture_drawings';
import { type ChartColours, chartColours } from './plot_colours';

/** A plot against the distance along the track: the limit and the best lap behind the lap that is driven now. */
interface TrackSpec {
  readonly title: string;
  readonly unit: string;
  readonly channels: readonly { readonly name: LapChannel; readonly factor: number; readonly label: string }[];
  readonly hasLimit: boolean;
  readonly range: (columns: readonly ArrayLike<number>[]) => [number, number];
}

const DEGREES = 180 / Math.PI;

const specs = ({ name, perMps, axisStep, axisLeast }: SpeedUnit): readonly TrackSpec[] => [
  {
    title: 'Speed',
    unit: name,
    channels: [{ name: 'speed_mps', factor: perMps, label: 'speed' }],
    hasLimit: true,
    range: (columns) => rangeInSteps(columns, axisStep, axisLeast),
  },
  {
    title: 'Pedal and wheels',
    unit: '%, − brakes; ° × 10, + left',
    channels: [
      { name: 'throttle', factor: 100, label: 'pedal' },
      { name: 'steer_rad', factor: 10 * DEGREES, label: 'wheels' },
    ],
    hasLimit: false,
    range: (columns) => rangeAboutZero(columns, 105),
  },
  {
    title: 'Lateral error',
    unit: 'm, + left',
    channels: [{ name: 'lateral_error_m', factor: 1, label: 'error' }],
    hasLimit: true,
    range: (columns) => rangeAboutZero(columns, 0.5),
  },
];

/** Per channel: the limit, the best lap, the present lap. */
function dataOf(spec: TrackSpec): Float64Array[] {
  const { best } = lapSamples;
  const none = new Float64Array(lapSamples.points).fill(NaN);
  return spec.channels.flatMap(({ name, factor }) =>
    [
      spec.hasLimit && limit.value ? limitChannel(limit.value, lapSamples, name) : null,
      best >= 0 ? lapSamples.channel(best, name) : null,
      lapSamples.present(name),
    ].map((values) => (values ?? none).map((value) => value * factor)),
  );
}

const withGaps = (values: Float64Array): (number | null)[] =>
  Array.from(values, (value) => (Number.isFinite(value) ? value : null));

function tableOf(spec: TrackSpec): uPlot.AlignedData {
  const step = lapSamples.length / lapSamples.points;
  const places = Float64Array.from({ length: lapSamples.points }, (_, point) => point * (step || 1));
  return [places, ...dataOf(spec).map(withGaps)] as unknown as uPlot.AlignedData;
}

function optionsOf(spec: TrackSpec, colours: ChartColours): uPlot.Options {
  const axis = {
    stroke: colours.faint,
    grid: { stroke: colours.grid, width: 1 },
    ticks: { show: false },
    font: `11px ${colours.font}`,
  };
  const looks = (channel: number): uPlot.Series[] => [
    { stroke: colours.series[4] ?? '', width: 1, dash: [5, 4], points: { show: false } },
    { stroke: colours.faint, width: 1.25, points: { show: false } },
    { stroke: colours.series[channel] ?? '', width: 2, points: { show: false } },
  ];
  return {
    width: 300,
    height: 160,
    legend: { show: false },
    cursor: { sync: { key: 'track', setSeries: false }, drag: { x: true, y: false }, points: { size: 7 } },
    padding: [8, 18, 0, 0],
    scales: { x: { time: false }, y: { range: () => spec.range(dataOf(spec)) } },
    axes: [
      { ...axis, size: 22, values: (_plot, ticks) => ticks.map((tick) => `${tick} m`) },
      { ...axis, size: 44, space: 24, values: (_plot, ticks) => ticks.map((tick) => String(tick).replace('-', '−')) },
    ],
    series: [{}, ...spec.channels.flatMap((_, channel) => looks(channel))],
  };
}

const PACE_MS = 200;

function TrackPlot({ spec }: { spec: TrackSpec }) {
  const host = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = host.current;
    if (!element) return undefined;
    const create = (): uPlot => new uPlot(optionsOf(spec, chartColours()), tableOf(spec), element);
    let plot = create();
    let drawn = NaN;
    const redraw = (): void => plot.setData(tableOf(spec), plot.cursor.event?.buttons !== 1);
    const fit = (): void => plot.setSize(box);
    const box = onScreen(element, fit);
    const stop = everyFrame(() => {
      const now = shown.value?.time_s ?? NaN;
      if (Object.is(now, drawn) || !box.isSeen) return;
      drawn = now;
      redraw();
    }, PACE_MS);
    const forget = registerDrawing(redraw);
    const unwatch = onThemeChange(() => {
      plot.destroy();
      plot = create();
      fit();
    });
    return () => {
      stop();
      forget();
      unwatch();
      box.end();
      plot.destroy();
    };
  }, [spec]);
  return (
    <section class="plot" aria-label={`${spec.title} along the track`}>
      <header>
        <h2>
          {spec.title} <span class="unit">{spec.unit}</span>
        </h2>
        <p>
          {spec.channels.map(({ label }, channel) => (
            <span key={label} class="key">
              <span class="stroke" style={{ borderColor: `var(--series-${channel + 1})` }} />
              {spec.channels.length > 1 ? label : 'this lap'}
            </span>
          ))}
          <span class="key">
            <span class="stroke" style={{ borderColor: 'var(--text-faint)' }} />
            best lap
          </span>
          {spec.hasLimit && (
            <span class="key">
              <span class="stroke dashed" style={{ borderColor: 'var(--series-5)' }} />
              limit
            </span>
          )}
        </p>
      </header>
      <div class="plot-area" ref={host} />
    </section>
  );
}

const known = store.data('page', () => ({ unit: null as SpeedUnit | null, all: [] as readonly TrackSpec[] }));

/** Speed, inputs and error against the distance along the track. */
export function TrackPlots() {
  const unit = speedUnit();
  if (known.unit !== unit) Object.assign(known, { unit, all: specs(unit) });
  if (!(lapSamples.length > 0))
    return <p class="empty">The road is not known: there is no distance to plot against.</p>;
  return (
    <div class="track-plots">
      {known.all.map((spec) => (
        <TrackPlot key={`${spec.title} ${spec.unit}`} spec={spec} />
      ))}
    </div>
  );
}
