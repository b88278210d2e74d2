// Header of the page: menu, run, modes, state, the one button; and notices below it.
import { fixed } from '../lib/format';
import { Button } from '../parts/controls';
import { link, notice } from '../state/link';
import { MODES, type Mode, mode } from '../state/mode';
import { canSet } from '../state/operate';
import { chooseBefore, forgetOtherRun, inWords, otherRun } from '../state/other_run';
import { guardInWords, run } from '../state/run';
import { oneButton, pills, stateWord } from '../state/stage_state';
import { MenuView } from './menu_view';

/** Names of the modes. */
export const TITLES: Readonly<Record<Mode, string>> = { watch: 'Watch', understand: 'Understand', try: 'Try' };

/** Car, track and preset; all that is driven as its hint. */
function RunSummary() {
  const now = run.value;
  if (!now) return <p class="run">Waiting for a run</p>;
  const all = [
    now.controller,
    now.preset !== now.controller ? now.preset : '',
    now.car,
    now.track,
    `${fixed(now.latency_s * 1000, 0)} ms latency`,
    guardInWords(now),
  ];
  return (
    <p class="run cut" title={all.filter((part) => part !== '').join(' · ')}>
      {now.car} on {now.track}, {now.preset || now.controller}
    </p>
  );
}

/** Buttons of the modes. */
function Modes() {
  return (
    <nav class="modes" aria-label="Modes">
      {MODES.map((name, i) => (
        <Button
          key={name}
          id={`mode-${name}`}
          aria-current={mode.value === name ? 'page' : undefined}
          aria-keyshortcuts={String(i + 1)}
          act={() => (mode.value = name)}
        >
          {TITLES[name]}
        </Button>
      ))}
    </nav>
  );
}

/** Main button of the state of the run (pause, resume, drive again, …), if it has one; Space presses it. */
function One() {
  const now = oneButton.value;
  if (!now) return null;
  return (
    <Button class="one" aria-keyshortcuts="Space" disabled={!now.isPossible} act={() => now.act()}>
      {now.label}
    </Button>
  );
}

/** Notices, and the warning that a restarted program drives another run; screen readers announce both. */
function Notes() {
  return (
    <div aria-live="polite">
      {otherRun.value && link.value === 'live' && (
        <div class="note row apart" data-testid="other-run">
          <p>
            <b>Another run.</b> The program was started again with its own choice. Before, this page showed{' '}
            {inWords(otherRun.value)}.
          </p>
          <div class="row">
            {canSet('track') && <Button act={chooseBefore}>Drive that again</Button>}
            <Button act={forgetOtherRun}>Keep this one</Button>
          </div>
        </div>
      )}
      {notice.value !== null && (
        <div class="note row apart" data-testid="notice">
          <p>{notice.value}</p>
          <Button act={() => (notice.value = null)}>Dismiss</Button>
        </div>
      )}
    </div>
  );
}

/** The header and its notices. */
export function HeaderView() {
  return (
    <>
      <header class="head">
        <div class="row line">
          <MenuView />
          <RunSummary />
        </div>
        <Modes />
        <div class="row line end">
          <div class="row line end cut">
            {pills.value.map((text) => (
              <span key={text.split(',')[0]} class="pill cut">
                {text}
              </span>
            ))}
          </div>
          <p class="state" role="status">
            {stateWord.value}
          </p>
          <One />
        </div>
      </header>
      <Notes />
    </>
  );
}
