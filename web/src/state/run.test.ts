import { expect, it } from 'vitest';
import { guardInWords, isPaused, receiveRun } from './run';
import { runWith } from './test_messages';

it('says whether the run is paused', () => {
  expect(isPaused.value).toBe(false);
  receiveRun(runWith({ is_paused: true }));
  expect(isPaused.value).toBe(true);
});

it('names mode, road and version of the guard', () => {
  expect(guardInWords(runWith({ guard_mode: 'observe', guard_road: 'track', guard_version: 2 }))).toBe(
    'guard observe (road from track, version 2)',
  );
  expect(guardInWords(runWith({}))).toBe('');
});
