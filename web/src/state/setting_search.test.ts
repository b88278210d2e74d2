import { describe, expect, it } from 'vitest';
import { settingMeant, settingsFound } from './setting_search';

const entry = (key: string, meaning = '', unit = '') => ({ key, meaning, unit, group: '' });
const ALL = [
  entry('delay.expected_ms', 'compensates the latency', 'ms'),
  entry('tracking_mpc.weight_lateral', 'weight of lateral error'),
  entry('latency_ms', 'from command to actuation', 'ms'),
  entry('tracking_mpc.weight_heading', 'weight of heading error'),
];
const keys = (words: string) => settingsFound(ALL, words).map(({ key }) => key);
const meant = (words: string) => settingMeant(settingsFound(ALL, words), words)?.key ?? null;

describe('a search for settings', () => {
  it('has the one that is called so first', () => {
    expect(keys('latency')).toEqual(['latency_ms', 'delay.expected_ms']);
    expect(keys('')).toHaveLength(4);
  });

  it('means one where it is named or the only one, and none of several', () => {
    expect(meant('latency')).toBe('latency_ms');
    expect(meant('LATENCY ')).toBe('latency_ms');
    expect(meant('weight of heading')).toBe('tracking_mpc.weight_heading');
    expect(meant('weight')).toBeNull();
    expect(meant('no such thing')).toBeNull();
  });
});
