import { scheme, toggleScheme } from '../lib/appearance';
import { fixed } from '../lib/format';
import { tidy } from '../lib/scale';
import { attempt, link, notice, pastLeft, services } from '../state/link';
import { call, can, canSet, retry } from '../state/operate';
import { chooseBefore, forgetOtherRun, inWords, otherRun } from '../state/other_run';
import { isStageAlone } from '../state/presentation';
import { replayLeft } from '../state/replay';
import { guardInWords, isPaused, run } from '../state/run';
import { settings } from '../state/settings';
import { behind, shown, silence } from '../state/shown';
import { isHelpOpen } from './help_view';
import { TourButton } from './tour_view';

function RunSummary() {
  const now = run.value;
  if (!now) return <p class="summary">Waiting for a run</p>;
  const parts = [
    now.controller,
    now.preset !== now.controller ? now.preset : '',
    now.car,
    now.track,
    `${fixed(now.latency_s * 1000, 0)} ms latency`,
    guardInWords(now),
  ];
  return <p class="summary">{parts.filter((part) => part !== '').join(' · ')}</p>;
}

function LinkState() {
  const end = run.value?.end ?? '';
  if (replayLeft.value !== null) return <p class="pill accent">Replay, {replayLeft.value} s left</p>;
  if (link.value === 'lost')
    return end === '' ? <p class="pill bad">Not connected</p> : <p class="pill">Program ended</p>;
  if (link.value === 'connecting' || !run.value) return <p class="pill">Connecting</p>;
  if (run.value.mode === 'replay') return <p class="pill accent">{isPaused.value ? 'Recording' : 'Recording plays'}</p>;
  if (isPaused.value) return <p class="pill warning">Paused</p>;
  if (silence.value > 0 && end !== '') return <p class="pill">Over</p>;
  if (silence.value > 0) return <p class="pill">No data for {silence.value} s</p>;
  if (behind.value > 0) return <p class="pill warning">{behind.value} s behind</p>;
  return <p class="pill good">Live</p>;
}

/** So many frames come within a moment on any line but a slow one. */
const SOON = 400;

/** Marks for unusual states: next run, driving by hand, faults, pace. */
function Marks() {
  const frame = shown.value;
  const asked = settings.value.get('run.pace'); // a paused recording has no frame that tells a new one
  const pace = typeof asked === 'number' ? asked : (frame?.pace ?? NaN);
  return (
    <>
      {(run.value?.building ?? '') !== '' && (
        <p class="pill accent" data-testid="building">
          Next: {run.value?.building} …
        </p>
      )}
      {frame?.is_manual && <p class="pill accent">By hand</p>}
      {(frame?.active_faults ?? 0) !== 0 && <p class="pill bad">Fault</p>}
      {pastLeft.value > SOON && <p class="pill">Loading the past: {pastLeft.value} frames</p>}
      {Number.isFinite(pace) && Math.abs(pace - 1) > 1e-6 && <p class="pill">{tidy(pace)}× speed</p>}
    </>
  );
}

function Buttons() {
  if (services.value.size === 0) return null;
  return (
    <div class="buttons">
      {services.value.has('/pause') && run.value?.mode !== 'replay' && (
        <button
          type="button"
          class="primary"
          disabled={!can('/pause')}
          aria-keyshortcuts="Space"
          title="Space"
          onClick={() => call('/pause', !isPaused.value)}
        >
          {isPaused.value ? 'Resume' : 'Pause'}
        </button>
      )}
      {services.value.has('/step') && (
        <button
          type="button"
          disabled={!can('/step') || !isPaused.value}
          aria-keyshortcuts="S"
          title="One control step while paused (S)"
          onClick={() => call('/step')}
        >
          Step
        </button>
      )}
      {services.value.has('/reset') && (
        <button
          type="button"
          disabled={!can('/reset')}
          aria-keyshortcuts="R"
          title="Back to the start of the run (R)"
          onClick={() => call('/reset')}
        >
          Reset
        </button>
      )}
    </div>
  );
}

/** Lost connection and messages of the server; screen readers announce it. */
function Banner() {
  return (
    <div aria-live="assertive">
      {otherRun.value && link.value === 'live' && (
        <div class="banner warning" data-testid="other-run">
          <p>
            <b>Another run.</b> The program was started again with its own choice. Before, this page showed{' '}
            {inWords(otherRun.value)}.
          </p>
          <div class="buttons">
            {canSet('track') && (
              <button type="button" onClick={() => void chooseBefore()}>
                Drive that again
              </button>
            )}
            <button type="button" onClick={forgetOtherRun}>
              Keep this one
            </button>
          </div>
        </div>
      )}
      {link.value === 'lost' && (run.value?.end ?? '') === '' && (
        <div class="banner bad" data-testid="banner">
          <p>
            <b>Connection lost.</b> The numbers below are the last ones received. Reconnecting
            {attempt.value > 1 ? ` (attempt ${attempt.value})` : ''} …
          </p>
          <button type="button" onClick={retry}>
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

export function HeaderView() {
  return (
    <header class={isStageAlone.value ? 'top alone' : 'top'}>
      <div class="top-row">
        <h1>
          <svg viewBox="0 0 32 32" width="22" height="22" aria-hidden="true">
            <rect width="32" height="32" rx="8" fill="#2563d9" />
            <path d="M9 27C9 17 23 17 23 5" fill="none" stroke="#fff" stroke-width="5" stroke-linecap="round" />
            <path d="M9 27C9 17 23 17 23 5" fill="none" stroke="#2563d9" stroke-width="1" stroke-dasharray="2.5 3" />
          </svg>
          <span>chicane</span>
        </h1>
        <RunSummary />
        <div class="pills">
          <Marks />
          <LinkState />
        </div>
        <Buttons />
        <TourButton />
        <button
          type="button"
          class="icon"
          aria-label={scheme.value === 'dark' ? 'Change to light colours' : 'Change to dark colours'}
          title="Light or dark (T)"
          aria-keyshortcuts="T"
          onClick={toggleScheme}
        >
          <svg viewBox="0 0 16 16" width="16" height="16" aria-hidden="true">
            <circle cx="8" cy="8" r="5.5" fill="none" stroke="currentColor" stroke-width="1.5" />
            <path d="M8 2.5a5.5 5.5 0 0 1 0 11z" fill="currentColor" />
          </svg>
        </button>
        <button
          type="button"
          class="icon help"
          aria-label="Keys and help"
          title="Keys and help (?)"
          aria-keyshortcuts="?"
          onClick={() => (isHelpOpen.value = true)}
        >
          ?
        </button>
      </div>
      <Banner />
    </header>
  );
}
