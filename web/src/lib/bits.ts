/** The bits that are on in `set`, and were not in `before`. */
export function begunBits(set: number, before = 0): number[] {
  const begun = set & ~before;
  return begun === 0 ? [] : Array.from({ length: 32 }, (_, bit) => bit).filter((bit) => hasBit(begun, bit));
}

/** Whether bit `index` of a 32-bit set is on. */
export const hasBit = (set: number, index: number): boolean => index >= 0 && index < 32 && ((set >>> index) & 1) === 1;
