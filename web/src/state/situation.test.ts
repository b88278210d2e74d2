import { expect, it } from 'vitest';
import { UNKNOWN_SITUATION } from '../protocol/messages';
import { beginSession, receive } from './demultiplexer';
import { refreshText } from './shown';
import { situation, situationInWords } from './situation';
import { frameWith } from './test_messages';

const said = (time: number, sentence: string, more = {}) => ({
  ...UNKNOWN_SITUATION,
  stamp: { sec: Math.floor(time), nsec: 1e9 * (time % 1) },
  severity: 'normal',
  sentence,
  ...more,
});

const shownAt = (time: number, sentence = '', more = {}): string | undefined => {
  receive('/chicane/frame', frameWith({ time_s: time }), 0);
  if (sentence !== '') receive('/chicane/situation', said(time, sentence, more), 0);
  refreshText(0);
  return situation.value?.sentence;
};

it('is the one of the frame that is shown, of a run that begins anew another', () => {
  beginSession();
  expect(shownAt(1), 'a program that says nothing').toBeUndefined();
  receive('/chicane/situation', said(1, 'Rolls'), 0);
  receive('/chicane/situation', said(1.5, 'Brakes'), 0);
  expect(shownAt(1)).toBe('Rolls');
  expect(shownAt(1.5)).toBe('Brakes');
  expect(shownAt(0, 'The car stands')).toBe('The car stands');
});

it('is one alarm as long as the guard stops the car again within a second, or until a person drives', () => {
  beginSession();
  expect(shownAt(2, 'stops', { severity: 'alarm' })).toBe('stops');
  expect([2.9, 3.1].map((time) => shownAt(time, 'rolls'))).toEqual(['stops', 'rolls']);
  expect(shownAt(3.2, 'stops', { severity: 'alarm' })).toBe('stops');
  expect(shownAt(3.3, 'by hand', { driver: 'person' })).toBe('by hand');
});

it('has a reason behind its sentence', () => {
  const stop = said(1, 'The guard stops the car', { severity: 'alarm', reason: 'the controller has no answer' });
  const text = 'The guard stops the car: the controller has no answer';
  expect(situationInWords(stop)).toEqual({ severity: 'bad', text });
  expect(situationInWords(said(1, 'Rolls'))).toEqual({ severity: 'good', text: 'Rolls' });
});
