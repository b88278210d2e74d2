import { download, downloadPng, fileName } from '../lib/download';
import { fixed, lapTime, UNKNOWN } from '../lib/format';
import { store } from '../lib/store';
import { inSpeedUnit, speedUnit } from '../lib/units';
import type { Lap, Limit } from '../protocol/topics';
import { pair as comparedPair, drawn, LIMIT } from '../state/compared';
import { differences, setupInWords } from '../state/lap_setup';
import { bestsOf, type LapBests, lapSamplesCsv, lapsCsv } from '../state/lap_table';
import { bestLap, lapSamples, laps, sampledLaps } from '../state/laps';
import { gapsToLimit, limit, whyNoLimit } from '../state/limit';
import { run } from '../state/run';
import { startSettings } from '../state/settings';
import { everyFrame } from '../state/ticker';
import { LapCompareView } from './lap_compare_view';
import { Picks } from './lap_picks';
import { OtherLapsView } from './other_laps_view';
import { TimeWonView } from './time_won_view';

function gap(seconds: number): string {
  if (!(Math.abs(seconds) >= 0.0005)) return UNKNOWN;
  return seconds > 0 ? `+${fixed(seconds, 3)}` : fixed(seconds, 3);
}

const percent = (value: number): string =>
  Number.isFinite(value) ? `${value >= 0 ? '+' : ''}${fixed(value, 1)} %` : UNKNOWN;

/** The first row: the fastest possible lap. */
function LimitRow({
  fastest,
  pair,
  hasSetups,
}: {
  fastest: Limit;
  hasSetups: boolean;
  pair: readonly [number, number];
}) {
  return (
    <tr class="limit" data-testid="limit">
      <th scope="row">limit</th>
      <td class="time">{lapTime(fastest.lap_time_s, 3)}</td>
      <td>{UNKNOWN}</td>
      {[0, 1, 2].map((sector) => (
        <td key={sector}>{fixed(fastest.sector_times_s[sector] ?? NaN, 2)}</td>
      ))}
      <td>{fixed(inSpeedUnit(fastest.speed_mps.reduce((a, b) => Math.max(a, b), 0)), 1)}</td>
      <td>{UNKNOWN}</td>
      <td>{UNKNOWN}</td>
      {hasSetups && <td />}
      <td>
        <Picks lap={LIMIT} pair={pair} name="the limit" />
      </td>
    </tr>
  );
}

/** With what a lap was driven: the first two things, all of them in its title. */
function SetupCell({ words }: { words: readonly string[] }) {
  const more = words.length - SETUP_WORDS;
  return (
    <td class="setup" title={words.join('\n')}>
      {words.slice(0, SETUP_WORDS).map((each) => (
        <span key={each} class="badge">
          {each}
        </span>
      ))}
      {more > 0 && <span class="badge">{more} more</span>}
    </td>
  );
}

interface RowOptions {
  readonly lap: Lap;
  readonly bests: LapBests;
  readonly pair: readonly [number, number];
  readonly hasSetups: boolean;
}

function Row({ lap, bests, pair, hasSetups }: RowOptions) {
  const isBest = lap.lap === bests.lap;
  const gaps = gapsToLimit(lap, limit.value);
  return (
    <tr class={isBest ? 'best' : ''}>
      <th scope="row">
        {lap.lap}
        {isBest && <span class="badge good">best</span>}
        {!lap.is_clean && <span class="badge bad">off road</span>}
      </th>
      <td class="time">
        {lapTime(lap.lap_time_s, 3)}
        {Number.isFinite(gaps.lap) && (
          <>
            {' '}
            <small data-testid="gap-to-limit" title="Above the fastest possible lap">
              {percent(gaps.lap)}
            </small>
          </>
        )}
      </td>
      <td>{gap(lap.lap_time_s - bests.time)}</td>
      {[0, 1, 2].map((sector) => {
        const time = lap.sector_times_s[sector] ?? NaN;
        return (
          <td key={sector} class={lap.is_clean && time === bests.sectors[sector] ? 'best-sector' : ''}>
            {Number.isFinite(time) ? fixed(time, 2) : UNKNOWN}
            {Number.isFinite(gaps.sectors[sector]) && (
              <>
                {' '}
                <small title="Above the same sector of the fastest possible lap">
                  {percent(gaps.sectors[sector] ?? NaN)}
                </small>
              </>
            )}
          </td>
        );
      })}
      <td>{fixed(inSpeedUnit(lap.top_speed_mps), 1)}</td>
      <td>{fixed(lap.min_edge_distance_m, 2)}</td>
      <td>{fixed(lap.rms_lateral_error_m, 2)}</td>
      {hasSetups && <SetupCell words={setupInWords(lap, startSettings.value)} />}
      <td>
        <Picks lap={lap.lap} pair={pair} name={`lap ${lap.lap}`} />
      </td>
    </tr>
  );
}

const ROWS = 40;
const SETUP_WORDS = 2;
const showsAll = store.signal('page', false);

/** The newest laps and the best, or all laps. */
function rowsOf(all: readonly Lap[], bests: LapBests): Lap[] {
  const first = showsAll.value ? 0 : all.length - ROWS;
  return all.filter((lap, i) => i >= first || lap.lap === bests.lap).reverse();
}

/** Saves the map as a picture, right after it was painted: a 3D canvas is cleared later. */
function savePicture(): void {
  const end = everyFrame(() => {
    end();
    const canvas = document.querySelector<HTMLCanvasElement>('.map canvas');
    if (!canvas) return;
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [canvas.width, canvas.height];
    copy.getContext('2d')?.drawImage(canvas, 0, 0);
    downloadPng(fileName([run.value?.track ?? '', 'map'], 'png'), copy);
  });
}

function Toolbar({ pair }: { pair: readonly [number, number] }) {
  const parts = [run.value?.track ?? '', run.value?.controller ?? ''];
  const has = laps.value.length > 0;
  return (
    <div class="toolbar">
      <button
        type="button"
        disabled={!has}
        onClick={() => download(fileName([...parts, 'laps'], 'csv'), lapsCsv(laps.value, limit.value), 'text/csv')}
      >
        Table as CSV
      </button>
      <button
        type="button"
        disabled={!has || !lapSamples.laps.includes(pair[0] - 1)}
        title="Time, speed, error and commands of lap A along the track"
        onClick={() =>
          download(fileName([...parts, `lap-${pair[0]}`], 'csv'), lapSamplesCsv(lapSamples, pair[0] - 1), 'text/csv')
        }
      >
        Lap A as CSV
      </button>
      <button type="button" onClick={savePicture}>
        Map as PNG
      </button>
    </div>
  );
}

/** What differed between the two laps that are compared. */
function Differences({ all, pair }: { all: readonly Lap[]; pair: readonly [number, number] }) {
  const [a, b] = pair.map((number) => all.find(({ lap }) => lap === number));
  if (!a || !b || a === b) return null;
  const found = differences(a, b, startSettings.value);
  if (found.length === 0) return null;
  return (
    <p class="lap-difference" data-testid="lap-difference">
      What differed, lap {a.lap} | lap {b.lap}:{' '}
      {found.map(({ what, a: one, b: other }, i) => (
        <span key={what}>
          {i > 0 && ', '}
          <code>{what}</code> <b>{one}</b> | <b>{other}</b>
        </span>
      ))}
    </p>
  );
}

function headsOf(hasSetups: boolean): string[] {
  const heads = ['Lap', 'Time', 'Gap', 'S 1', 'S 2', 'S 3', `Top ${speedUnit().name}`, 'Edge', 'Error'];
  return [...heads, ...(hasSetups ? ['Driven with'] : []), 'Compare'];
}

export function LapsView() {
  const all = laps.value;
  void sampledLaps.value;
  const bests = bestsOf(all);
  const pair = comparedPair.value;
  const hasSetups = all.some((lap) => setupInWords(lap, startSettings.value).length > 0);
  return (
    <div class="laps">
      <Toolbar pair={pair} />
      {whyNoLimit.value !== '' && (
        <p class="soft" data-testid="no-limit">
          No gap to the limit: {whyNoLimit.value}.
        </p>
      )}
      {all.length === 0 ? (
        <p class="empty">
          {Number.isFinite(bestLap.value)
            ? `Best lap ${lapTime(bestLap.value, 3)}; this run reports no details of its laps.`
            : 'No lap completed yet.'}
        </p>
      ) : (
        <div class="table-scroll" tabIndex={0} role="region" aria-label="Laps">
          <table class="lap-table">
            <thead>
              <tr>
                {headsOf(hasSetups).map((head) => (
                  <th key={head} scope="col">
                    {head}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              {limit.value && <LimitRow fastest={limit.value} pair={pair} hasSetups={hasSetups} />}
              {rowsOf(all, bests).map((lap) => (
                <Row key={lap.lap} lap={lap} bests={bests} pair={pair} hasSetups={hasSetups} />
              ))}
            </tbody>
          </table>
          {all.length > ROWS && (
            <button type="button" aria-pressed={showsAll.value} onClick={() => (showsAll.value = !showsAll.value)}>
              All {all.length} laps
            </button>
          )}
        </div>
      )}
      <OtherLapsView pair={pair} />
      <Differences all={all} pair={pair} />
      <TimeWonView />
      {pair[0] !== pair[1] && <LapCompareView numbers={drawn.value} />}
    </div>
  );
}
