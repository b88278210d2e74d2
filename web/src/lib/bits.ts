/** Whether bit `index` of a 32-bit set is on. */
export const hasBit = (set: number, index: number): boolean => index >= 0 && index < 32 && ((set >>> index) & 1) === 1;

/** The names of the set bits; bits without a name get a number. */
export const namesOf = (set: number, names: readonly string[]): string[] =>
  Array.from({ length: 32 }, (_, i) => i)
    .filter((i) => hasBit(set, i))
    .map((i) => names[i] ?? `#${i + 1}`);
