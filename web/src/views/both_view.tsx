import { lapTime } from '../lib/format';
import { store } from '../lib/store';
import { watchBoth } from '../recording/what_if_ghost';
import { toAsk } from '../state/chosen_settings';
import { chosen, futures } from '../state/compared';
import { mode } from '../state/mode';
import { canSet, set } from '../state/operate';
import { cursorTime } from '../state/plot_view';
import { endReplay, replayLeft } from '../state/replay';
import { run } from '../state/run';
import { labelOf } from '../state/setting_search';
import { entryOf } from '../state/settings';
import {
  answer,
  ask,
  asked,
  askedLog,
  canAsk,
  type From,
  forgetAnswer,
  from,
  offered,
  problem,
  progress,
  type Span,
  span,
  type Wish,
  wishes,
} from '../state/what_if';
import { trustOf, verdictOf } from '../state/what_if_answer';

// *Drive both*: another future of the run, from a moment on, beside the one that is.

const kept = store.signal<readonly Wish[] | null>('page', null);

export const canDriveBoth = (): boolean => offered().length > 0 && canAsk();

const SPANS: readonly { span: Span; label: string }[] = [
  { span: '10', label: '10 s' },
  { span: '30', label: '30 s' },
  { span: 'lap', label: 'a lap' },
];

/** From when, and for how long, as words of a sentence. */
export function WhenView() {
  const cursor = cursorTime.value;
  return (
    <p class="when">
      Both drive from{' '}
      <select
        aria-label="From when"
        value={from.value}
        onChange={(event) => (from.value = event.currentTarget.value as From)}
      >
        <option value="now">{askedLog.value ? 'here' : 'now'}</option>
        <option value="line">the line</option>
        <option value="cursor" disabled={cursor === null && from.value !== 'cursor'}>
          the cursor{cursor === null ? '' : `, ${lapTime(cursor)}`}
        </option>
      </select>{' '}
      for{' '}
      <select
        aria-label="For how long"
        value={span.value}
        onChange={(event) => (span.value = event.currentTarget.value as Span)}
      >
        {SPANS.map(({ span: value, label }) => (
          <option key={value} value={value}>
            {label}
          </option>
        ))}
      </select>
      .
    </p>
  );
}

function driveBoth(): void {
  kept.value = null;
  wishes.value = toAsk.value;
  void ask();
}

export function DriveBothButton() {
  const share = progress.value;
  const isReady = toAsk.value.length > 0 && canDriveBoth();
  if (share !== null) {
    return (
      <div class="row">
        <progress max={1} value={share} aria-label="Computing both futures" />
        <button type="button" onClick={forgetAnswer}>
          Cancel
        </button>
      </div>
    );
  }
  return (
    <button
      type="button"
      class="go primary"
      disabled={!isReady}
      title={isReady ? 'The run as it is, and with the changes, from the same moment' : 'Change a setting first'}
      onClick={driveBoth}
    >
      Drive both
    </button>
  );
}

function keep(): void {
  for (const { key, value } of asked.value) if (canSet(key)) set(key, value);
  kept.value = asked.value;
}

const changesInWords = (all: readonly Wish[]): string =>
  all.map(({ key, value }) => `${labelOf({ key, unit: entryOf(key)?.unit ?? '' })} ${value}`).join(', ');

/** The answer as a sentence, and what can be done with it. */
export function AnswerView() {
  const found = answer.value;
  if (problem.value !== '') {
    return (
      <p class="refusal" role="alert">
        {problem.value}
      </p>
    );
  }
  if (!found) return null;
  const both = futures.value;
  const isKept = kept.value === asked.value;
  const fixed = asked.value.map(({ key }) => key).filter((key) => entryOf(key)?.is_fixed === true);
  return (
    <div class="answer stack">
      <p role="status" data-testid="what-if-verdict">
        <span class="other">{changesInWords(asked.value)}</span>: {verdictOf(found, both ? -both.total : NaN)}
      </p>
      <div class="row">
        {replayLeft.value === null ? (
          <button
            type="button"
            title="Both drives on the picture, from the same moment: the car as it is, the ghost as it would be"
            onClick={() => watchBoth(found)}
          >
            Watch both
          </button>
        ) : (
          <button type="button" onClick={endReplay}>
            End watching
          </button>
        )}
        {both && (
          <button
            type="button"
            title="Both futures along the road"
            onClick={() => {
              chosen.value = [both.a.id, both.b.id];
              mode.value = 'understand';
            }}
          >
            Compare
          </button>
        )}
        {!askedLog.value && (
          <button
            type="button"
            disabled={isKept || fixed.length === asked.value.length}
            onClick={keep}
            title="The run goes on with these settings"
          >
            {isKept ? 'Kept' : 'Keep the change'}
          </button>
        )}
        <button type="button" onClick={forgetAnswer}>
          Forget it
        </button>
      </div>
      {found.endReason !== '' && <p class="soft">The changed run ended: {found.endReason}.</p>}
      {found.standIn && <p class="soft">{trustOf(found.standIn)}</p>}
      {!found.isExact && (
        <p class="soft">
          The run did not come out the same when it was computed again: the first one is what this program computes.
        </p>
      )}
      {!askedLog.value && fixed.length > 0 && (
        <p class="soft">Fixed when a run starts, and not kept: {fixed.join(', ')}.</p>
      )}
    </div>
  );
}

/** Why there is no other future here. */
export function WhyNotBoth() {
  if (run.value?.mode === 'serve' && !askedLog.value) {
    return (
      <p class="soft">
        The car is simulated by another program, which cannot be driven twice. Our own car can stand in for it where the
        road is known: start <code>chicane serve --track FILE</code>.
      </p>
    );
  }
  return (
    <p class="soft">
      Another future is driven by the program that has our simulator: <code>chicane drive</code>, or{' '}
      <code>chicane replay LOG</code> for its recordings.
    </p>
  );
}
