// Row of a setting: name, control, unit, refusal, and reset.
import { type Range, scaleOf, shareOf, tidy, valueAt, valueInWords } from '../lib/scale';
import { capital } from '../lib/words';
import { Button, Refusal, Select } from '../parts/controls';
import type { SchemaEntry } from '../protocol/schema';
import type { Setting } from '../protocol/source';
import { canChange, change, firstValueOf, type NamedSetting, target, valueShown } from '../state/chosen_settings';
import { canSet, set } from '../state/operate';
import { labelOf } from '../state/setting_search';
import { refusals, type SettingChange, settings } from '../state/settings';
import { DraftBox } from './draft_box';
import { Meaning } from './meaning';

const STEPS = 1000; // of a slider's travel; chosen

/** Range of the slider of a setting; null where it needs none. */
export function rangeOf({ minimum, maximum, kind }: SchemaEntry, usual: Setting | undefined): Range | null {
  if (minimum === null || maximum === null || !(maximum > minimum) || maximum > 1e12) return null;
  const typical = typeof usual === 'number' ? usual : minimum;
  return { minimum, maximum, scale: scaleOf(minimum, maximum, typical), isInteger: kind === 'integer' };
}

/** A number as typed; "inf" means no limit where that is allowed. */
export function typed(text: string): Setting | null {
  const plain = text.trim().replace('−', '-').replace(',', '.');
  if (/^(inf|infinity|∞)$/i.test(plain)) return 'inf';
  const value = Number(plain);
  return plain === '' || Number.isNaN(value) ? null : value;
}

/** A value as it stands in a box. */
const asText = (value: Setting | undefined): string =>
  value === undefined ? '' : valueInWords(value).replace('−', '-');

/** A box for a number or a text, sent once it is complete. */
function ValueBox({ entry, label }: { entry: SchemaEntry; label: string }) {
  const value = valueShown(entry.key);
  const isText = entry.kind === 'text';
  return (
    <DraftBox
      class={isText ? 'text-box' : 'number-box'}
      label={label}
      disabled={!canChange(entry.key)}
      value={asText(value)}
      when="complete"
      onText={(text) => {
        const request = isText ? text : typed(text);
        if (request !== null && request !== value) change(entry.key, request);
      }}
    />
  );
}

/** Slider of a number, with a mark at the value that it is reset to. */
function Slider({ entry, range, label }: { entry: SchemaEntry; range: Range; label: string }) {
  const value = valueShown(entry.key);
  const start = firstValueOf(entry);
  const share = shareOf(typeof value === 'number' ? value : value === 'inf' ? Infinity : NaN, range);
  return (
    <div class="slider">
      {typeof start === 'number' && (
        <span class="start-mark" style={{ left: `calc(8px + (100% - 16px) * ${shareOf(start, range)})` }} />
      )}
      <input
        type="range"
        min={0}
        max={STEPS}
        step={1}
        value={Math.round(share * STEPS)}
        aria-label={label}
        aria-valuetext={`${asText(value)} ${entry.unit}`}
        disabled={!canChange(entry.key)}
        // A setting that restarts the run is sent when the slider is released.
        onInput={(event) =>
          entry.is_live && change(entry.key, valueAt(Number(event.currentTarget.value) / STEPS, range))
        }
        onChange={(event) =>
          !entry.is_live && change(entry.key, valueAt(Number(event.currentTarget.value) / STEPS, range))
        }
      />
    </div>
  );
}

/** A choice among names; without `put` it changes the run. */
export function ChoiceBox({
  entry,
  label,
  value = settings.value.get(entry.key),
  isPossible = canSet(entry.key),
  put = (choice: string) => set(entry.key, choice),
}: {
  entry: SchemaEntry;
  label: string;
  value?: Setting | undefined;
  isPossible?: boolean;
  put?: (choice: string) => void;
}) {
  const now = String(value ?? '');
  const choices = entry.choices.includes(now) || now === '' ? entry.choices : [now, ...entry.choices];
  return (
    <Select
      label={label}
      value={now}
      disabled={!isPossible}
      choices={choices.map((choice) => ({ value: choice, label: choice }))}
      choose={put}
    />
  );
}

/** Whether a setting is chosen among names. */
const isChoice = ({ kind, choices }: SchemaEntry): boolean => kind === 'choice' || choices.length > 0;
/** Whether a setting is a number, which has a slider, a box and a unit. */
const hasUnit = (entry: SchemaEntry): boolean => !isChoice(entry) && entry.kind !== 'bool' && entry.kind !== 'text';

/** Control for the kind of a setting. */
function Control({ entry, label }: { entry: SchemaEntry; label: string }) {
  const value = valueShown(entry.key);
  if (entry.kind === 'bool') {
    return (
      <input
        type="checkbox"
        // biome-ignore lint/a11y/useAriaPropsForRole: the checkbox itself tells whether it is checked
        role="switch"
        aria-label={label}
        checked={value === true}
        disabled={!canChange(entry.key)}
        onChange={(event) => change(entry.key, event.currentTarget.checked)}
      />
    );
  }
  if (isChoice(entry)) {
    const put = (choice: string): void => change(entry.key, choice);
    return <ChoiceBox entry={entry} label={label} value={value} isPossible={canChange(entry.key)} put={put} />;
  }
  if (entry.kind === 'text') return <ValueBox entry={entry} label={label} />;
  const range = rangeOf(entry, firstValueOf(entry) ?? entry.default ?? undefined);
  return (
    <>
      {range ? <Slider entry={entry} range={range} label={label} /> : <span class="slider" />}
      <ValueBox entry={entry} label={`${label}, value`} />
      <span class="unit">{entry.unit}</span>
    </>
  );
}

/** A setting with its value before and after. */
export function ChangeOf({ of: { key, from, to } }: { of: SettingChange }) {
  return (
    <>
      <code>{key}</code> <s class="soft">{valueInWords(from)}</s>{' '}
      <span role="img" aria-label="to">
        →
      </span>{' '}
      <b>{valueInWords(to)}</b>
    </>
  );
}

/** Why a viewer cannot change a setting. */
const whyFixed = (key: string): string => `Fixed when the run starts. On the command line: --set ${key}=VALUE`;

/** The sign beside a setting that a viewer cannot change, or that restarts the run. */
function Mark({ entry }: { entry: SchemaEntry }) {
  if (entry.is_fixed) {
    return (
      <span class="label" role="img" title={whyFixed(entry.key)} aria-label="fixed when the run starts">
        fixed
      </span>
    );
  }
  if (entry.is_live) return null;
  return (
    <span class="label" role="img" title="A change restarts the run" aria-label="restarts the run">
      ↻
    </span>
  );
}

/** The name of a setting; pressed, it says what the setting means. */
function SettingMeaning({ entry, label }: { entry: SchemaEntry; label: string }) {
  const { minimum, maximum, unit, meaning, is_live, is_fixed, key } = entry;
  const hasRange = minimum !== null && maximum !== null && maximum > minimum;
  return (
    <Meaning of={capital(label)}>
      {meaning}
      {hasRange && <span>{`${tidy(minimum)} to ${tidy(maximum)} ${unit}`}</span>}
      {is_fixed ? <span>{whyFixed(key)}</span> : !is_live && <span>A change restarts the run.</span>}
      <code>{key}</code>
    </Meaning>
  );
}

/** A setting: name, control, unit, the reason of a refusal, and a button back to the value at the start. */
export function SettingRow({ entry, name }: NamedSetting) {
  const label = name ?? labelOf(entry);
  const value = valueShown(entry.key);
  const start = firstValueOf(entry);
  const isChanged = start !== undefined && !Object.is(value, start);
  const refusal = target.value === 'run' ? refusals.value.get(entry.key) : undefined;
  return (
    <div
      class={`setting${hasUnit(entry) ? '' : ' is-short'}${isChanged ? ' changed' : ''}`}
      data-key={entry.key}
      title={entry.is_fixed ? whyFixed(entry.key) : undefined}
    >
      <span class="setting-name">
        <SettingMeaning entry={entry} label={label} /> <Mark entry={entry} />
      </span>
      <Control entry={entry} label={label} />
      {isChanged && canChange(entry.key) && (
        <Button
          class="icon small"
          aria-label={`Reset ${label}`}
          title={`Back to ${asText(start)}`}
          act={() => change(entry.key, start)}
        >
          ↺
        </Button>
      )}
      <Refusal text={refusal} />
    </div>
  );
}
