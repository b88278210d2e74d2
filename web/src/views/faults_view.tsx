import { computed } from '@preact/signals';
import { hasBit } from '../lib/bits';
import { faultInWords } from '../state/event_log';
import { canSet, set } from '../state/operate';
import { run } from '../state/run';
import { schema, settings } from '../state/settings';
import { shown } from '../state/shown';
import { EventsView } from './events_view';

interface Fault {
  readonly key: string; // "fault.link_lost"
  readonly name: string;
  readonly meaning: string;
  readonly isActive: boolean;
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
  return keys.map((key) => ({
    key,
    name: faultInWords(key),
    meaning: described.find((entry) => entry.key === key)?.meaning ?? '',
    isActive: isActive(key),
  }));
});

export function FaultsView() {
  const all = faults.value;
  const active = all.filter(({ isActive }) => isActive);
  if (all.length === 0) return <p class="empty">This run has no faults to inject.</p>;
  return (
    <div class="blocks">
      <div class="toolbar">
        <p class="soft">
          Click to inject a fault into the running car, click again to clear it. Each ends by itself after its usual
          time.
        </p>
        <button
          type="button"
          disabled={active.length === 0}
          onClick={() => active.forEach(({ key }) => set(key, false))}
        >
          Clear all
        </button>
      </div>
      <ul class="faults">
        {all.map(({ key, name, meaning, isActive }) => (
          <li key={key}>
            <button
              type="button"
              class="fault"
              data-key={key}
              aria-pressed={isActive}
              disabled={!canSet(key)}
              onClick={() => set(key, !isActive)}
            >
              <span class="fault-name">
                {name}
                {isActive && <span class="badge bad">active</span>}
              </span>
              <span class="fault-meaning">{meaning}</span>
            </button>
          </li>
        ))}
      </ul>
      <EventsView />
    </div>
  );
}
