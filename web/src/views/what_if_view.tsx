import { lapTime } from '../lib/format';
import { tidy } from '../lib/scale';
import { store } from '../lib/store';
import type { SchemaEntry } from '../protocol/schema';
import type { Setting } from '../protocol/source';
import { watchBoth } from '../recording/what_if_ghost';
import { canSet, set } from '../state/operate';
import { cursorTime } from '../state/plot_view';
import { endReplay, replayLeft } from '../state/replay';
import { run } from '../state/run';
import { labelOf } from '../state/setting_search';
import { entryOf, settingChanges } from '../state/settings';
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
  valueInForce,
  type Wish,
  wishes,
} from '../state/what_if';
import { DraftBox } from './draft_box';
import { RaceView } from './race_view';
import { SettingCombo } from './setting_combo';
import { SettingMeaning, typed } from './setting_row';
import { WhatIfResult } from './what_if_result';

const MOST_WISHES = 8;
const kept = store.signal<readonly Wish[] | null>('page', null);

const asText = (value: Setting | undefined): string =>
  typeof value === 'number' ? tidy(value).replace('−', '-') : String(value ?? '');

function wish(key: string, value: Setting): void {
  wishes.value = wishes.value.map((each) => (each.key === key ? { key, value } : each));
}

/** Adds a setting with its value in force; says why it is not taken. */
function addWish(key: string): string {
  const entry = offered().find((each) => each.key === key);
  const value = entry && valueInForce(entry);
  if (value === undefined) return 'This run does not have that setting.';
  if (wishes.value.length >= MOST_WISHES) return 'No more than eight at a time.';
  if (!wishes.value.some((each) => each.key === key)) wishes.value = [...wishes.value, { key, value }];
  return '';
}

function Value({ entry, value }: { entry: SchemaEntry; value: Setting }) {
  const label = `What if: ${labelOf(entry)}`;
  if (entry.kind === 'bool') {
    return (
      <input
        type="checkbox"
        aria-label={label}
        checked={value === true}
        onChange={(event) => wish(entry.key, event.currentTarget.checked)}
      />
    );
  }
  if (entry.choices.length > 0) {
    return (
      <select aria-label={label} value={String(value)} onChange={(event) => wish(entry.key, event.currentTarget.value)}>
        {entry.choices.map((choice) => (
          <option key={choice} value={choice}>
            {choice}
          </option>
        ))}
      </select>
    );
  }
  return (
    <DraftBox
      class="number-box"
      label={label}
      value={asText(value)}
      when="typed"
      onText={(text) => {
        const wanted = typed(text);
        if (wanted !== null) wish(entry.key, wanted);
      }}
    />
  );
}

function WishRow({ entry, value }: { entry: SchemaEntry; value: Setting }) {
  const now = valueInForce(entry);
  return (
    <li class="wish" data-key={entry.key}>
      <span class="setting-name">
        <SettingMeaning entry={entry} label={labelOf(entry)} />
      </span>
      <Value entry={entry} value={value} />
      <span class="unit">
        {entry.unit} {Object.is(now, value) ? 'as now' : `now ${asText(now)}`}
      </span>
      <button
        type="button"
        class="icon small"
        aria-label={`Do not change ${labelOf(entry)}`}
        onClick={() => (wishes.value = wishes.value.filter(({ key }) => key !== entry.key))}
      >
        ×
      </button>
    </li>
  );
}

function Wishes() {
  const all = offered();
  const changes = settingChanges.value.filter(({ key }) => all.some((each) => each.key === key));
  return (
    <section class="block" aria-label="What is changed">
      <h2>Change</h2>
      <ul class="wishes">
        {wishes.value.map(({ key, value }) => {
          const entry = all.find((each) => each.key === key);
          return entry ? <WishRow key={key} entry={entry} value={value} /> : null;
        })}
      </ul>
      <div class="toolbar">
        <SettingCombo
          label="Setting to change"
          placeholder="A setting: speed limit, latency …"
          entries={all}
          onChosen={addWish}
        />
        {changes.length > 0 && (
          <button
            type="button"
            title="What if nothing had been changed since the start of the run?"
            onClick={() =>
              (wishes.value = changes.slice(0, MOST_WISHES).map(({ key, from: value }) => ({ key, value })))
            }
          >
            As at the start
          </button>
        )}
      </div>
    </section>
  );
}

function Segment<T extends string>({
  chosen,
  value,
  label,
  title,
  disabled = false,
}: {
  chosen: { value: T };
  value: T;
  label: string;
  title: string;
  disabled?: boolean;
}) {
  return (
    <button
      type="button"
      aria-pressed={chosen.value === value}
      title={title}
      disabled={disabled}
      onClick={() => (chosen.value = value)}
    >
      {label}
    </button>
  );
}

function Moment() {
  const cursor = cursorTime.value;
  return (
    <div class="toolbar">
      <div class="segments" role="group" aria-label="From when">
        <Segment<From>
          chosen={from}
          value="now"
          label={askedLog.value ? 'From here' : 'From now'}
          title="From the moment that is shown"
        />
        <Segment<From>
          chosen={from}
          value="line"
          label="From the line"
          title="From where this lap began: both cars drive the same lap"
        />
        <Segment<From>
          chosen={from}
          value="cursor"
          label={cursor === null ? 'Cursor' : `Cursor ${lapTime(cursor)}`}
          title="From where the cursor of the plots and the road stands: click on the road, or on a plot"
          disabled={cursor === null && from.value !== 'cursor'}
        />
      </div>
      <div class="segments" role="group" aria-label="For how long">
        <Segment<Span> chosen={span} value="10" label="10 s" title="For ten seconds" />
        <Segment<Span> chosen={span} value="30" label="30 s" title="For thirty seconds" />
        <Segment<Span> chosen={span} value="lap" label="A lap" title="Until a whole lap is driven" />
      </div>
    </div>
  );
}

function Ask() {
  const share = progress.value;
  return (
    <div class="toolbar">
      <button
        type="button"
        class="primary"
        disabled={wishes.value.length === 0 || share !== null || !canAsk()}
        onClick={() => {
          kept.value = null;
          void ask();
        }}
      >
        Drive both
      </button>
      {share !== null && <progress max={1} value={share} aria-label="Computing both futures" />}
      {share !== null && (
        <button type="button" onClick={forgetAnswer}>
          Cancel
        </button>
      )}
      {problem.value !== '' && (
        <p class="refusal" role="alert">
          {problem.value}
        </p>
      )}
    </div>
  );
}

const fixedWishes = (): readonly string[] =>
  asked.value.map(({ key }) => key).filter((key) => entryOf(key)?.is_fixed === true);

function keep(): void {
  for (const { key, value } of asked.value) if (canSet(key)) set(key, value);
  kept.value = asked.value;
}

function Actions() {
  const found = answer.value;
  if (!found) return null;
  const isKept = kept.value === asked.value;
  const fixed = fixedWishes();
  return (
    <div class="toolbar">
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
      {!askedLog.value && fixed.length > 0 && (
        <span class="soft">Fixed when a run starts, and not kept: {fixed.join(', ')}.</span>
      )}
      <button type="button" onClick={forgetAnswer}>
        Forget it
      </button>
    </div>
  );
}

function WhyNot({ isServed }: { isServed: boolean }) {
  if (isServed) {
    return (
      <p class="empty">
        The car is simulated by another program, which cannot be driven twice. Our own car can stand in for it where the
        road is known: start <code>chicane serve --track FILE</code>.
      </p>
    );
  }
  return (
    <p class="empty">
      Another future is driven by the program that has our simulator: <code>chicane drive</code>, or{' '}
      <code>chicane replay LOG</code> for its recordings.
    </p>
  );
}

/** Another future of the run: a question, and its answer beside what was. */
export function WhatIfView() {
  const found = answer.value;
  const isServed = run.value?.mode === 'serve' && !askedLog.value;
  if (offered().length === 0 || !canAsk()) return <WhyNot isServed={isServed} />;
  return (
    <div class="blocks what-if">
      <p class="soft">
        Change a number, and see both futures from the same moment on: the run as it is, and as it would be. The run
        that goes on is not disturbed.
      </p>
      {isServed && (
        <p class="soft">
          Your simulator cannot be driven twice: our own car stands in for it, from where yours was, on the road that
          --track told.
        </p>
      )}
      <Wishes />
      <Moment />
      <Ask />
      {!askedLog.value && !isServed && <RaceView />}
      <Actions />
      {found && <WhatIfResult answer={found} />}
    </div>
  );
}
