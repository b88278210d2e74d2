import { expect, it } from 'vitest';
import { UNKNOWN_SITUATION } from '../protocol/messages';
import { situation } from '../state/situation';
import { situationNow } from './sentence_view';

it('names no key twice: the buttons of an alarm have them', () => {
  const alarm = { severity: 'alarm', driver: 'guard', sentence: 'The guard stops the car', reason: 'it has no answer' };
  const why = (ends_it: string) => {
    situation.value = { ...UNKNOWN_SITUATION, ...alarm, ends_it };
    return situationNow()?.why;
  };
  const keys = 'On the dashboard, M takes the wheel and R starts again.';
  expect(why(`It ends when the controller answers. ${keys}`)).toBe(
    'It has no answer. It ends when the controller answers.',
  );
  expect(why(keys)).toBe('It has no answer.');
  const other = 'Reset the simulator, or drive there by hand.';
  expect(why(other)).toBe(`It has no answer. ${other}`);
});
