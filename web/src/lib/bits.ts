/** Whether bit `index` of a 32-bit set is on. */
export const hasBit = (set: number, index: number): boolean => index >= 0 && index < 32 && ((set >>> index) & 1) === 1;
