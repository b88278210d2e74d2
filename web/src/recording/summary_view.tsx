import { store } from '../lib/store';
import './summary.css';
import { useEffect } from 'preact/hooks';
import { speedColour, topOfScale } from '../draw/speed_colour';
import { fixed, lapTime, UNKNOWN } from '../lib/format';
import { inSpeedUnit, speedUnit } from '../lib/units';
import { PlotView } from '../parts/plot_view';
import type { Table } from '../parts/table';
import { TableView } from '../parts/table_view';
import { setupInWords } from '../state/lap_setup';
import { bestsOf } from '../state/lap_table';
import { gapsToLimit } from '../state/limit';
import { type RunReport, type Trace, verdictOf } from './summary';

/** The runs that are reported; empty while they are read. */
export const reports = store.signal<readonly RunReport[]>('page', []);
export const isSummaryShown = store.signal('page', false);

const MOST_POINTS = 700;
/** The settings at the start are told as text: whatever was changed is told. */
const NO_START = new Map<string, never>();

/** Indices of at most `MOST_POINTS` evenly spread samples. */
function spread(count: number): number[] {
  const step = Math.max(1, count / MOST_POINTS);
  return Array.from({ length: Math.ceil(count / step) }, (_, i) => Math.min(count - 1, Math.floor(i * step)));
}

interface CurveOptions {
  readonly title: string;
  readonly trace: Trace;
  readonly values: readonly number[];
  readonly faults: RunReport['faults'];
}

/** Values over the whole run, with the times of faults. */
function Curve({ title, trace, values, faults }: CurveOptions) {
  const points = spread(values.length).flatMap((i) => [trace.time[i] ?? NaN, values[i] ?? NaN]);
  const marks = faults.map(({ time }) => time);
  if (!points.some((value, i) => i % 2 === 1 && Number.isFinite(value))) return null;
  return (
    <PlotView
      plot={{
        part: 'chart',
        title,
        x: 'time [s]',
        series: [
          { draw: 'line', tone: 'ink', name: '', values: points },
          { draw: 'mark', tone: 'bad', name: marks.length > 0 ? 'fault' : '', values: marks },
        ],
      }}
    />
  );
}

/** The way driven, in the colours of its speeds. */
function SpeedMap({ report }: { report: RunReport }) {
  const { trace, run } = report;
  const at = spread(trace.x.length).filter((i) => Number.isFinite(trace.x[i]) && Number.isFinite(trace.y[i]));
  if (at.length < 2) return null;
  const [xs, ys] = [at.map((i) => trace.x[i] ?? 0), at.map((i) => trace.y[i] ?? 0)];
  const [minX, maxX, minY, maxY] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const margin = 0.03 * Math.max(maxX - minX, maxY - minY, 1);
  const top = topOfScale(run.body_length_m, speedUnit());
  const size = Math.max(maxX - minX, maxY - minY, 1);
  return (
    <svg
      class="summary-map"
      viewBox={`${minX - margin} ${-maxY - margin} ${maxX - minX + 2 * margin} ${maxY - minY + 2 * margin}`}
      role="img"
      aria-label="The way driven, in the colours of its speeds"
    >
      {at.slice(1).map((index, i) => (
        <line
          key={index}
          x1={xs[i]}
          y1={-(ys[i] ?? 0)}
          x2={xs[i + 1]}
          y2={-(ys[i + 1] ?? 0)}
          stroke={trace.isBad[index] ? 'var(--bad)' : speedColour((trace.speed[index] ?? 0) / top)}
          stroke-width={size * (trace.isBad[index] ? 0.016 : 0.009)}
          stroke-linecap="round"
        />
      ))}
    </svg>
  );
}

function LapTable({ report }: { report: RunReport }) {
  const bests = bestsOf(report.laps);
  const hasSetups = report.laps.some((lap) => setupInWords(lap, NO_START).length > 0);
  if (report.laps.length === 0) return <p class="soft">No lap was completed.</p>;
  return (
    <table class="lap-table">
      <thead>
        <tr>
          {[
            'Lap',
            'Time',
            'Above the limit',
            'S 1',
            'S 2',
            'S 3',
            `Top ${speedUnit().name}`,
            'To the edge [m]',
            ...(hasSetups ? ['Driven with'] : []),
          ].map((head) => (
            <th key={head} scope="col">
              {head}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        {report.laps.map((lap) => {
          const gap = gapsToLimit(lap, report.limit).lap;
          return (
            <tr key={lap.lap} class={lap.lap === bests.lap ? 'best' : ''}>
              <th scope="row">
                {lap.lap}
                {!lap.is_clean && <span class="badge bad">off road</span>}
              </th>
              <td class="time">{lapTime(lap.lap_time_s, 3)}</td>
              <td>{Number.isFinite(gap) ? `${fixed(gap, 1)} %` : UNKNOWN}</td>
              {[0, 1, 2].map((sector) => (
                <td key={sector}>{fixed(lap.sector_times_s[sector] ?? NaN, 2)}</td>
              ))}
              <td>{fixed(inSpeedUnit(lap.top_speed_mps), 1)}</td>
              <td>{fixed(lap.min_edge_distance_m, 2)}</td>
              {hasSetups && <td class="setup">{setupInWords(lap, NO_START).join(', ')}</td>}
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}

function RunSection({ report }: { report: RunReport }) {
  const { run, trace, faults, changes, settings } = report;
  const { severity, text } = verdictOf(report);
  const unit = speedUnit();
  return (
    <section class="summary-run" aria-label={report.name}>
      <h2>{report.name}</h2>
      <p class="soft">
        {run.controller} · {run.preset} · {run.car} · {run.track} · {fixed(run.latency_s * 1000, 0)} ms latency
      </p>
      <p class={`summary-verdict ${severity}`} data-testid="verdict">
        {text}
      </p>
      <SpeedMap report={report} />
      <LapTable report={report} />
      <Curve
        title={`Speed [${unit.name}] over the whole run`}
        trace={trace}
        values={trace.speed.map((value) => value * unit.perMps)}
        faults={faults}
      />
      <Curve title="Lateral error [m, + left] over the whole run" trace={trace} values={trace.error} faults={faults} />
      {faults.length > 0 && (
        <p>
          <b>Faults:</b> {faults.map(({ name, time }) => `${name} at ${fixed(time, 1)} s`).join(', ')}
        </p>
      )}
      {changes.length > 0 && (
        <p>
          <b>Changed while driving:</b>{' '}
          {changes.map(({ name, value, time }) => `${name} = ${value} at ${fixed(time, 1)} s`).join(', ')}
        </p>
      )}
      {settings !== '' && (
        <details>
          <summary>Recorded settings</summary>
          <pre tabIndex={0}>{settings}</pre>
        </details>
      )}
    </section>
  );
}

/** On paper nothing can be opened: everything is, while it is printed. */
function openWhilePrinting(): () => void {
  let closed: HTMLDetailsElement[] = [];
  const open = (): void => {
    closed = [...document.querySelectorAll<HTMLDetailsElement>('.summary-page details:not([open])')];
    for (const each of closed) each.open = true;
  };
  const close = (): void => {
    for (const each of closed) each.open = false;
  };
  addEventListener('beforeprint', open);
  addEventListener('afterprint', close);
  return () => {
    removeEventListener('beforeprint', open);
    removeEventListener('afterprint', close);
  };
}

/** Runs side by side, where there are several. */
function Comparison() {
  const all = reports.value;
  if (all.length < 2) return null;
  const rows: readonly (readonly [string, (report: RunReport) => string])[] = [
    ['Track', ({ run }) => run.track],
    ['Controller', ({ run }) => `${run.controller} · ${run.preset}`],
    ['Laps', ({ laps }) => String(laps.length)],
    ['Best', ({ laps }) => lapTime(bestsOf(laps).time, 3)],
    ['Off the road', ({ offTrackEvents }) => String(offTrackEvents)],
    ['Others drove', ({ interventions }) => String(interventions)],
    ['Commands changed', ({ gated }) => String(gated)],
    ['Duration', ({ duration }) => `${fixed(duration, 1)} s`],
  ];
  const table: Table = {
    part: 'table',
    title: '',
    columns: ['Run', ...all.map(({ name }) => name)],
    rows: rows.map(([title, value]) => [title, ...all.map(value)]),
  };
  return (
    <div data-testid="comparison">
      <TableView table={table} label="Runs side by side" />
    </div>
  );
}

/** What the recordings show, first in words: for reading and for print. */
export function SummaryView() {
  const all = reports.value;
  useEffect(openWhilePrinting, []);
  return (
    <main class={isSummaryShown.value ? 'summary-page' : 'summary-page hidden'} aria-label="Report" tabIndex={0}>
      <div class="summary-sheet">
        {all.length === 0 && <p class="empty">Reading the recording …</p>}
        <Comparison />
        {all.map((report) => (
          <RunSection key={report.name} report={report} />
        ))}
      </div>
    </main>
  );
}
