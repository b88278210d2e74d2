import { fixed } from '../lib/format';
import { inSpeedUnit, speedUnit } from '../lib/units';
import { LIMIT, pair, roadCorners, scaleOf, startLine, twoLaps } from '../state/compared';
import { lapSamples } from '../state/laps';
import { cursorPlace } from '../state/plot_view';
import { type Cause, type CornerTime, cornerTimes, miniSectors, type Stretch } from '../state/time_won';

const nameOf = (lap: number): string => (lap === LIMIT ? 'the limit' : `lap ${lap}`);
const seconds = (lost: number): string => `${lost >= 0 ? '+' : ''}${fixed(lost, 2)}`;

/** The least that is worth a cause [s]. */
const WORTH_S = 0.005;

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
function cornerInWords({ lost, main }: CornerTime): string {
  if (!(Math.abs(lost) >= WORTH_S)) return 'the same';
  const isLost = lost > 0;
  const part = Math.min(Math.abs(main.lost), Math.abs(lost));
  const why = `${fixed(part, 2)} s of it ${causeInWords(main.cause, isLost)}`;
  return `${fixed(Math.abs(lost), 2)} s ${isLost ? 'lost' : 'gained'}, ${why}`;
}

/** From green, gained, over nothing to red, lost; `most` is the end of the scale [s]. */
function lossColour(lost: number, most: number): string {
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

function CornerRow({ corner, isMost }: { corner: CornerTime; isMost: boolean }) {
  const show = (isShown: boolean): void => {
    const place = (startLine() + corner.apex) % lapSamples.length;
    cursorPlace.value = isShown && pair.value[0] !== LIMIT ? { lap: pair.value[0] - 1, place } : null;
  };
  return (
    <tr class={isMost ? 'most' : ''} onMouseEnter={() => show(true)} onMouseLeave={() => show(false)}>
      <th scope="row">T{corner.number}</th>
      <td>{fixed(corner.apex, 0)} m</td>
      <td class={corner.lost >= WORTH_S ? 'slower' : corner.lost <= -WORTH_S ? 'faster' : ''}>
        {seconds(corner.lost)}
      </td>
      <td class="cause">{cornerInWords(corner)}</td>
    </tr>
  );
}

/** Where lap A loses time to lap B, by mini-sectors and by corners with the cause. */
export function TimeWonView() {
  const laps = twoLaps.value;
  if (!laps) return null;
  const [a, b] = pair.value;
  const corners = cornerTimes(laps, roadCorners(), startLine());
  const most = corners.reduce<CornerTime | null>((x, y) => (x && x.lost >= y.lost ? x : y), null);
  return (
    <section class="block time-won" aria-label="Where the time is won" data-testid="time-won">
      <h2>
        Where {nameOf(a)} loses time to {nameOf(b)} <span class="unit">{seconds(laps.total)} s</span>
      </h2>
      <Strip pieces={miniSectors(laps)} />
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
              <CornerRow key={corner.number} corner={corner} isMost={corner === most && corner.lost >= WORTH_S} />
            ))}
          </tbody>
        </table>
      )}
    </section>
  );
}
