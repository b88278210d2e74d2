// Reading what a program wrote, which may be older or newer than this page: what is missing is unknown.

export type Fields = Readonly<Record<string, unknown>>;

export const fields = (value: unknown): Fields =>
  typeof value === 'object' && value !== null ? (value as Fields) : {};

export const list = (value: unknown): readonly unknown[] => (Array.isArray(value) ? value : []);

export const number = (value: unknown, otherwise = NaN): number => (typeof value === 'number' ? value : otherwise);

export const text = (value: unknown): string => (typeof value === 'string' ? value : '');

/** Columns of numbers by these names. */
export function columns<Name extends string>(value: unknown, names: readonly Name[]): Record<Name, readonly number[]> {
  const all = fields(value);
  const found = names.map((name) => [name, list(all[name]).map((each) => number(each))]);
  return Object.fromEntries(found) as Record<Name, readonly number[]>;
}
