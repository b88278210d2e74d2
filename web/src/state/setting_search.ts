// Names of settings in words, and search by words.
import { lastPart, nameInWords } from '../lib/words';
import type { SchemaEntry } from '../protocol/schema';

/** Texts of a setting that are searched. */
type Described = Pick<SchemaEntry, 'key' | 'meaning' | 'group' | 'unit'>;

/** Suffix of a key for each unit. */
const SUFFIXES: Readonly<Record<string, string>> = {
  'm/s': 'mps',
  'm/s²': 'mps2',
  deg: 'deg',
  'deg/s': 'degps',
  ms: 'ms',
  s: 's',
  m: 'm',
  kg: 'kg',
  'kg m²': 'kgm2',
  'W/kg': 'wpkg',
};

/** The last part of a key in words, without the unit, which is shown beside it. */
export function labelOf({ key, unit }: Pick<SchemaEntry, 'key' | 'unit'>): string {
  const name = lastPart(key);
  const suffix = SUFFIXES[unit];
  const bare = suffix !== undefined && name.endsWith(`_${suffix}`) ? name.slice(0, -suffix.length - 1) : name;
  return nameInWords(bare);
}

const wordsOf = (text: string): string[] => text.toLowerCase().trim().split(/\s+/);

/** Whether every word of the search is in the key, the meaning or the group. */
function isFound(entry: Pick<Described, 'key' | 'meaning' | 'group'>, words: string): boolean {
  const text = `${entry.key} ${nameInWords(entry.key)} ${entry.meaning} ${entry.group}`.toLowerCase();
  return wordsOf(words).every((word) => text.includes(word));
}

/** How well words name a setting: 0 as it is called, 1 and 2 by words of its name, 3 by its meaning. */
function distance(entry: Described, words: string): number {
  const label = labelOf(entry).toLowerCase();
  const text = words.toLowerCase().trim();
  if (label === text || entry.key === text) return 0;
  if (label.startsWith(text)) return 1;
  return wordsOf(words).every((word) => label.includes(word)) ? 2 : 3;
}

/** Settings that contain all words, the best names first. */
export function settingsFound<T extends Described>(all: readonly T[], words: string): readonly T[] {
  if (words.trim() === '') return all;
  return all
    .filter((entry) => isFound(entry, words))
    .map((entry) => ({ entry, far: distance(entry, words) }))
    .sort((a, b) => a.far - b.far)
    .map(({ entry }) => entry);
}
