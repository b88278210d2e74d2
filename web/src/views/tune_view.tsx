import { computed } from '@preact/signals';
import { download } from '../lib/download';
import { tidy } from '../lib/scale';
import { store } from '../lib/store';
import { nameInWords } from '../lib/words';
import type { SchemaEntry } from '../protocol/schema';
import type { Setting } from '../protocol/source';
import { set } from '../state/operate';
import { programPage } from '../state/program_page';
import { run } from '../state/run';
import { isFound } from '../state/setting_search';
import { isControl, schema, settingChanges, settings } from '../state/settings';
import { NothingToSet } from './drive_view';
import { SettingRow } from './setting_row';

const search = store.signal('page', '');
const onlyChanged = store.signal('page', false);
/** Groups that were opened or closed by hand; others follow the active controller. */
const isOpen = store.signal<ReadonlyMap<string, boolean>>('page', new Map());

const wants = store.data('page', () => ({ search: false }));

/** The search takes the next key, also where it is not there yet: it appears before another key can be pressed. */
export function focusSearch(): void {
  const box = document.getElementById('tune-search');
  wants.search = box === null;
  box?.focus();
}

function takeFocus(box: HTMLInputElement | null): void {
  if (!box || !wants.search) return;
  wants.search = false;
  box.focus();
}

const prefixOf = (key: string): string => (key.includes('.') ? (key.split('.')[0] ?? '') : 'run');

const groups = computed(() => {
  const changed = new Set(settingChanges.value.map(({ key }) => key));
  const all = new Map<string, SchemaEntry[]>();
  for (const entry of schema.value) {
    if (isControl(entry.key) || !settings.value.has(entry.key)) continue;
    if (!isFound(entry, search.value) || (onlyChanged.value && !changed.has(entry.key))) continue;
    const name = entry.group || prefixOf(entry.key);
    all.set(name, [...(all.get(name) ?? []), entry]);
  }
  return [...all];
});

/** Groups of the active controller and its environment are open at first. */
function isOpenAtFirst(entries: readonly SchemaEntry[]): boolean {
  const prefix = prefixOf(entries[0]?.key ?? '');
  const controller = entries[0]?.controller ?? '';
  const isOfDriver = controller !== '' && controller === run.value?.controller;
  return isOfDriver || prefix === 'plant_options' || prefix === 'sensor';
}

const asText = (value: Setting): string => (typeof value === 'number' ? tidy(value) : String(value));

/** Where no program answers the link. */
function savePreset(event: Event): void {
  event.preventDefault();
  void programPage('preset.yaml').then((text) => text !== null && download('my-preset.yaml', text));
}

function Changes() {
  const changes = settingChanges.value;
  return (
    <section class={changes.length > 0 ? 'changes some' : 'changes'} aria-label="Changes" data-testid="changes">
      <header>
        <h2>{changes.length === 0 ? 'No changes' : changes.length === 1 ? '1 change' : `${changes.length} changes`}</h2>
        <div class="buttons">
          <button
            type="button"
            disabled={changes.length === 0}
            onClick={() => changes.forEach(({ key, from }) => set(key, from))}
          >
            Reset all
          </button>
          <a
            class="button"
            href="preset.yaml"
            download="my-preset.yaml"
            title="All settings that differ from the defaults, for chicane drive FILE"
            onClick={__PAGE__ ? savePreset : undefined}
          >
            Save as preset
          </a>
        </div>
      </header>
      {changes.length > 0 && (
        <ul>
          {changes.map(({ key, from, to }) => (
            <li key={key}>
              <code>{key}</code> <span class="was">{asText(from)}</span>{' '}
              <span role="img" aria-label="to">
                →
              </span>{' '}
              <b>{asText(to)}</b>
              <button type="button" class="icon small" aria-label={`Reset ${key}`} onClick={() => set(key, from)}>
                ↺
              </button>
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}

function Group({ name, entries }: { name: string; entries: readonly SchemaEntry[] }) {
  const isSearching = search.value !== '' || onlyChanged.value;
  const open = isSearching || (isOpen.value.get(name) ?? isOpenAtFirst(entries));
  const changed = settingChanges.value.filter(({ key }) => entries.some((entry) => entry.key === key)).length;
  return (
    <section class="group" aria-label={nameInWords(name)}>
      <h2>
        <button
          type="button"
          class="disclosure"
          aria-expanded={open}
          onClick={() => (isOpen.value = new Map([...isOpen.value, [name, !open]]))}
        >
          <span aria-hidden="true">{open ? '▾' : '▸'}</span> {nameInWords(name)}{' '}
          <span class="unit">{entries.length}</span>
          {changed > 0 && <span class="badge">{changed} changed</span>}
        </button>
      </h2>
      {open && entries.map((entry) => <SettingRow key={entry.key} entry={entry} />)}
    </section>
  );
}

export function TuneView() {
  if (schema.value.length === 0) return <NothingToSet />;
  if (run.value?.mode === 'replay') {
    return (
      <p class="empty">
        A recording cannot be changed. The tab What if drives on from the moment that is shown with other settings, and
        so does <code>chicane replay LOG --branch-at T --set KEY=VALUE</code>.
      </p>
    );
  }
  return (
    <div class="tune">
      <div class="toolbar">
        <input
          id="tune-search"
          ref={takeFocus}
          type="search"
          placeholder="Search: weight, delay, friction …"
          aria-label="Search settings"
          value={search.value}
          onInput={(event) => (search.value = event.currentTarget.value)}
        />
        <button type="button" aria-pressed={onlyChanged.value} onClick={() => (onlyChanged.value = !onlyChanged.value)}>
          Changed only
        </button>
      </div>
      <Changes />
      {groups.value.map(([name, entries]) => (
        <Group key={name} name={name} entries={entries} />
      ))}
      {groups.value.length === 0 && <p class="empty">Nothing matches.</p>}
    </div>
  );
}
