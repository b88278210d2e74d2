import { expect, it } from 'vitest';
import { wordsOf } from './model';

it('words between backticks are code', () => {
  const words = wordsOf('All runs: `laps=1` `a<b>`').map(({ words, isCode }) => (isCode ? `code ${words}` : words));
  expect(words).toEqual(['All runs: ', 'code laps=1', ' ', 'code a<b>']);
  expect(wordsOf('')).toEqual([]);
});
