// Settings in Try: which rows are shown, and whether they change the run or the second car of Drive both.
import { computed } from '@preact/signals';
import { store } from '../lib/store';
import type { SchemaEntry } from '../protocol/schema';
import type { Setting } from '../protocol/source';
import { canSet, set } from './operate';
import { run } from './run';
import { settingsFound } from './setting_search';
import { entryOf, isControl, schema, settingChanges, settings, startSettings } from './settings';
import { askedLog, type ChosenSetting, chosenSettings, loggedSchema, offered, valueInForce } from './what_if';

/** What a slider changes: the car that drives, or the second car of *Drive both*. */
export type Target = 'run' | 'second';
const chosenTarget = store.signal<Target>('page', 'run');

/** A recording cannot be changed: there is only the second car. */
export const target = computed<Target>(() =>
  askedLog.value !== null || run.value?.mode === 'replay' ? 'second' : chosenTarget.value,
);

/** Lets the sliders change the run or the second car. */
export function aimAt(next: Target): void {
  chosenTarget.value = next;
}

/** What is searched for; empty: the ten settings that matter. */
export const settingWords = store.signal('page', '');

/** Value of the second car's setting, if it was changed. */
const chosenOf = (key: string): Setting | undefined => chosenSettings.value.find((each) => each.key === key)?.value;
const offeredOf = (key: string): SchemaEntry | undefined => offered().find((each) => each.key === key);

/** The value that a row shows. */
export function valueShown(key: string): Setting | undefined {
  if (target.value === 'run') return settings.value.get(key);
  const entry = offeredOf(key);
  return chosenOf(key) ?? (entry && valueInForce(entry));
}

/** The value that a row is reset to: of the start of the run; for the second car, of the run itself. */
export function firstValueOf(entry: SchemaEntry): Setting | undefined {
  if (target.value === 'second') return valueInForce(entry);
  return startSettings.value.get(entry.key) ?? (isControl(entry.key) ? (entry.default ?? undefined) : undefined);
}

/** Whether a row can be changed now. */
export const canChange = (key: string): boolean =>
  target.value === 'run' ? canSet(key) : offeredOf(key) !== undefined;

/** Most changes of the second car, so that the answer can be read; chosen. */
const MOST_CHOSEN = 8;
/** Why the last change of the second car was not taken; empty when it was. */
export const choiceRefusal = store.signal('page', '');

/** Changes a setting of the run, or of the second car. */
export function change(key: string, value: Setting): void {
  if (target.value === 'run') {
    set(key, value);
    return;
  }
  const others = chosenSettings.value.filter((each) => each.key !== key);
  const entry = offeredOf(key);
  const isAsNow = entry !== undefined && Object.is(valueInForce(entry), value);
  choiceRefusal.value = !isAsNow && others.length >= MOST_CHOSEN ? 'No more than eight changes at a time.' : '';
  if (choiceRefusal.value === '') chosenSettings.value = isAsNow ? others : [...others, { key, value }];
}

/** What *Drive both* compares the run with: the second car, else the run as it was at its start. */
export const toAsk = computed<readonly ChosenSetting[]>(() => {
  if (chosenSettings.value.length > 0) return chosenSettings.value;
  const changes = settingChanges.value.filter(({ key }) => offeredOf(key) !== undefined);
  return changes.slice(0, MOST_CHOSEN).map(({ key, from: value }) => ({ key, value }));
});

/** The ten that matter: what each is called, and its key by the controller that has it. `*`: of the one that drives. */
const TEN: readonly { readonly name: string; readonly keys: readonly string[] }[] = [
  { name: 'Speed limit', keys: ['*.speed_limit_mps', '*.speed_reference_mps'] },
  { name: 'Grip used', keys: ['*.grip_share', '*.lateral_acceleration_limit_mps2'] },
  { name: 'Brakes used', keys: ['*.brake_share', '*.speed_gain'] },
  { name: 'Looks ahead', keys: ['*.horizon_steps', '*.lookahead_time_s', '*.softening_speed_mps'] },
  { name: 'Keeps to the line', keys: ['*.weight_lateral', '*.proportional_gain', '*.gain'] },
  { name: 'Smooth steering', keys: ['*.weight_steer_rate', '*.weight_steer_change', '*.derivative_gain'] },
  { name: 'Keeps off the edge', keys: ['*.edge_margin_m'] },
  { name: 'Delay', keys: ['latency_ms'] },
  { name: 'Grip of the road', keys: ['plant_options.friction_scale'] },
  { name: 'Mass of the car', keys: ['plant_options.mass_scale'] },
];

/** A setting with the name that it has among the ten. */
export interface NamedSetting {
  readonly entry: SchemaEntry;
  readonly name: string | undefined;
}

/** Schema of the recording that is asked about, else of the run. */
const known = (): readonly SchemaEntry[] => (askedLog.value ? loggedSchema.value : schema.value);

/** Those of the ten settings that the run has. */
export const tenSettings = computed<readonly NamedSetting[]>(() => {
  const prefix = (run.value?.controller ?? '').replaceAll('-', '_');
  return TEN.flatMap(({ name, keys }) => {
    const all = keys.map((key) => key.replace('*', prefix));
    const entry = all.map((key) => known().find((each) => each.key === key)).find((each) => each !== undefined);
    return entry ? [{ entry, name }] : [];
  });
});

/** The name that a setting has among the ten. */
const nameOf = (key: string): string | undefined => tenSettings.value.find(({ entry }) => entry.key === key)?.name;

const MOST_FOUND = 40; // rows; chosen

/** The settings that words find, by name, meaning or group; the pace of the run is one of them. */
export function found(words: string): readonly NamedSetting[] {
  const all = known().filter(({ key }) => key === 'run.pace' || !isControl(key));
  const has = all.filter(({ key }) => askedLog.value !== null || settings.value.has(key));
  return settingsFound(has, words)
    .slice(0, MOST_FOUND)
    .map((entry) => ({ entry, name: nameOf(entry.key) }));
}

/** Number of all settings that can be searched. */
export const countOfSettings = computed(() => known().filter(({ key }) => !isControl(key)).length);

/** A setting of the sentence of Try; undefined where the run does not have it. */
export const choiceOf = (key: string): SchemaEntry | undefined => {
  const entry = entryOf(key);
  return entry && settings.value.has(key) ? entry : undefined;
};
