import { computed } from '@preact/signals';
import { hasBit } from '../lib/bits';
import { fixed } from '../lib/format';
import { clamp } from '../lib/math';
import { tidy } from '../lib/scale';
import { store } from '../lib/store';
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

interface Fault {
  readonly key: string; // "fault.link_lost"
  readonly name: string;
  readonly meaning: string;
  readonly isActive: boolean;
  readonly entry: FaultEntry | undefined;
}

const GROUPS: readonly { readonly name: string; readonly title: string }[] = [
  { name: 'sensor', title: 'Sensors' },
  { name: 'link', title: 'Link' },
  { name: 'actuator', title: 'Actuators' },
  { name: 'road', title: 'Road and wind' },
  { name: 'computer', title: 'Computer' },
  { name: '', title: 'Others' },
];

/** Shorter faults are over before anybody has seen them: the page asks for this, unless told otherwise [s]. */
const LEAST_S = 3;
const DURATIONS_S = [0.1, 600] as const;

/** Duration and strength chosen here, by key. */
const chosen = store.signal<ReadonlyMap<string, { readonly duration: number; readonly strength: number }>>(
  'page',
  new Map(),
);

const choiceOf = (key: string, entry: FaultEntry): { duration: number; strength: number } =>
  chosen.value.get(key) ?? { duration: Math.max(LEAST_S, entry.duration_s), strength: entry.strength };

function choose(
  key: string,
  entry: FaultEntry,
  { duration, strength }: { duration?: number | undefined; strength?: number | undefined },
): void {
  const before = choiceOf(key, entry);
  const now = { duration: duration ?? before.duration, strength: strength ?? before.strength };
  chosen.value = new Map([...chosen.value, [key, now]]);
}

/** The faults of the schema; without a schema those of the run, without descriptions. */
const faults = computed<readonly Fault[]>(() => {
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

function toggle({ key, isActive, entry }: Fault): void {
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

function Parameters({ fault, entry }: { fault: Fault; entry: FaultEntry }) {
  const { key, name } = fault;
  const { duration, strength } = choiceOf(key, entry);
  return (
    <div class="fault-parameters">
      <span class="parameter">
        <span>for</span>
        <DraftBox
          class="number-box"
          label={`Duration of ${name} [s]`}
          value={tidy(duration)}
          when="typed"
          onText={(text) => choose(key, entry, { duration: numberIn(text, ...DURATIONS_S) })}
        />
        <span>s</span>
      </span>
      {entry.strength_meaning !== '' && (
        <span class="parameter">
          <DraftBox
            class="number-box"
            label={`Strength of ${name}: ${entry.strength_meaning}`}
            value={tidy(strength)}
            when="typed"
            onText={(text) => choose(key, entry, { strength: numberIn(text, entry.weakest, entry.strongest) })}
          />
          <span>{entry.strength_meaning}</span>
        </span>
      )}
    </div>
  );
}

function FaultCard({ fault }: { fault: Fault }) {
  const { key, name, meaning, isActive, entry } = fault;
  const left = isActive ? secondsLeft(key, shown.value?.time_s ?? NaN) : NaN;
  return (
    <li class={isActive ? 'fault-card active' : 'fault-card'}>
      <button
        type="button"
        class="fault"
        data-key={key}
        aria-pressed={isActive}
        disabled={!canSet(key)}
        onClick={() => toggle(fault)}
      >
        <span class="fault-name">
          {name}
          {isActive && <span class="badge bad">{Number.isFinite(left) ? `${fixed(left, 1)} s left` : 'active'}</span>}
        </span>
        <span class="fault-meaning">{meaning}</span>
      </button>
      {entry && <Parameters fault={fault} entry={entry} />}
    </li>
  );
}

export function FaultsView() {
  const all = faults.value;
  const active = all.filter(({ isActive }) => isActive);
  const answer = situation.value && situationInWords(situation.value);
  if (all.length === 0) return <p class="empty">This run has no faults to inject.</p>;
  return (
    <div class="blocks">
      <div class="toolbar">
        {/* In one place, so that no card moves when a fault begins. */}
        {active.length > 0 && answer ? (
          <p class={`fault-answer ${answer.severity}`} role="status" data-testid="fault-answer">
            <span>
              What is done about it: <b>{answer.text}</b>
            </span>
          </p>
        ) : (
          <p class="fault-answer none soft">Click to inject a fault into the running car, click again to clear it.</p>
        )}
        <button
          type="button"
          disabled={active.length === 0}
          onClick={() => active.forEach(({ key }) => set(key, false))}
        >
          Clear all
        </button>
      </div>
      {GROUPS.map(({ name: group, title }) => {
        const members = all.filter(({ entry }) => (entry?.group ?? '') === group);
        if (members.length === 0) return null;
        return (
          <section key={group} class="fault-group" aria-label={title}>
            <h2>{title}</h2>
            <ul class="faults">
              {members.map((fault) => (
                <FaultCard key={fault.key} fault={fault} />
              ))}
            </ul>
          </section>
        );
      })}
      <EventsView />
    </div>
  );
}
