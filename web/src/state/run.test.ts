import { expect, it } from 'vitest';
import { isPaused, receiveRun, run } from './run';
import { runWith } from './test_messages';

it('a run of an older program has no names for what it does not send', () => {
  expect(isPaused.value).toBe(false);
  receiveRun(runWith({ is_paused: true }));
  expect(run.value).toMatchObject({ constraint_names: [], fault_names: [], mode: '' });
  expect(isPaused.value).toBe(true);
});
