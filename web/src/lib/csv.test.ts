import { describe, expect, it } from 'vitest';
import { csv } from './csv';

describe('csv', () => {
  it('writes a header and rows', () => {
    expect(
      csv(
        ['lap', 'time_s', 'is_clean'],
        [
          [1, 28.125, true],
          [2, 27.1 + 0.2, false],
        ],
      ),
    ).toBe('lap,time_s,is_clean\n1,28.125,true\n2,27.3,false\n');
  });

  it('leaves unknown numbers out, and quotes what needs it', () => {
    expect(
      csv(
        ['a', 'b'],
        [
          [NaN, 'say "so", twice'],
          [Infinity, 'x'],
        ],
      ),
    ).toBe('a,b\n,"say ""so"", twice"\n,x\n');
  });
});
