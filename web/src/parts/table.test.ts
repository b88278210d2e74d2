import { expect, it } from 'vitest';
import { areNumbers } from './table';

it('columns that mostly hold numbers stand to the right', () => {
  const rows = [
    ['pid', '1 of 1', { text: '−0.5', hint: '' }, '–', { text: 'chicane drive', is_code: true }],
    ['1', 'its own', '–', '–', { text: '' }],
    ['race', '12.5', '+3 %', '', ''],
  ];
  const columns = ['a', 'b', 'c', 'd', 'e'];
  expect(areNumbers({ part: 'table', title: '', columns, rows })).toEqual([false, true, true, false, false]);
});
