import { expect, it } from 'vitest';
import { guardInWords } from './run';
import { runWith } from './test_messages';

it('names mode, road and version of the guard', () => {
  expect(guardInWords(runWith({ guard_mode: 'observe', guard_road: 'track', guard_version: 2 }))).toBe(
    'guard observe (road from track, version 2)',
  );
  expect(guardInWords(runWith({}))).toBe('');
});
