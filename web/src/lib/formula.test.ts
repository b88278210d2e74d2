import { describe, expect, it } from 'vitest';
import { understand } from './formula';

const KNOWN = ['speed_mps', 'yaw_rate_radps', 'lateral_error_m'];

function resultOf(text: string, numbers: Readonly<Record<string, number>> = {}): number {
  const read = understand(text, KNOWN);
  if (!('formula' in read)) throw new Error(read.problem);
  return read.formula.value(read.formula.names.map((name) => numbers[name] ?? NaN));
}
const problemOf = (text: string): string => {
  const read = understand(text, KNOWN);
  return 'problem' in read ? read.problem : 'none';
};

describe('a formula', () => {
  it('is computed from what it names', () => {
    expect(resultOf('speed_mps * yaw_rate_radps', { speed_mps: 20, yaw_rate_radps: 0.5 })).toBe(10);
    expect(resultOf('(speed_mps + 1)^2 / speed_mps', { speed_mps: 4 })).toBe(6.25);
  });

  it('follows the usual order: signs, powers, products, sums', () => {
    expect(resultOf('2 + 3 * 4 ^ 2 ^ 0.5 - 1')).toBeCloseTo(2 + 3 * 4 ** (2 ** 0.5) - 1, 12);
    expect(resultOf('-2 ^ 2')).toBe(-4);
    expect(resultOf('8 / 4 / 2')).toBe(1);
    expect(resultOf('7 - 3 - 2')).toBe(2);
    expect(resultOf('2 * -3')).toBe(-6);
    expect(resultOf('1e-3 * .5')).toBe(5e-4);
  });

  it('knows some functions', () => {
    expect(resultOf('hypot(3, 4) + max(1, min(5, 2)) + abs(-1)')).toBe(8);
    expect(resultOf('sqrt(2)^2')).toBeCloseTo(2, 12);
  });

  it('says in words where it cannot be understood', () => {
    expect(problemOf('speed_mps *')).toBe('The formula ends where a number, a name or "(" is expected.');
    expect(problemOf('speed_mps 3')).toBe('Character 11: got "3", expected an operator.');
    expect(problemOf('(1 + 2')).toBe('The formula ends where ")" is expected.');
    expect(problemOf('hypot(1)')).toBe('Character 8: got ")", expected "," and another number for hypot.');
    expect(problemOf('1 $ 2')).toBe('Character 3: got "$", expected an operator.');
    expect(problemOf('')).toBe('The formula ends where a number, a name or "(" is expected.');
    expect(problemOf('('.repeat(5000))).toBe('The formula is nested more than 50 deep.');
  });

  it('suggests names that are meant', () => {
    expect(problemOf('sped_mps')).toBe('Nothing is called "sped_mps": did you mean speed_mps?');
    expect(problemOf('yaw_rate')).toBe('Nothing is called "yaw_rate": did you mean yaw_rate_radps?');
    expect(problemOf('constructor')).toBe('Nothing is called "constructor".');
  });
});
