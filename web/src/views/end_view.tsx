import { useSignalEffect } from '@preact/signals';
import { fixed, lapTime, plural } from '../lib/format';
import { bestsOf } from '../state/lap_table';
import { laps } from '../state/laps';
import { gapsToLimit, limit } from '../state/limit';
import { link } from '../state/link';
import { call, can, retry } from '../state/operate';
import { canReplay, endReplay, REPLAY_S, replayLeft, startReplay } from '../state/replay';
import { isPaused, run } from '../state/run';
import { closeEnd, reopenEnd, runEnd, showsEnd } from '../state/run_end';
import { settings, startSettings } from '../state/settings';
import { commandAgain, sharedNow } from '../state/share';
import { silence } from '../state/shown';
import { HashView } from './hash_view';

function Results() {
  const all = laps.value;
  const bests = bestsOf(all);
  const best = all.find(({ lap }) => lap === bests.lap);
  const gap = best ? gapsToLimit(best, limit.value).lap : NaN;
  const unclean = all.filter(({ is_clean }) => !is_clean).length;
  return (
    <dl class="end-results">
      <div>
        <dt>Laps</dt>
        <dd data-testid="end-laps">{all.length}</dd>
      </div>
      <div>
        <dt>{bests.lap === 1 ? 'Best, from standstill' : 'Best'}</dt>
        <dd>{lapTime(bests.time, 3)}</dd>
      </div>
      {Number.isFinite(gap) && (
        <div>
          <dt>Above the limit</dt>
          <dd data-testid="end-gap">{fixed(gap, 1)} %</dd>
        </div>
      )}
      {unclean > 0 && (
        <div>
          <dt>Off the road</dt>
          <dd>{plural(unclean, 'lap')}</dd>
        </div>
      )}
    </dl>
  );
}

function Buttons() {
  const pace = settings.value.get('run.pace');
  const asked = Number(startSettings.value.get('laps')) || laps.value.length; // a page opened late has not seen all
  const command = commandAgain(sharedNow.value, {
    laps: runEnd.value?.kind === 'finished' ? asked : 0,
    pace: typeof pace === 'number' ? pace : NaN,
    port: Number(location.port),
  });
  // A program that waits for the limit, or ends, begins nothing any more.
  const canReset = can('/reset') && (isPaused.value || silence.value === 0);
  return (
    <>
      <div class="buttons">
        {replayLeft.value === null ? (
          <button type="button" disabled={!canReplay()} onClick={startReplay}>
            Replay the last {REPLAY_S} s
          </button>
        ) : (
          <button type="button" onClick={endReplay}>
            End the replay
          </button>
        )}
        {canReset && (
          <button type="button" class="primary" onClick={() => call('/reset')}>
            Again
          </button>
        )}
        {link.value === 'lost' && (
          <button type="button" onClick={retry}>
            Connect now
          </button>
        )}
      </div>
      {!canReset && run.value?.mode === 'drive' && (
        <p class="end-command">
          Again: <code>{command}</code>
          <button type="button" class="small" onClick={() => void navigator.clipboard?.writeText(command)}>
            Copy
          </button>
        </p>
      )}
    </>
  );
}

/** The card at the end of a run: how it ended, with which laps, and what can be done now. */
export function EndView() {
  useSignalEffect(reopenEnd);
  const end = runEnd.value;
  if (!end || !showsEnd.value) return null;
  return (
    <section class={`end-card panel ${end.severity}`} aria-label="End of the run" data-testid="end-card">
      <header>
        <h2 data-testid="end-title">{end.title}</h2>
        <button type="button" class="icon small" aria-label="Close" onClick={closeEnd}>
          ×
        </button>
      </header>
      <p class="soft" role="status">
        {end.why}
        {link.value === 'lost' && end.kind !== 'lost'
          ? ' The program has ended; this page keeps what it was told, and connects when it is started again.'
          : ''}
      </p>
      <Results />
      {__PAGE__ && <HashView />}
      <Buttons />
    </section>
  );
}
