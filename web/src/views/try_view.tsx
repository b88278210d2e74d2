// Mode Try: the run as a sentence of choices, settings, faults and both futures.
import type { ComponentChildren } from 'preact';
import { plural } from '../lib/format';
import { tidy } from '../lib/scale';
import { store } from '../lib/store';
import { Button, Refusal, Select } from '../parts/controls';
import {
  aimAt,
  canChange,
  choiceOf,
  choiceRefusal,
  countOfSettings,
  found,
  settingWords,
  target,
  tenSettings,
} from '../state/chosen_settings';
import { link } from '../state/link';
import { canSet, set } from '../state/operate';
import { run } from '../state/run';
import { schema, settingChanges, settings } from '../state/settings';
import { askedLog } from '../state/what_if';
import { AnswerView, canDriveBoth, DriveBothButton, WhenView, WhyNotBoth } from './both_view';
import { ControllerView } from './controller_view';
import { allFaults, FaultsView, toggleFault } from './faults_view';
import { OriginView } from './origin_view';
import { RaceView } from './race_view';
import { ChangeOf, ChoiceBox, SettingRow } from './setting_row';

/** Whether the search takes the focus as soon as it is there. */
const wants = store.data('page', () => ({ search: false }));

/** Focuses the search, at once or as soon as it is there, which is before another key can be pressed. */
export function focusSearch(): void {
  const box = document.getElementById('search');
  wants.search = box === null;
  box?.focus();
}

/** Focuses the search if it was asked for before. */
function takeFocus(box: HTMLInputElement | null): void {
  if (!box || !wants.search) return;
  wants.search = false;
  box.focus();
}

const LATENCIES_MS = [0, 50, 100, 150, 200, 300]; // offered; chosen

/** A word of the sentence with what follows it, which stays on its line. */
function Word({ name, children, end = '' }: { name: string; children: ComponentChildren; end?: string }) {
  return (
    <span class="keep" data-key={name}>
      {children}
      {end}
    </span>
  );
}

/** A choice of the sentence; a text where there is nothing to choose. */
function Choice({ name, label, end = '' }: { name: string; label: string; end?: string }) {
  const entry = choiceOf(name);
  if (!entry || entry.choices.length === 0) return <b>{String(settings.value.get(name) ?? '')}</b>;
  return (
    <Word name={name} end={end}>
      <ChoiceBox entry={entry} label={label} />
    </Word>
  );
}

/** Choice of the latency. */
function Latency() {
  const now = Number(settings.value.get('latency_ms'));
  const all = [...new Set([...LATENCIES_MS, now])].filter(Number.isFinite).sort((a, b) => a - b);
  return (
    <Select
      label="Latency"
      value={now}
      disabled={!canSet('latency_ms')}
      choices={all.map((ms) => ({ value: ms, label: `${tidy(ms)} ms` }))}
      choose={(ms) => set('latency_ms', ms)}
    />
  );
}

/** Choice of the one fault that is active. */
function FaultWord() {
  const all = allFaults.value;
  const now = all.find(({ isActive }) => isActive);
  const choose = (key: string): void => {
    for (const each of all) if (each.isActive !== (each.key === key)) toggleFault(each);
  };
  return (
    <Select
      class="b"
      label="Fault"
      value={now?.key ?? ''}
      choices={[{ value: '', label: 'no fault' }, ...all.map(({ key, name }) => ({ value: key, label: name }))]}
      choose={choose}
    />
  );
}

/** The run as a sentence whose words can be changed. */
function RunSentence() {
  if (!canSet('track')) {
    const now = run.value;
    return <h1>{now ? `The ${now.car} on ${now.track} by ${now.preset || now.controller}.` : 'Waiting for a run.'}</h1>;
  }
  return (
    <h1 class="choices">
      On <Choice name="track" label="Track" /> the <Choice name="car" label="Car" /> by{' '}
      <Choice name="preset" label="Preset" end="," />{' '}
      <Word name="latency">
        <Latency />
      </Word>{' '}
      late, with{' '}
      <Word name="fault" end=".">
        <FaultWord />
      </Word>
    </h1>
  );
}

/** Changed settings, each with a button that resets it. */
function Changes() {
  const changes = settingChanges.value;
  return (
    <section class="changes stack" aria-label="Changes" data-testid="changes">
      <header class="row apart">
        {changes.length === 0 ? <p class="soft">No changes</p> : <h2>{plural(changes.length, 'change')}</h2>}
        {changes.length > 0 && (
          <Button act={() => changes.forEach(({ key, from }) => set(key, from))}>Reset all</Button>
        )}
      </header>
      {changes.length > 0 && (
        <ul>
          {changes.map((each) => (
            <li key={each.key} class="row">
              <ChangeOf of={each} />
              <Button class="icon small" aria-label={`Reset ${each.key}`} act={() => set(each.key, each.from)}>
                ↺
              </Button>
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}

/** Choice of the car that the sliders change. */
function Target() {
  if (!canDriveBoth() || askedLog.value) return null;
  return (
    <div class="row line" role="group" aria-label="The sliders change">
      {(['run', 'second'] as const).map((each) => (
        <Button key={each} aria-pressed={target.value === each} act={() => aimAt(each)}>
          {each === 'run' ? 'This run' : 'A second car'}
        </Button>
      ))}
    </div>
  );
}

/** Search and rows of settings. */
function Settings() {
  const words = settingWords.value;
  const shown = words === '' ? tenSettings.value : found(words);
  return (
    <>
      <div class="find row">
        <input
          id="search"
          class="grow"
          ref={takeFocus}
          type="search"
          placeholder={`Search all ${countOfSettings.value} settings`}
          aria-label="Search settings"
          aria-keyshortcuts="/"
          value={words}
          onInput={(event) => (settingWords.value = event.currentTarget.value)}
        />
        <kbd>/</kbd>
        <Target />
      </div>
      <div class="sliders">
        {shown.map(({ entry, name }) => (
          <SettingRow key={entry.key} entry={entry} name={name} />
        ))}
        {shown.length === 0 && words !== '' && <p class="soft">Nothing matches.</p>}
        <Refusal text={choiceRefusal.value} />
      </div>
      {target.value === 'run' && <Changes />}
      {shown.some(({ entry }) => !canChange(entry.key)) && target.value === 'second' && (
        <p class="soft">A second car begins where this one is: what restarts a run stays as it is.</p>
      )}
    </>
  );
}

/** Reason why there is nothing to set. */
function NothingToSet() {
  if (link.value !== 'live') return <p class="soft">Waiting for the connection.</p>;
  return (
    <p class="soft">
      This run can be viewed but not changed{run.value?.mode === 'replay' ? ': it is a recording' : ''}.
    </p>
  );
}

/** The mode Try. */
export function TryView() {
  const isSettable = schema.value.length > 0 || askedLog.value !== null;
  return (
    <>
      <div class="say row apart">
        <RunSentence />
        {canDriveBoth() && <DriveBothButton />}
      </div>
      <div class="future stack" tabIndex={0} role="region" aria-label="Both futures">
        {canDriveBoth() ? <WhenView /> : <WhyNotBoth />}
        <AnswerView />
        {!askedLog.value && <RaceView />}
      </div>
      <div class="knobs stack" tabIndex={0} role="region" aria-label="Settings and faults">
        {isSettable ? <Settings /> : <NothingToSet />}
        {!askedLog.value && <FaultsView />}
        <details>
          <summary>Controller, car and road</summary>
          <ControllerView />
          <OriginView />
        </details>
      </div>
    </>
  );
}
