import { UNKNOWN } from '../lib/format';
import type { Limit } from '../protocol/topics';
import { gapCauses } from '../state/gap_causes';
import type { CornerTime } from '../state/time_won';
import { seconds } from './losses_table';

interface Options {
  readonly limit: Limit;
  readonly corners: readonly CornerTime[];
  readonly lost: number; // by the lap to the limit [s]
}

/** What each cause takes of a lap's gap to the limit; nothing where the run was not driven again (--explain). */
export function GapCausesTable({ limit, corners, lost }: Options) {
  const rows = gapCauses(limit, corners, lost);
  if (rows.length === 0) return null;
  const cell = (value: number): string => (Number.isFinite(value) ? seconds(value) : UNKNOWN);
  return (
    <table class="gap-causes" data-testid="gap-causes">
      <caption>What takes how much of the gap to the limit, s</caption>
      <thead>
        <tr>
          <th scope="col">Corner</th>
          <th scope="col">Gap</th>
          {limit.without.map((cause) => (
            <th key={cause} scope="col">
              {cause}
            </th>
          ))}
          <th scope="col">rest</th>
        </tr>
      </thead>
      <tbody>
        {rows.map(({ name, gap, taken, rest }) => (
          <tr key={name}>
            <th scope="row">{name}</th>
            <td>{cell(gap)}</td>
            {taken.map((value, i) => (
              <td key={limit.without[i]}>{cell(value)}</td>
            ))}
            <td>{cell(rest)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
