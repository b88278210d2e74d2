import { useState } from 'preact/hooks';
import { fixed } from '../lib/format';
import { inSpeedUnit, speedUnit } from '../lib/units';
import { scaleOf } from '../state/compared';
import { type Cause, type CornerTime, miniSectors, type Stretch, type TwoLaps } from '../state/time_won';

// Where one lap loses time to another, as strip and tables: on the page, and in a report.

export const seconds = (lost: number): string => `${lost >= 0 ? '+' : ''}${fixed(lost, 2)}`;

/** The least that is worth a cause [s]. */
const WORTH_S = 0.005;
const colourOf = (lost: number): string => (lost >= WORTH_S ? 'slower' : lost <= -WORTH_S ? 'faster' : '');

function causeInWords(cause: Cause, isLost: boolean): string {
  const pace = isLost ? 'slower' : 'faster';
  switch (cause.kind) {
    case 'braking':
      return `braking ${fixed(Math.abs(cause.metres), 0)} m ${isLost ? 'earlier' : 'later'}`;
    case 'apex':
      return `${fixed(Math.abs(inSpeedUnit(cause.mps)), 1)} ${speedUnit().name} ${pace} in the bend`;
    case 'in':
      return `${isLost ? 'less' : 'more'} speed on the way in`;
    case 'out':
      return `${isLost ? 'less' : 'more'} speed on the way out`;
    case 'way':
      return `a ${pace} way through the bend`;
  }
}

/** "0.14 s lost, 0.10 s of it braking 12 m earlier" */
export function cornerInWords({ lost, main }: CornerTime): string {
  if (!Number.isFinite(lost)) return 'not seen'; // a lap that was recorded in part
  if (Math.abs(lost) < WORTH_S) return 'the same';
  const isLost = lost > 0;
  const part = Math.min(Math.abs(main.lost), Math.abs(lost));
  const why = `${fixed(part, 2)} s of it ${causeInWords(main.cause, isLost)}`;
  return `${fixed(Math.abs(lost), 2)} s ${isLost ? 'lost' : 'gained'}, ${why}`;
}

/** From green, gained, over nothing to red, lost; `most` is the end of the scale [s]. */
function lossColour(lost: number, most: number): string {
  if (!Number.isFinite(lost)) return 'transparent';
  const share = Math.min(1, Math.abs(lost) / most);
  return `color-mix(in srgb, var(${lost > 0 ? '--bad' : '--good'}) ${Math.round(100 * share)}%, var(--grid))`;
}

function Strip({ pieces }: { pieces: readonly Stretch[] }) {
  const most = scaleOf(pieces);
  return (
    <div class="mini-sectors" aria-hidden="true">
      {pieces.map(({ from, to, lost }) => (
        <span
          key={from}
          style={{ background: lossColour(lost, most) }}
          title={`${fixed(from, 0)} to ${fixed(to, 0)} m: ${seconds(lost)} s`}
        />
      ))}
    </div>
  );
}

function CornerRow({ corner, isMost, show }: { corner: CornerTime; isMost: boolean; show?: ShowCorner | undefined }) {
  return (
    <tr class={isMost ? 'most' : ''} onMouseEnter={() => show?.(corner)} onMouseLeave={() => show?.(null)}>
      <th scope="row">T{corner.number}</th>
      <td>{fixed(corner.apex, 0)} m</td>
      <td class={colourOf(corner.lost)}>{seconds(corner.lost)}</td>
      <td class="cause">{cornerInWords(corner)}</td>
    </tr>
  );
}

/** Every mini-sector in figures, for readers of tables; made when it is opened, or at once for print. */
function MiniSectorTable({ pieces, isForPrint }: { pieces: readonly Stretch[]; isForPrint: boolean }) {
  const [isOpen, setOpen] = useState(false);
  return (
    <details class="mini-sector-table" onToggle={({ currentTarget }) => setOpen(currentTarget.open)}>
      <summary>Mini-sectors of {fixed((pieces[0]?.to ?? 0) - (pieces[0]?.from ?? 0), 1)} m</summary>
      {(isOpen || isForPrint) && (
        <ol>
          {pieces.map(({ from, lost }) => (
            <li key={from}>
              <span>{fixed(from, 0)} m</span> <b class={colourOf(lost)}>{seconds(lost)} s</b>
            </li>
          ))}
        </ol>
      )}
    </details>
  );
}

/** Told which corner is pointed at; null: none. */
export type ShowCorner = (corner: CornerTime | null) => void;

interface Options {
  readonly laps: TwoLaps;
  readonly corners: readonly CornerTime[];
  readonly show?: ShowCorner;
  readonly isForPrint?: boolean;
}

/** By mini-sectors, and by corners with the cause; the corner that costs most is in bold. */
export function LossesTable({ laps, corners, show, isForPrint = false }: Options) {
  const pieces = miniSectors(laps);
  const known = corners.filter(({ lost }) => Number.isFinite(lost));
  const most = known.reduce<CornerTime | null>((x, y) => (x && x.lost >= y.lost ? x : y), null);
  return (
    <>
      <Strip pieces={pieces} />
      {corners.length > 0 && (
        <table>
          <thead>
            <tr>
              <th scope="col">Corner</th>
              <th scope="col">At</th>
              <th scope="col">Lost, s</th>
              <th scope="col">Mostly by</th>
            </tr>
          </thead>
          <tbody>
            {corners.map((corner) => (
              <CornerRow
                key={corner.number}
                corner={corner}
                isMost={corner === most && corner.lost >= WORTH_S}
                show={show}
              />
            ))}
          </tbody>
        </table>
      )}
      <MiniSectorTable pieces={pieces} isForPrint={isForPrint} />
    </>
  );
}
