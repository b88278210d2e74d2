// View of a race of two settings: begin, standing, keep the winner.
import { valueInWords } from '../lib/scale';
import { Button, Refusal } from '../parts/controls';
import { canRace, endRace, keepWinner, race, raced, raceProblem, startRace } from '../state/rival';
import { standingOf } from '../state/rival_answer';
import { chosenSettings } from '../state/what_if';

/** State of the race, and the choice of its winner. */
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
      <p class={`value ${winner === 'B' ? 'won' : winner === 'A' ? 'lost' : ''}`} role="status">
        {now.state === 'building' && 'B is being built; both begin at the line.'}
        {now.state === 'racing' && <span data-testid="race-verdict">{text}</span>}
        {(now.state === 'ended' || now.state === 'failed') && `B drives no more: ${now.why}.`}
      </p>
      <p class="soft">Understand compares any lap of A with any of B.</p>
      <div class="row">
        {winner && raced.value.length > 0 && (
          <Button class="primary" act={() => keepWinner(winner)}>
            Keep {winner}, the winner
          </Button>
        )}
        <Button act={endRace}>End the race</Button>
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
        <Button
          disabled={chosenSettings.value.length === 0}
          title="The run begins anew with two cars: yours as it is, and a second one with the changes"
          act={() => startRace(chosenSettings.value)}
        >
          Race A against B
        </Button>
        <span class="soft">from the line, both on this stage, until you keep one</span>
        <Refusal text={raceProblem.value} />
      </div>
      <Standing />
    </>
  );
}
