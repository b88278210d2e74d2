import { valueInWords } from '../lib/scale';
import { canRace, endRace, keepWinner, race, raced, raceProblem, startRace } from '../state/rival';
import { standingOf } from '../state/rival_answer';
import { wishes } from '../state/what_if';

function Standing() {
  const now = race.value;
  if (!now) return null;
  const { winner, text } = standingOf(now);
  const settings = raced.value.map(({ key, value }) => `${key} ${valueInWords(value)}`);
  return (
    <section class="race stack" aria-label="The race" data-testid="race">
      <p class="soft">
        A is the car of this run, B the ghost{settings.length > 0 ? `: ${settings.join(', ')}` : ''}. Faults, grip,
        latency and noise act on both.
      </p>
      <p class={`verdict ${winner === 'B' ? 'better' : winner === 'A' ? 'worse' : ''}`} role="status">
        {now.state === 'building' && 'B is being built; both begin at the line.'}
        {now.state === 'racing' && <span data-testid="race-verdict">{text}</span>}
        {(now.state === 'ended' || now.state === 'failed') && `B drives no more: ${now.why}.`}
      </p>
      <p class="soft">Understand compares any lap of A with any of B.</p>
      <div class="row">
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
      <div class="row">
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
