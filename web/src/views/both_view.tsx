// View of Drive both: the question, its progress, and the answer with what can be done with it.
import { lapTime } from '../lib/format';
import { store } from '../lib/store';
import { Button, Refusal, Select } from '../parts/controls';
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
  type ChosenSetting,
  canAsk,
  chosenSettings,
  type From,
  forgetAnswer,
  from,
  offered,
  problem,
  progress,
  type Span,
  span,
} from '../state/what_if';
import { trustOf, verdictOf } from '../state/what_if_answer';

/** The settings of the answer that the run has kept. */
const kept = store.signal<readonly ChosenSetting[] | null>('page', null);

/** Whether both futures can be driven. */
export const canDriveBoth = (): boolean => offered().length > 0 && canAsk();

const SPANS: readonly { value: Span; label: string }[] = [
  { value: '10', label: '10 s' },
  { value: '30', label: '30 s' },
  { value: 'lap', label: 'a lap' },
];

/** From when, and for how long, as words of a sentence. */
export function WhenView() {
  const cursor = cursorTime.value;
  const moments: readonly { value: From; label: string; disabled?: boolean }[] = [
    { value: 'now', label: askedLog.value ? 'here' : 'now' },
    { value: 'line', label: 'the line' },
    {
      value: 'cursor',
      label: `the cursor${cursor === null ? '' : `, ${lapTime(cursor)}`}`,
      disabled: cursor === null && from.value !== 'cursor',
    },
  ];
  return (
    <p class="when">
      Both drive from{' '}
      <Select label="From when" value={from.value} choices={moments} choose={(next) => (from.value = next)} /> for{' '}
      <Select label="For how long" value={span.value} choices={SPANS} choose={(next) => (span.value = next)} />.
    </p>
  );
}

/** Asks for both futures. */
function driveBoth(): void {
  kept.value = null;
  chosenSettings.value = toAsk.value;
  void ask();
}

/** The button that asks, or the progress of the answer. */
export function DriveBothButton() {
  const share = progress.value;
  const isReady = toAsk.value.length > 0 && canDriveBoth();
  if (share !== null) {
    return (
      <div class="row">
        <progress max={1} value={share} aria-label="Computing both futures" />
        <Button act={forgetAnswer}>Cancel</Button>
      </div>
    );
  }
  return (
    <Button
      class="go primary"
      disabled={!isReady}
      title={isReady ? 'The run as it is, and with the changes, from the same moment' : 'Change a setting first'}
      act={driveBoth}
    >
      Drive both
    </Button>
  );
}

/** Lets the run go on with the settings of the answer. */
function keep(): void {
  for (const { key, value } of asked.value) if (canSet(key)) set(key, value);
  kept.value = asked.value;
}

/** Changes in words: "latency 60". */
const changesInWords = (all: readonly ChosenSetting[]): string =>
  all.map(({ key, value }) => `${labelOf({ key, unit: entryOf(key)?.unit ?? '' })} ${value}`).join(', ');

/** The answer as a sentence, and what can be done with it. */
export function AnswerView() {
  const found = answer.value;
  if (problem.value !== '') return <Refusal text={problem.value} />;
  if (!found) return null;
  const both = futures.value;
  const isKept = kept.value === asked.value;
  const fixed = asked.value.map(({ key }) => key).filter((key) => entryOf(key)?.is_fixed === true);
  return (
    <div class="answer stack">
      <p class="value" role="status" data-testid="what-if-verdict">
        <span class="other">{changesInWords(asked.value)}</span>: {verdictOf(found, both ? -both.total : NaN)}
      </p>
      <div class="row">
        {replayLeft.value === null ? (
          <Button
            title="Both drives on the picture, from the same moment: the car as it is, the ghost as it would be"
            act={() => watchBoth(found)}
          >
            Watch both
          </Button>
        ) : (
          <Button act={endReplay}>End watching</Button>
        )}
        {both && (
          <Button
            title="Both futures along the road"
            act={() => {
              chosen.value = [both.a.id, both.b.id];
              mode.value = 'understand';
            }}
          >
            Compare
          </Button>
        )}
        {!askedLog.value && (
          <Button
            disabled={isKept || fixed.length === asked.value.length}
            act={keep}
            title="The run goes on with these settings"
          >
            {isKept ? 'Kept' : 'Keep the change'}
          </Button>
        )}
        <Button act={forgetAnswer}>Forget it</Button>
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
