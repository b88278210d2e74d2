// Table of the corners of a comparison: time lost in each, and why.
import { byCost, type Comparison, signed, toneOf, whyOf } from '../state/comparison';
import { Heads } from './controls';

interface Options {
  readonly comparison: Comparison;
  /** The corner at this place is marked [m]. */
  readonly at?: number;
  readonly pick?: (apex: number) => void;
}

/** The corners by what they cost, or bring, with the reason. */
export function CornerTable({ comparison, at, pick }: Options) {
  const corners = byCost(comparison);
  const most = Math.max(0.01, ...corners.map(({ lost }) => Math.abs(lost)));
  if (corners.length === 0) return null;
  return (
    <table class="corner-costs" data-testid="corner-costs">
      <caption class="sr-only">Corners by cost</caption>
      <Heads quiet of={['Corner', 'Share', 'Lost, s', 'Because']} />
      <tbody>
        {corners.map((corner) => {
          const { name, lost, from, to, apex } = corner;
          return (
            <tr key={name} class={at !== undefined && at >= from && at < to ? 'at' : ''} onClick={() => pick?.(apex)}>
              <th scope="row">
                {pick ? (
                  <button type="button" class="plain" title={`Put the cursor on ${name}`}>
                    {name}
                  </button>
                ) : (
                  name
                )}
              </th>
              <td>
                <i class={`gauge ${toneOf(lost)}`}>
                  <u class="cover" style={{ transform: `scaleX(${Math.abs(lost) / most})` }} />
                </i>
              </td>
              <td class="number">
                <b>{signed(lost)}</b>
              </td>
              <td class="why">{whyOf(corner)}</td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
