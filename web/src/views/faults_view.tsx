// Faults of the run: buttons that inject them, their duration and strength, and the answer of the guard.
import { computed } from '@preact/signals';
import { hasBit } from '../lib/bits';
import { fixed } from '../lib/format';
import { clamp } from '../lib/math';
import { tidy } from '../lib/scale';
import { store } from '../lib/store';
import { capital } from '../lib/words';
import { Button } from '../parts/controls';
import type { FaultEntry } from '../protocol/schema';
import { faultInWords } from '../state/event_log';
import { secondsLeft } from '../state/faults';
import { canSet, set } from '../state/operate';
import { run } from '../state/run';
import { schema, settings } from '../state/settings';
import { shown } from '../state/shown';
import { situation, situationInWords } from '../state/situation';
import { DraftBox } from './draft_box';
import { EventsView } from './events_view';
import { typed } from './setting_row';

/** A fault that can be injected. */
export interface Fault {
  readonly key: string; // "fault.link_lost"
  readonly name: string;
  readonly meaning: string;
  readonly isActive: boolean;
  readonly entry: FaultEntry | undefined;
}

/** Groups of faults, in the order of their table. */
const GROUPS: readonly { readonly name: string; readonly title: string }[] = [
  { name: 'sensor', title: 'Sensors' },
  { name: 'link', title: 'Link' },
  { name: 'actuator', title: 'Actuators' },
  { name: 'road', title: 'Road and wind' },
  { name: 'computer', title: 'Computer' },
  { name: '', title: 'Others' },
];

/** Least duration that the page asks for by itself [s]: shorter faults end before anybody sees them; chosen. */
const LEAST_S = 3;
const DURATIONS_S = [0.1, 600] as const; // that can be typed; chosen

/** Duration [s] and strength of faults as chosen here, by key. */
const chosen = store.signal<ReadonlyMap<string, { readonly duration: number; readonly strength: number }>>(
  'page',
  new Map(),
);

/** Duration [s] and strength of a fault as chosen, else as they are by default. */
const choiceOf = (key: string, entry: FaultEntry): { duration: number; strength: number } =>
  chosen.value.get(key) ?? { duration: Math.max(LEAST_S, entry.duration_s), strength: entry.strength };

type Choice = { readonly duration?: number | undefined; readonly strength?: number | undefined };

/** Changes duration or strength. */
function choose(key: string, entry: FaultEntry, { duration, strength }: Choice): void {
  const before = choiceOf(key, entry);
  const now = { duration: duration ?? before.duration, strength: strength ?? before.strength };
  chosen.value = new Map([...chosen.value, [key, now]]);
}

/** Faults of the schema; without a schema, faults of the run, without descriptions. */
export const allFaults = computed<readonly Fault[]>(() => {
  const names = run.value?.fault_names ?? [];
  const active = shown.value?.active_faults ?? 0;
  const isActive = (key: string): boolean =>
    settings.value.get(key) === true || hasBit(active, names.indexOf(key.replace(/^fault\./, '')));
  const described = schema.value.filter(({ key }) => key.startsWith('fault.'));
  const keys =
    described.length > 0
      ? described.map(({ key }) => key)
      : [...settings.value.keys()].filter((key) => key.startsWith('fault.'));
  return keys.map((key) => {
    const entry = described.find((each) => each.key === key);
    return {
      key,
      name: faultInWords(key),
      meaning: entry?.meaning ?? '',
      isActive: isActive(key),
      entry: entry?.fault,
    };
  });
});

/** Begins a fault with the duration and strength chosen, or ends it. */
export function toggleFault({ key, isActive, entry }: Fault): void {
  if (isActive || !entry) {
    set(key, !isActive);
    return;
  }
  const { duration, strength } = choiceOf(key, entry);
  set(key, `+${duration}${entry.strength_meaning === '' ? '' : `*${strength}`}`);
}

/** The number that is typed, within its range; nothing while it is none. */
function numberIn(text: string, least: number, most: number): number | undefined {
  const value = typed(text);
  return typeof value === 'number' ? clamp(value, least, most) : undefined;
}

/** Duration and strength of a fault, to be typed. */
function Parameters({ fault: { key, name }, entry }: { fault: Fault; entry: FaultEntry }) {
  const { duration, strength } = choiceOf(key, entry);
  const box = (label: string, value: number, choice: (text: string) => Choice) => (
    <DraftBox
      class="number-box"
      label={label}
      value={tidy(value)}
      when="typed"
      onText={(text) => choose(key, entry, choice(text))}
    />
  );
  const { strength_meaning: meaning, weakest, strongest } = entry;
  return (
    <div class="row label">
      <span class="row label">
        <span>for</span>
        {box(`Duration of ${name} [s]`, duration, (text) => ({ duration: numberIn(text, ...DURATIONS_S) }))}
        <span>s</span>
      </span>
      {meaning !== '' && (
        <span class="row label">
          {box(`Strength of ${name}: ${meaning}`, strength, (text) => ({
            strength: numberIn(text, weakest, strongest),
          }))}
          <span>{meaning}</span>
        </span>
      )}
    </div>
  );
}

/** Faults that are shown as buttons at first; all others on request. */
const FIRST = ['half_grip', 'ice_patch', 'side_wind', 'weak_brakes', 'link_lost', 'steering_stuck', 'dead_controller'];
const showsAll = store.signal('page', false);

/** Button that injects a fault, or ends it. */
function FaultButton({ fault }: { fault: Fault }) {
  const { key, name, meaning, isActive } = fault;
  const left = isActive ? secondsLeft(key, shown.value?.time_s ?? NaN) : NaN;
  return (
    <Button
      class="fault"
      data-key={key}
      title={meaning}
      aria-pressed={isActive}
      disabled={!canSet(key)}
      act={() => toggleFault(fault)}
    >
      {capital(name)}
      {isActive && <span class="left">{Number.isFinite(left) ? `${fixed(left, 1)} s left` : 'active'}</span>}
    </Button>
  );
}

/** All faults with what they are, how long and how strong. */
function FaultTable({ all }: { all: readonly Fault[] }) {
  return (
    <div class="stack">
      {GROUPS.map(({ name: group, title }) => {
        const members = all.filter(({ entry }) => (entry?.group ?? '') === group);
        if (members.length === 0) return null;
        return (
          <section key={group} class="fault-group stack" aria-label={title}>
            <h3>{title}</h3>
            <ul class="stack">
              {members.map((fault) => (
                <li key={fault.key} class="stack">
                  <FaultButton fault={fault} />
                  <span class="soft">{fault.meaning}</span>
                  {fault.entry && <Parameters fault={fault} entry={fault.entry} />}
                </li>
              ))}
            </ul>
          </section>
        );
      })}
    </div>
  );
}

/** Faults, what is done about them, and the events of the run. */
export function FaultsView() {
  const all = allFaults.value;
  const active = all.filter(({ isActive }) => isActive);
  const answer = situation.value && situationInWords(situation.value);
  if (all.length === 0) return null;
  const isOfFirst = ({ key }: Fault): boolean => FIRST.includes(key.replace(/^fault\./, ''));
  return (
    <section class="faults stack" aria-label="Faults">
      <h2>Faults</h2>
      {showsAll.value ? (
        <FaultTable all={all} />
      ) : (
        <div class="row">
          {all
            .filter((each) => isOfFirst(each) || each.isActive)
            .map((fault) => (
              <FaultButton key={fault.key} fault={fault} />
            ))}
        </div>
      )}
      <div class="row">
        <Button class="plain" act={() => (showsAll.value = !showsAll.value)}>
          {showsAll.value ? 'Fewer' : `All ${all.length}, how long and how strong`}
        </Button>
        {active.length > 0 && (
          <Button class="plain" act={() => active.forEach(({ key }) => set(key, false))}>
            Clear all
          </Button>
        )}
      </div>
      {active.length > 0 && answer && (
        <p role="status" data-testid="fault-answer">
          What is done about it: <b>{answer.text}</b>
        </p>
      )}
      <EventsView />
    </section>
  );
}
