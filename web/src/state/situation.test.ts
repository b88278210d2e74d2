import { describe, expect, it } from 'vitest';
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

describe('the situation', () => {
  it('is the one of the frame that is shown', () => {
    beginSession();
    receive('/chicane/frame', frameWith({ time_s: 1 }), 0);
    refreshText(0);
    expect(situation.value, 'a program that says nothing').toBeNull();
    receive('/chicane/situation', said(1, 'Rolls'), 0);
    receive('/chicane/situation', said(1.5, 'Brakes'), 0);
    refreshText(0);
    expect(situation.value?.sentence).toBe('Rolls');
    receive('/chicane/frame', frameWith({ time_s: 1.5 }), 0);
    refreshText(0);
    expect(situation.value?.sentence).toBe('Brakes');
  });

  it('of a run that begins anew is another', () => {
    receive('/chicane/frame', frameWith({ time_s: 0 }), 0);
    receive('/chicane/situation', said(0, 'The car stands'), 0);
    refreshText(0);
    expect(situation.value?.sentence).toBe('The car stands');
  });

  it('is one alarm as long as the guard stops the car again within a second, or until a person drives', () => {
    beginSession();
    const shownAt = (time: number, sentence: string, more = {}) => {
      receive('/chicane/frame', frameWith({ time_s: time }), 0);
      receive('/chicane/situation', said(time, sentence, more), 0);
      refreshText(0);
      return situation.value?.sentence;
    };
    const [stops, alarm] = ['The guard stops the car', { severity: 'alarm' }];
    expect(shownAt(2, stops, alarm)).toBe(stops);
    expect(shownAt(2.9, 'Rolls')).toBe(stops);
    expect(shownAt(3.1, 'Rolls')).toBe('Rolls');
    expect(shownAt(3.2, stops, alarm)).toBe(stops);
    expect(shownAt(3.3, 'A person drives', { driver: 'person' })).toBe('A person drives');
  });

  it('has a reason behind its sentence', () => {
    const stop = said(1, 'The guard stops the car', { severity: 'alarm', reason: 'the controller has no answer' });
    expect(situationInWords(stop)).toEqual({
      severity: 'bad',
      text: 'The guard stops the car: the controller has no answer',
    });
    expect(situationInWords(said(1, 'Rolls'))).toEqual({ severity: 'good', text: 'Rolls' });
  });
});
