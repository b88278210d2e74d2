// Readers of parsed JSON of older and newer programs: fields that are missing or of another type become unknown.

export type Fields = Readonly<Record<string, unknown>>;

/** The fields of an object; of any other value none. */
export const fields = (value: unknown): Fields =>
  typeof value === 'object' && value !== null ? (value as Fields) : {};

/** The elements of a list; of any other value none. */
export const list = (value: unknown): readonly unknown[] => (Array.isArray(value) ? value : []);

/** A number; any other value is `otherwise`. */
export const number = (value: unknown, otherwise = NaN): number => (typeof value === 'number' ? value : otherwise);

/** A text; any other value is empty. */
export const text = (value: unknown): string => (typeof value === 'string' ? value : '');

/** Lists of numbers by these names, which are fields of `value`. */
export function columns<Name extends string>(value: unknown, names: readonly Name[]): Record<Name, readonly number[]> {
  const all = fields(value);
  const found = names.map((name) => [name, list(all[name]).map((each) => number(each))]);
  return Object.fromEntries(found) as Record<Name, readonly number[]>;
}
