// Table of all laps and of the fastest possible one.
import { fixed, lapTime, UNKNOWN } from '../lib/format';
import { inSpeedUnit, speedUnit } from '../lib/units';
import type { Setting } from '../protocol/source';
import type { Lap, Limit } from '../protocol/topics';
import { signed, toneOf } from '../state/comparison';
import { setupInWords } from '../state/lap_setup';
import { bestOf } from '../state/lap_table';
import { Button, Heads } from './controls';

interface Options {
  /** Name of the run, where a page has several. */
  readonly of?: string;
  readonly laps: readonly Lap[];
  readonly limit: Limit | null;
  /** What the run began with; a lap shows what was otherwise. */
  readonly start?: ReadonlyMap<string, Setting>;
  /** Called with the number of a lap that is chosen. */
  readonly pick?: (lap: number) => void;
}

const NO_START: ReadonlyMap<string, Setting> = new Map();
const SECTORS = [0, 1, 2] as const;

/** All laps, below the limit: times, what each is behind it, sectors, top speed, distance to the edge. */
export function LapTable({ of = '', laps, limit, start = NO_START, pick }: Options) {
  const best = bestOf(laps)?.lap;
  const setups = laps.map((lap) => setupInWords(lap, start).join(', '));
  const hasSetups = setups.some((words) => words !== '');
  const heads = [
    'Lap',
    'Time',
    'To the limit, s',
    'S 1',
    'S 2',
    'S 3',
    `Top speed, ${speedUnit().name}`,
    'To the edge, m',
  ];
  return (
    <div class="table-scroll" role="region" aria-label={of === '' ? 'All laps' : `All laps of ${of}`} tabIndex={0}>
      <table class="lap-rows" data-testid="lap-rows">
        <Heads of={hasSetups ? [...heads, 'Driven with'] : heads} />
        <tbody>
          {limit && (
            <tr class="limit other" data-testid="limit">
              <th scope="row">limit</th>
              <td>{lapTime(limit.lap_time_s, 3)}</td>
              <td />
              {SECTORS.map((sector) => (
                <td key={sector}>{fixed(limit.sector_times_s[sector] ?? NaN, 3)}</td>
              ))}
              <td>{fixed(inSpeedUnit(limit.speed_mps.reduce((a, b) => Math.max(a, b), 0)), 0)}</td>
              <td />
              {hasSetups && <td />}
            </tr>
          )}
          {laps.map((lap, i) => {
            const behind = limit && lap.lap >= limit.first_lap ? lap.lap_time_s - limit.lap_time_s : NaN;
            const remarks = [lap.lap === best ? 'best' : '', lap.is_clean ? '' : 'off the road'].filter(Boolean);
            return (
              <tr key={lap.lap} class={lap.lap === best ? 'best' : ''}>
                <th scope="row">
                  {pick ? (
                    <Button class="plain" act={() => pick(lap.lap)} title={`Compare lap ${lap.lap}`}>
                      {lap.lap}
                    </Button>
                  ) : (
                    lap.lap
                  )}
                  {remarks.length > 0 && `, ${remarks.join(', ')}`}
                </th>
                <td>{lapTime(lap.lap_time_s, 3)}</td>
                <td class={toneOf(behind)}>{Number.isFinite(behind) ? signed(behind) : UNKNOWN}</td>
                {SECTORS.map((sector) => (
                  <td key={sector}>{fixed(lap.sector_times_s[sector] ?? NaN, 3)}</td>
                ))}
                <td>{fixed(inSpeedUnit(lap.top_speed_mps), 0)}</td>
                <td>{fixed(lap.min_edge_distance_m, 2)}</td>
                {hasSetups && <td class="setup">{setups[i]}</td>}
              </tr>
            );
          })}
        </tbody>
      </table>
    </div>
  );
}
