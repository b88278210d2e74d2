import type { ComponentChildren } from 'preact';
import { fixed, lapTime } from '../lib/format';
import { store } from '../lib/store';
import { speedUnit } from '../lib/units';
import { GapCausesTable } from '../parts/gap_causes_table';
import { LossesTable, seconds } from '../parts/losses_table';
import { PlotView } from '../parts/plot_view';
import { along, type DrivenLap, startLine } from '../state/compared';
import { bestsOf } from '../state/lap_table';
import { limitChannel } from '../state/limit';
import { channelOnto, isSameRoad } from '../state/other_laps';
import { cornerTimes, type TwoLaps } from '../state/time_won';
import type { RunReport } from './summary';

// Where one lap of the report loses time to another: of the same run, of another one, or to the limit.

/** A lap of a report; `lap` 0: the limit. */
interface Pick {
  readonly report: RunReport;
  readonly lap: number;
}

const LIMIT = 0;
const timeOf = ({ report, lap }: Pick): number =>
  lap === LIMIT ? (report.limit?.lap_time_s ?? NaN) : (report.laps.find((each) => each.lap === lap)?.lap_time_s ?? NaN);

/** The lap at the points of another run on the same road. */
function drivenOnto(pick: Pick, onto: RunReport): DrivenLap {
  const { report, lap } = pick;
  const { limit, samples } = report;
  const channel = (name: 'time_s' | 'speed_mps'): Float64Array | null => {
    if (lap === LIMIT) return limit && limitChannel(limit, onto.samples, name);
    const other = { number: 0, recording: '', lap, time: timeOf(pick), samples };
    return channelOnto(other, name, onto.samples);
  };
  return { total: timeOf(pick), time: channel('time_s'), speed: channel('speed_mps') };
}

/** Two laps along the road of the first; null where one of them is not known there. */
export const lapsOf = (a: Pick, b: Pick): TwoLaps | null =>
  along(a.report.samples, [drivenOnto(a, a.report), drivenOnto(b, a.report)]);

const bestOf = (report: RunReport): number => bestsOf(report.laps).lap;

/** What the best lap of a run is compared with: the limit, or its next best lap; null without one. */
function rivalOf(report: RunReport): Pick | null {
  if (report.limit) return { report, lap: LIMIT };
  const next = bestsOf(report.laps.filter(({ lap }) => lap !== bestOf(report))).lap;
  return next > 0 ? { report, lap: next } : null;
}

/** Values along the road. */
const alongRoad = (s: Float64Array, values: Float64Array): number[] =>
  Array.from(values).flatMap((value, i) => [s[i] ?? NaN, value]);

function Losses({ a, b, title }: { a: Pick; b: Pick; title: ComponentChildren }) {
  const laps = lapsOf(a, b);
  if (!laps) return <p class="soft">These two laps have no common road: there is nothing to compare.</p>;
  const { samples } = a.report;
  const corners = cornerTimes(laps, a.report.corners, startLine(samples));
  return (
    <section class="time-won" data-testid="losses">
      <h3>
        {title} <span class="unit">{seconds(laps.total)} s</span>
      </h3>
      <LossesTable laps={laps} corners={corners} isForPrint />
      {b.lap === LIMIT && b.report.limit && (
        <GapCausesTable limit={b.report.limit} corners={corners} lost={laps.total} />
      )}
    </section>
  );
}

/** Where the best lap of a run loses time to the limit, or to the next best lap. */
export function BestLapLosses({ report }: { report: RunReport }) {
  const [lap, rival] = [bestOf(report), rivalOf(report)];
  if (lap < 1 || !rival || !report.samples.laps.includes(lap - 1)) return null;
  const to = rival.lap === LIMIT ? 'the limit' : `lap ${rival.lap}`;
  return <Losses a={{ report, lap }} b={rival} title={`Where lap ${lap} loses time to ${to}`} />;
}

/** The laps chosen, as indices of the list; null: the best laps of the first two runs. */
const chosen = store.signal<readonly [number | null, number | null]>('page', [null, null]);

function Choice({ which, picks, value }: { which: 0 | 1; picks: readonly Pick[]; value: number }) {
  return (
    <label>
      Lap {'AB'[which]}{' '}
      <select
        value={value}
        onChange={(event) => {
          const now = Number(event.currentTarget.value);
          chosen.value = which === 0 ? [now, chosen.value[1]] : [chosen.value[0], now];
        }}
      >
        {picks.map(({ report, lap }, i) => (
          <option key={`${report.name} ${lap}`} value={i}>
            {lap === LIMIT ? 'limit' : `lap ${lap}`} of {report.name}, {lapTime(timeOf({ report, lap }), 3)}
          </option>
        ))}
      </select>
    </label>
  );
}

/** Any two laps of several runs on one road: by default the best one of the first against that of the second. */
export function LapsOfRuns({ reports }: { reports: readonly RunReport[] }) {
  const [first] = reports;
  const same = reports.filter(({ samples }) => first && isSameRoad(samples, first.samples));
  const picks = same.flatMap((report): Pick[] => [
    ...(report.limit ? [{ report, lap: LIMIT }] : []),
    ...report.samples.laps.map((lap) => ({ report, lap: lap + 1 })),
  ]);
  const indexOfBest = (report: RunReport | undefined): number =>
    picks.findIndex((each) => each.report === report && each.lap === bestOf(each.report));
  const a = chosen.value[0] ?? indexOfBest(same[0]);
  const b = chosen.value[1] ?? indexOfBest(same[1]);
  const [lapA, lapB] = [picks[a], picks[b]];
  if (same.length < 2 || !lapA || !lapB) return null;
  const laps = lapsOf(lapA, lapB);
  const { name, perMps } = speedUnit();
  const gaps = laps?.time[0].map((time, i) => time - (laps.time[1][i] ?? NaN)) ?? new Float64Array();
  return (
    <section class="summary-laps" aria-label="Laps of two runs" data-testid="laps-of-runs">
      <h2>Where the time is lost between runs</h2>
      <div class="summary-choices">
        <Choice which={0} picks={picks} value={a} />
        <Choice which={1} picks={picks} value={b} />
      </div>
      {a === b ? (
        <p class="soft">Choose two laps.</p>
      ) : (
        <Losses a={lapA} b={lapB} title="Where lap A loses time to lap B" />
      )}
      {laps && a !== b && (
        <>
          <PlotView
            plot={{
              part: 'chart',
              title: `Speed of both laps along the road [${name}]`,
              x: 'along the road [m]',
              series: laps.speed.map((values, i) => ({
                draw: 'line',
                tone: i === 0 ? 'ink' : 'other',
                name: `lap ${'AB'[i]}`,
                values: alongRoad(
                  laps.s,
                  values.map((value) => value * perMps),
                ),
              })),
            }}
          />
          <PlotView
            plot={{
              part: 'chart',
              title: `Time gap along the road [s, + lap A behind], ${fixed(laps.total, 3)} at the end`,
              x: 'along the road [m]',
              series: [{ draw: 'line', tone: 'ink', name: '', values: alongRoad(laps.s, gaps) }],
            }}
          />
        </>
      )}
    </section>
  );
}
