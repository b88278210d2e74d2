import { fixed, lapTime } from '../lib/format';
import { tidy } from '../lib/scale';
import { canRace, endRace, keepWinner, race, raced, raceProblem, startRace } from '../state/rival';
import { gapsOf, type LapGap, verdictOf } from '../state/rival_answer';
import { wishes } from '../state/what_if';

const SAME_S = 0.005;
const NEWEST = 10;
const severity = (gap: number): string => (gap < -SAME_S ? 'better' : gap > SAME_S ? 'worse' : '');
const signed = (gap: number): string => `${gap > 0 ? '+' : ''}${fixed(gap, 3)}`;

function LapRow({ lap, a, b, thirds }: LapGap) {
  return (
    <tr>
      <th scope="row">{lap}</th>
      <td>{lapTime(a, 3)}</td>
      <td>{lapTime(b, 3)}</td>
      {thirds.map(({ sector, gap, cause }) => (
        <td key={sector} class={severity(gap)} title={cause}>
          {signed(gap)}
        </td>
      ))}
      <td class={severity(b - a)}>
        <b>{signed(b - a)}</b>
      </td>
    </tr>
  );
}

function Standing() {
  const now = race.value;
  if (!now) return null;
  const gaps = gapsOf(now);
  const { winner, text } = verdictOf(now);
  const newest = gaps[0];
  const settings = raced.value.map(({ key, value }) => `${key} ${typeof value === 'number' ? tidy(value) : value}`);
  return (
    <section class="race" aria-label="The race" data-testid="race">
      <p class="soft">
        A is the car of this run, B the ghost{settings.length > 0 ? `: ${settings.join(', ')}` : ''}. Faults, grip,
        latency and noise act on both.
      </p>
      <p class={`verdict ${winner === 'B' ? 'better' : winner === 'A' ? 'worse' : ''}`} role="status">
        {now.state === 'building' && 'B is being built; both begin at the line.'}
        {now.state === 'racing' && <span data-testid="race-verdict">{text}</span>}
        {(now.state === 'ended' || now.state === 'failed') && `B drives no more: ${now.why}.`}
      </p>
      {newest && (
        <>
          <ul class="causes" data-testid="race-causes">
            {newest.thirds.map(({ sector, gap, cause }) => (
              <li key={sector}>
                Lap {newest.lap}, sector {sector}: <b class={severity(gap)}>{signed(gap)} s</b>, B {cause}
              </li>
            ))}
          </ul>
          <div class="table-scroll" tabIndex={0} role="region" aria-label="Laps of both cars">
            <table data-testid="race-table">
              <thead>
                <tr>
                  <th scope="col">Lap</th>
                  <th scope="col">A</th>
                  <th scope="col">B</th>
                  <th scope="col">Sector 1 [s]</th>
                  <th scope="col">2 [s]</th>
                  <th scope="col">3 [s]</th>
                  <th scope="col">B − A [s]</th>
                </tr>
              </thead>
              <tbody>
                {gaps.slice(0, NEWEST).map((each) => (
                  <LapRow key={each.lap} {...each} />
                ))}
              </tbody>
            </table>
          </div>
        </>
      )}
      <div class="toolbar">
        {winner && raced.value.length > 0 && (
          <button type="button" class="primary" onClick={() => void keepWinner(winner)}>
            Keep {winner}, the winner
          </button>
        )}
        <button type="button" onClick={() => void endRace()}>
          End the race
        </button>
      </div>
    </section>
  );
}

/** Two settings on one stage: begins a race with the changes that are written above, and shows how it stands. */
export function RaceView() {
  if (!canRace()) return null;
  return (
    <>
      <div class="toolbar">
        <button
          type="button"
          disabled={wishes.value.length === 0}
          title="The run begins anew with two cars: yours as it is, and a second one with the changes"
          onClick={() => void startRace(wishes.value)}
        >
          Race A against B
        </button>
        <span class="soft">from the line, both on this stage, until you keep one</span>
        {raceProblem.value !== '' && (
          <p class="refusal" role="alert">
            {raceProblem.value}
          </p>
        )}
      </div>
      <Standing />
    </>
  );
}
