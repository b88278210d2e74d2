import type { SchemaEntry } from '../protocol/schema';
import { link } from '../state/link';
import { canSet, set } from '../state/operate';
import { run } from '../state/run';
import { entryOf, schema, settings } from '../state/settings';
import { ControllerView } from './controller_view';
import { ManualView } from './manual_view';
import { OriginView } from './origin_view';
import { ChoiceBox, SettingRow } from './setting_row';
import { openShare } from './share_view';

const PACES = [0.25, 1, 4] as const;

/** Schema of the pace, for servers without a schema: its range is part of the protocol. */
const PACE: SchemaEntry = {
  key: 'run.pace',
  group: 'run',
  kind: 'number',
  unit: '×',
  minimum: 0.05,
  maximum: 20,
  choices: [],
  default: 1,
  start: null,
  meaning: 'Simulated seconds per second of real time, as far as the machine keeps up.',
  is_live: true,
  is_fixed: false,
};

export function changePace(factor: number): void {
  const pace = settings.value.get('run.pace');
  if (typeof pace !== 'number' || !canSet('run.pace')) return;
  set('run.pace', Math.min(20, Math.max(0.05, Number((pace * factor).toPrecision(3)))));
}

function Pace() {
  const pace = settings.value.get('run.pace');
  if (pace === undefined) return null;
  return (
    <section class="block" aria-label="Pace">
      <h2>Pace</h2>
      <div class="pace">
        <SettingRow entry={{ ...PACE, unit: '×' }} name="time factor" />
        <div class="segments" role="group" aria-label="Common values">
          {PACES.map((each) => (
            <button
              key={each}
              type="button"
              aria-pressed={pace === each}
              disabled={!canSet('run.pace')}
              onClick={() => set('run.pace', each)}
            >
              {each}×
            </button>
          ))}
        </div>
      </div>
    </section>
  );
}

const CHOICES = [
  { key: 'track', label: 'Track' },
  { key: 'car', label: 'Car' },
  { key: 'controller', label: 'Controller' },
  { key: 'preset', label: 'Preset' },
] as const;

function Choices() {
  const entries = CHOICES.flatMap(({ key, label }) => {
    const entry = entryOf(key);
    return entry && settings.value.has(key) && entry.choices.length > 0 ? [{ entry, label }] : [];
  });
  if (entries.length === 0) return null;
  return (
    <section class="block" aria-label="Choose">
      <header class="with-button">
        <h2>
          Choose <span class="unit">restarts the run</span>
        </h2>
        <button
          type="button"
          class="small"
          title="A link to this run: track, car, preset, seed and changes"
          onClick={openShare}
        >
          Share
        </button>
      </header>
      <div class="choices">
        {entries.map(({ entry, label }) => (
          <label key={entry.key} data-key={entry.key}>
            <span class="label">{label}</span>
            <ChoiceBox entry={entry} label={label} />
          </label>
        ))}
      </div>
    </section>
  );
}

const WORLD = [
  { key: 'latency_ms', name: 'latency' },
  { key: 'plant_options.friction_scale', name: 'friction' },
  { key: 'plant_options.mass_scale', name: 'mass' },
  { key: 'sensor.position_noise_m', name: 'position noise' },
  { key: 'sensor.heading_noise_deg', name: 'heading noise' },
  { key: 'sensor.speed_noise_mps', name: 'speed noise' },
] as const;

function World() {
  const entries = WORLD.flatMap(({ key, name }) => {
    const entry = entryOf(key);
    return entry && settings.value.has(key) ? [{ entry, name }] : [];
  });
  if (entries.length === 0) return null;
  return (
    <section class="block" aria-label="World">
      <h2>
        World <span class="unit">not known to the controller</span>
      </h2>
      {entries.map(({ entry, name }) => (
        <SettingRow key={entry.key} entry={entry} name={name} />
      ))}
    </section>
  );
}

/** Says why there is nothing to set. */
export function NothingToSet() {
  if (settings.value.size > 0 || schema.value.length > 0) return null;
  if (link.value !== 'live') return <p class="empty">Waiting for the connection.</p>;
  return (
    <p class="empty">
      This run can be viewed but not changed{run.value?.mode === 'replay' ? ': it is a recording' : ''}.
    </p>
  );
}

export function DriveView() {
  return (
    <div class="blocks">
      <NothingToSet />
      <Pace />
      <ManualView />
      <Choices />
      <World />
      <ControllerView />
      <OriginView />
    </div>
  );
}
