// Plots along the lap of a comparison: gap, speed, pedal, steering and, for engineers, solver and controller.
import { useLayoutEffect, useMemo, useRef, useState } from 'preact/hooks';
import { aboutZero, fromZero, rangeInSteps, ticksOf } from '../draw/axis';
import { curvePath } from '../draw/curve';
import { duration, fixed } from '../lib/format';
import { degrees, extent } from '../lib/math';
import { onScreen } from '../lib/on_screen';
import { tidy } from '../lib/scale';
import { type SpeedUnit, speedUnit } from '../lib/units';
import { type Comparison, pointAt, signed, toneOf } from '../state/comparison';
import type { LapChannel } from '../state/lap_samples';

/** A row of the plots along the lap: values of A, and of B where it has them. */
interface Row {
  readonly title: string;
  readonly unit: string;
  readonly height: number; // share
  readonly a: Float64Array;
  readonly b: Float64Array | null;
  readonly range: readonly [number, number];
  readonly isGap?: boolean;
  readonly write: (value: number) => string;
}

/** A row that shows a channel of laps; `range` gives its axis. */
interface ChannelRow extends Pick<Row, 'title' | 'unit' | 'write'> {
  readonly channel: LapChannel;
  readonly factor: number;
  readonly range: (columns: readonly Float64Array[]) => readonly [number, number];
}

/** Writes values with a unit. */
const inUnit =
  (unit: string, decimals = 0) =>
  (value: number): string =>
    `${fixed(value, decimals)}${unit}`;
const percent = inUnit(' %');
const micros = (value: number): string => {
  const { value: number, unit } = duration(value);
  return `${number} ${unit}`;
};

/** The row of the speed in the user's unit. */
const speedRow = ({ name: unit, perMps: factor, axisStep, axisLeast }: SpeedUnit): ChannelRow => {
  const range: ChannelRow['range'] = (columns) => rangeInSteps(columns, 2 * axisStep, axisLeast);
  return { title: 'Speed', unit, channel: 'speed_mps', factor, range, write: inUnit('') };
};

const fullPedal = (): [number, number] => [-100, 100];
const angle = { unit: '°, + left', write: inUnit('°', 1) };
const offset = { unit: 'm from the centre, + left', write: inUnit(' m', 2) };
const errorAhead = { unit: 'cm, a delay and a step ahead', write: inUnit(' cm', 1) };
const delay = { unit: 'ms, compensated', write: inUnit(' ms') };
const DRIVER_ROWS: readonly ChannelRow[] = [
  { title: 'Pedal', unit: '%, − brakes', channel: 'throttle', factor: 100, range: fullPedal, write: percent },
  { title: 'Steer', channel: 'steer_rad', factor: degrees(1), range: aboutZero(5, 1), ...angle },
];

/** What solver and controller did: behind the switch Engineer. */
const ENGINEER_ROWS: readonly ChannelRow[] = [
  { title: 'Line', channel: 'lateral_error_m', factor: 1, range: aboutZero(5, 1), ...offset },
  { title: 'Grip used', unit: '%', channel: 'grip', factor: 100, range: fromZero(100, 1), write: percent },
  { title: 'Control step', unit: 'µs', channel: 'step_time_us', factor: 1, range: fromZero(1000, 1), write: micros },
  { title: 'Solver', unit: 'iterations', channel: 'iterations', factor: 1, range: fromZero(8, 1), write: inUnit('') },
  { title: 'Cost', unit: 'of the plan', channel: 'cost', factor: 1, range: fromZero(1, 1), write: tidy },
  { title: 'Model error', channel: 'prediction_error_m', factor: 100, range: fromZero(10, 1), ...errorAhead },
  { title: 'Delay', channel: 'delay_s', factor: 1000, range: fromZero(100, 1), ...delay },
];

/** Shares of the rows in the height; chosen. */
const HEIGHTS = { gap: 2.4, speed: 3.4, driver: 1.7, engineer: 1.5 } as const;

/** Whether a channel has any value. */
const isKnown = (values: Float64Array | null): values is Float64Array => values?.some(Number.isFinite) === true;
const GAP_STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50];

/** The row of the gap, with a round range about zero. */
function gapRow({ gap, b }: Comparison): Row {
  const [low, high] = extent(gap) ?? [0, 0];
  const span = Math.max(0.2, Math.max(0, high) - Math.min(0, low));
  const step = GAP_STEPS.find((each) => span / each <= 4) ?? 100;
  const range = [
    Math.floor(Math.min(0, low) / step + 1e-9) * step,
    Math.ceil(Math.max(step, high) / step - 1e-9) * step,
  ] as const;
  return {
    title: 'Gap',
    unit: `s behind ${b.name}`,
    height: HEIGHTS.gap,
    a: gap,
    b: null,
    range: high <= 0.005 && low < 0 ? [range[0], 0] : range,
    isGap: true,
    write: signed,
  };
}

/** The rows that A has; `isEngineer`: also rows of solver and controller. */
function rowsOf(comparison: Comparison, unit: SpeedUnit, isEngineer: boolean): Row[] {
  const scaled = (values: Float64Array | null, factor: number): Float64Array | null =>
    isKnown(values) ? values.map((value) => value * factor) : null;
  const rows = (height: number, specs: readonly ChannelRow[]): Row[] =>
    specs.flatMap(({ channel, factor, range, ...spec }) => {
      const a = scaled(comparison.a.channel(channel), factor);
      const b = scaled(comparison.b.channel(channel), factor);
      return a ? [{ ...spec, height, a, b, range: range(b ? [a, b] : [a]) }] : [];
    });
  return [
    gapRow(comparison),
    ...rows(HEIGHTS.speed, [speedRow(unit)]),
    ...rows(HEIGHTS.driver, DRIVER_ROWS),
    ...rows(HEIGHTS.engineer, isEngineer ? ENGINEER_ROWS : []),
  ];
}

/** Room above and below all rows, and for the head of a row and the gap below it [px]; chosen. */
const [TOP, BOTTOM, HEAD, BETWEEN] = [24, 24, 22, 10];
const NARROW_PX = 520; // width below which margins are small; chosen

/** Where the rows are in the picture [px]. */
interface Frame {
  readonly height: number;
  readonly left: number;
  readonly right: number; // of the plotted area
  readonly perRow: readonly { readonly head: number; readonly top: number; readonly bottom: number }[];
}

/** Places of the rows in a picture of this size; a cursor needs room for its values. */
function frameOf(rows: readonly Row[], width: number, height: number, hasCursor: boolean): Frame {
  const isNarrow = width < NARROW_PX;
  const margin = hasCursor ? (isNarrow ? 68 : 104) : 8;
  const shares = rows.reduce((sum, row) => sum + row.height, 0);
  let from = TOP;
  const perRow = rows.map((row) => {
    const size = ((height - TOP - BOTTOM) * row.height) / shares;
    const place = { head: from, top: from + HEAD, bottom: from + size - BETWEEN };
    from += size;
    return place;
  });
  return { height, left: isNarrow ? 36 : 44, right: width - margin, perRow };
}

const px = (value: number): string => value.toFixed(1);

/** Where a value of a row is drawn [px]. */
function yOf({ range: [low, high] }: Row, { top, bottom }: { top: number; bottom: number }, value: number): number {
  return bottom - ((Math.min(high, Math.max(low, value)) - low) / (high - low || 1)) * (bottom - top);
}

/** Path of a curve. */
const pathOf = (values: Float64Array, x: (i: number) => number, y: (value: number) => number): string =>
  curvePath(values.length, x, (i) => y(values[i] ?? NaN));

/** Curve of the gap, in the colour of lost above zero, of won below it. */
function GapCurve({ row, x, y }: { row: Row; x: (i: number) => number; y: (value: number) => number }) {
  return (
    <>
      {(['lost', 'won'] as const).map((tone) => {
        const part = row.a.map((value) => (tone === 'lost' ? Math.max(0, value) : Math.min(0, value)));
        if (!part.some((value) => toneOf(value) === tone)) return null;
        const known = part.map((value) => (Number.isFinite(value) ? value : 0));
        const line = part.map((value) => (toneOf(value) === tone ? value : NaN));
        return (
          <g key={tone} class={tone}>
            <path
              class="fill"
              d={`${pathOf(known, x, y)}L${px(x(part.length - 1))} ${px(y(0))}L${px(x(0))} ${px(y(0))}z`}
            />
            <path d={pathOf(line, x, y)} />
          </g>
        );
      })}
    </>
  );
}

/** Corners, axes and curves: all that does not move with the cursor. */
function Curves({ comparison, rows, frame }: { comparison: Comparison; rows: readonly Row[]; frame: Frame }) {
  const { corners, length, s } = comparison;
  const { left, right, height, perRow } = frame;
  const along = (place: number): number => left + (place / length) * (right - left);
  const x = (i: number): number => along(s[i] ?? NaN);
  const base = height - BOTTOM;
  return (
    <g>
      {corners.map(({ name, entry, exit }) => (
        <g key={name}>
          <rect x={along(entry)} y={TOP} width={along(exit) - along(entry)} height={base - TOP} />
          <text class="turn" x={(along(entry) + along(exit)) / 2} y="12" text-anchor="middle">
            {name}
          </text>
        </g>
      ))}
      {rows.map((row, r) => {
        const place = perRow[r] ?? { head: 0, top: 0, bottom: 0 };
        const y = (value: number): number => yOf(row, place, value);
        return (
          <g key={row.title}>
            <text class="title" x={left} y={place.head + 13}>
              {row.title} <tspan>{row.unit}</tspan>
            </text>
            {ticksOf(...row.range, Math.max(2, (place.bottom - place.top) / 22)).map((tick) => (
              <g key={tick}>
                <line class={tick === 0 ? 'grid zero' : 'grid'} x1={left} x2={right} y1={y(tick)} y2={y(tick)} />
                <text x={left - 8} y={y(tick) + 4} text-anchor="end">
                  {tidy(tick)}
                </text>
              </g>
            ))}
            {row.b && <path class="b" d={pathOf(row.b, x, y)} />}
            {row.isGap ? <GapCurve row={row} x={x} y={y} /> : <path class="a" d={pathOf(row.a, x, y)} />}
          </g>
        );
      })}
      {ticksOf(0, length, (right - left) / 90).map((tick, i, all) => (
        <text key={tick} x={along(tick)} y={base + 18} text-anchor={i === 0 ? 'start' : 'middle'}>
          {i === all.length - 1 ? `${tick} m` : tick}
        </text>
      ))}
    </g>
  );
}

/** The cursor with the values of A, and of B below it, in the right margin. */
function Cursor({ comparison, rows, frame, at }: CursorOptions) {
  const { left, right, height, perRow } = frame;
  const x = left + (at / comparison.length) * (right - left);
  const i = pointAt(comparison, at);
  return (
    <g class="at">
      <text x={right + 14} y="12">
        {fixed(at, 0)} m
      </text>
      <line class="cursor" x1={x} x2={x} y1={TOP - 6} y2={height - BOTTOM} />
      {rows.map((row, r) => {
        const place = perRow[r] ?? { head: 0, top: 0, bottom: 0 };
        const [a, b] = [row.a[i] ?? NaN, row.b?.[i] ?? NaN];
        const middle = (place.top + place.bottom) / 2;
        const hasB = Number.isFinite(b);
        return (
          <g key={row.title}>
            {Number.isFinite(a) && <circle class={row.isGap ? toneOf(a) : 'a'} cx={x} cy={yOf(row, place, a)} r="4" />}
            {hasB && <circle class="b" cx={x} cy={yOf(row, place, b)} r="4" />}
            <text class={`value ${row.isGap ? toneOf(a) : ''}`} x={right + 14} y={hasB ? middle : middle + 6}>
              {row.write(a)}
            </text>
            {hasB && (
              <text class="other" x={right + 14} y={middle + 20}>
                {row.write(b)}
              </text>
            )}
          </g>
        );
      })}
    </g>
  );
}

interface CursorOptions {
  readonly comparison: Comparison;
  readonly rows: readonly Row[];
  readonly frame: Frame;
  readonly at: number;
}

const STEP_M = { fine: 2, coarse: 25 } as const; // of the arrow keys; chosen

interface Options {
  readonly comparison: Comparison;
  readonly isEngineer?: boolean;
  /** Where the cursor is [m], and what moves it; without it the picture is still. */
  readonly at?: number;
  readonly move?: (along: number) => void;
}

/** Gap, speed, pedal and steer along the lap, with one cursor. */
export function LapPlots({ comparison, isEngineer = false, at, move }: Options) {
  const host = useRef<HTMLDivElement>(null);
  const [size, setSize] = useState({ width: 720, height: 560 });
  useLayoutEffect(() => {
    if (!host.current) return undefined;
    const state = onScreen(host.current, () => {
      if (state.width > 0 && state.height > 0) setSize({ width: state.width, height: state.height });
    });
    return () => state.end();
  }, []);
  const unit = speedUnit();
  const rows = useMemo(() => rowsOf(comparison, unit, isEngineer), [comparison, unit, isEngineer]);
  const isMoved = move !== undefined;
  const frame = useMemo(() => frameOf(rows, size.width, size.height, isMoved), [rows, size, isMoved]);
  const curves = useMemo(() => <Curves comparison={comparison} rows={rows} frame={frame} />, [comparison, rows, frame]);
  const point = (event: PointerEvent): void => {
    const box = host.current?.getBoundingClientRect();
    if (!box || (event.pointerType !== 'mouse' && event.buttons === 0)) return;
    move?.(((event.clientX - box.left - frame.left) / (frame.right - frame.left)) * comparison.length);
  };
  const key = (event: KeyboardEvent): void => {
    const sense = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (sense === undefined || at === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    move?.(at + sense * (event.shiftKey ? STEP_M.coarse : STEP_M.fine));
  };
  const slider = isMoved && {
    role: 'slider' as const,
    tabIndex: 0,
    'aria-label': 'Place along the lap',
    'aria-valuemin': 0,
    'aria-valuemax': Math.round(comparison.length),
    'aria-valuenow': Math.round(at ?? 0),
    'aria-valuetext': `${fixed(at ?? 0, 0)} m: ${rows
      .map((row) => `${row.title} ${row.write(row.a[pointAt(comparison, at ?? 0)] ?? NaN)}`)
      .join(', ')}`,
    onPointerDown: point,
    onPointerMove: point,
    onKeyDown: key,
  };
  return (
    <div class={isEngineer ? 'lap-plots engineer' : 'lap-plots'} ref={host} {...(slider || {})}>
      <svg
        class="chart"
        viewBox={`0 0 ${size.width} ${size.height}`}
        role="img"
        aria-label={`${rows.map(({ title }) => title).join(', ')} along the lap`}
      >
        {curves}
        {at !== undefined && isMoved && <Cursor comparison={comparison} rows={rows} frame={frame} at={at} />}
      </svg>
    </div>
  );
}
