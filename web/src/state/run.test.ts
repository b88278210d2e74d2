import { expect, it } from 'vitest';
import { isPaused, receiveRun } from './run';
import { runWith } from './test_messages';

it('says whether the run is paused', () => {
  expect(isPaused.value).toBe(false);
  receiveRun(runWith({ is_paused: true }));
  expect(isPaused.value).toBe(true);
});
