import { fixed, lapTime } from '../lib/format';
import { BY_HAND, board, forgetBoard } from '../state/leaderboard';
import { run } from '../state/run';

/** The best laps of people and controllers on this track; shown once two of them have driven. */
export function LeaderboardView() {
  const all = board.value;
  const best = all[0]?.time ?? NaN;
  if (all.length < 2) return null;
  return (
    <section class="leaderboard" aria-label="Leaderboard" data-testid="leaderboard">
      <header class="with-button">
        <h2>
          Leaderboard{' '}
          <span class="unit">
            best clean laps of {run.value?.car} on {run.value?.track}, kept in this browser
          </span>
        </h2>
        <button type="button" class="small" onClick={forgetBoard}>
          Forget
        </button>
      </header>
      <ol>
        {all.map(({ who, time }) => (
          <li key={who} class={who.startsWith(BY_HAND) ? 'person' : ''}>
            <span>{who}</span>
            <b>{lapTime(time, 3)}</b>
            <span class="unit">{time > best ? `+${fixed(time - best, 3)}` : ''}</span>
          </li>
        ))}
      </ol>
    </section>
  );
}
