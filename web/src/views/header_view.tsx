import { fixed } from '../lib/format';
import type { ServiceName } from '../protocol/connection';
import { attempt, isPaused, link, notice, run, services, silence } from '../state/app_state';

export interface Actions {
  call(name: ServiceName, data?: boolean): void;
  retry(): void;
}

function RunSummary() {
  const now = run.value;
  if (!now) return <p class="summary">Waiting for a run</p>;
  const parts = [now.controller, now.car, now.track, `${fixed(now.latency_s * 1000, 0)} ms latency`].filter((part) => part !== '');
  return <p class="summary">{parts.join(' · ')}</p>;
}

function LinkState() {
  if (link.value === 'connecting') return <p class="pill">Connecting</p>;
  if (link.value === 'lost') return <p class="pill bad">Not connected</p>;
  if (isPaused.value) return <p class="pill warning">Paused</p>;
  if (silence.value > 0) return <p class="pill">No news for {silence.value} s</p>;
  return <p class="pill good">Live</p>;
}

function Buttons({ actions }: { actions: Actions }) {
  const can = (name: ServiceName): boolean => services.value.has(name) && link.value === 'live';
  if (services.value.size === 0) return null;
  return (
    <div class="buttons">
      {services.value.has('/pause') && (
        <button type="button" class="primary" disabled={!can('/pause')} aria-keyshortcuts="Space" title="Space" onClick={() => actions.call('/pause', !isPaused.value)}>
          {isPaused.value ? 'Resume' : 'Pause'}
        </button>
      )}
      {services.value.has('/step') && (
        <button type="button" disabled={!can('/step') || !isPaused.value} aria-keyshortcuts="S" title="One control step while paused (S)" onClick={() => actions.call('/step')}>
          Step
        </button>
      )}
      {services.value.has('/reset') && (
        <button type="button" disabled={!can('/reset')} aria-keyshortcuts="R" title="Back to the start (R)" onClick={() => actions.call('/reset')}>
          Reset
        </button>
      )}
    </div>
  );
}

/** What the reader must not miss: above everything, spoken by screen readers. */
function Banner({ actions }: { actions: Actions }) {
  return (
    <div aria-live="assertive">
      {link.value === 'lost' && (
        <div class="banner bad" data-testid="banner">
          <p>
            <b>Connection lost.</b> The numbers below are the last that came. Trying again{attempt.value > 1 ? ` (attempt ${attempt.value})` : ''} …
          </p>
          <button type="button" onClick={() => actions.retry()}>
            Try now
          </button>
        </div>
      )}
      {notice.value !== null && (
        <div class="banner warning" data-testid="notice">
          <p>{notice.value}</p>
          <button type="button" onClick={() => (notice.value = null)}>
            Dismiss
          </button>
        </div>
      )}
    </div>
  );
}

export function HeaderView({ actions }: { actions: Actions }) {
  return (
    <header class="top">
      <div class="top-row">
        <h1>
          <img src="./favicon.svg" alt="" width="22" height="22" />
          chicane
        </h1>
        <RunSummary />
        <LinkState />
        <Buttons actions={actions} />
      </div>
      <Banner actions={actions} />
    </header>
  );
}
