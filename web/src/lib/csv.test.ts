import { expect, it } from 'vitest';
import { csv } from './csv';

it('writes a header and rows, leaves unknown numbers out, and quotes what needs it', () => {
  const times = [28.125, 27.1 + 0.2, NaN, Infinity];
  const rows = times.map((time, i) => [time, i === 0, i === 2 ? 'say "so", twice' : 'x']);
  const expected = [
    'time_s,is_clean,note',
    '28.125,true,x',
    '27.3,false,x',
    ',false,"say ""so"", twice"',
    ',false,x',
    '',
  ];
  expect(csv(['time_s', 'is_clean', 'note'], rows)).toBe(expected.join('\n'));
});
