import { tidy } from '../lib/scale';
import { lastPart, nameInWords } from '../lib/words';
import type { Setting } from '../protocol/source';
import type { Lap } from '../protocol/topics';

// Conditions of a lap: settings that were changed, who drove, faults. The program sends them with each lap.

/** The conditions of a lap. */
type Setup = Pick<Lap, 'setting_names' | 'setting_values' | 'is_mixed' | 'by_hand_share' | 'faults'>;

/** Whether a text stands for a value. */
const meansSame = (text: string, value: Setting): boolean =>
  typeof value === 'number' ? Number(text) === value : text === String(value);

/** The settings of a lap that are not as the run began, by key; `start`: what it began with, as far as it is known. */
export function changesOf(lap: Setup, start: ReadonlyMap<string, Setting>): ReadonlyMap<string, string> {
  return new Map(
    lap.setting_names.flatMap((key, i) => {
      const text = lap.setting_values[i] ?? '';
      const began = start.get(key);
      return began !== undefined && meansSame(text, began) ? [] : [[key, text]];
    }),
  );
}

/** A value as --set takes it, for display: numbers with six digits at most. */
export const shortly = (text: string): string =>
  text.trim() !== '' && Number.isFinite(Number(text)) ? tidy(Number(text)) : text;

/** Who drove: empty for the controller. */
export function driverOf({ by_hand_share: share }: Setup): string {
  if (!(share > 0)) return '';
  return share > 0.999 ? 'by hand' : `${Math.max(1, Math.round(share * 100))} % by hand`;
}

/** All that is unusual about a lap, in a few words each. */
export function setupInWords(lap: Setup, start: ReadonlyMap<string, Setting>): string[] {
  const settings = [...changesOf(lap, start)].map(([key, text]) => `${nameInWords(lastPart(key))} ${shortly(text)}`);
  return [
    ...[driverOf(lap)].filter((text) => text !== ''),
    ...lap.faults.map((name) => `fault: ${nameInWords(name)}`),
    ...settings,
    ...(lap.is_mixed ? ['changed in the lap'] : []),
  ];
}

/** What a lap had otherwise than another one. */
export interface Difference {
  readonly what: string;
  readonly a: string;
  readonly b: string;
}

/** What differed between two laps; an unknown value is named by the value at the start. */
export function differences(a: Setup, b: Setup, start: ReadonlyMap<string, Setting>): Difference[] {
  const [first, second] = [changesOf(a, start), changesOf(b, start)];
  const began = (key: string): string => {
    const value = start.get(key);
    return value === undefined ? 'as at the start' : shortly(String(value));
  };
  const keys = [...new Set([...first.keys(), ...second.keys()])];
  const settings = keys
    .filter((key) => first.get(key) !== second.get(key))
    .map((key) => {
      const [one, other] = [first.get(key), second.get(key)];
      return {
        what: key,
        a: one === undefined ? began(key) : shortly(one),
        b: other === undefined ? began(key) : shortly(other),
      };
    });
  const faults = (lap: Setup): string => lap.faults.map(nameInWords).join(', ') || 'none';
  const drivers = (lap: Setup): string => driverOf(lap) || 'controller';
  return [
    ...(drivers(a) === drivers(b) ? [] : [{ what: 'driver', a: drivers(a), b: drivers(b) }]),
    ...(faults(a) === faults(b) ? [] : [{ what: 'faults', a: faults(a), b: faults(b) }]),
    ...settings,
  ];
}
