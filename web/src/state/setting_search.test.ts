import { expect, it } from 'vitest';
import { settingsFound } from './setting_search';

const entry = (key: string, meaning = '', unit = '') => ({ key, meaning, unit, group: '' });
const ALL = [
  entry('delay.expected_ms', 'compensates the latency', 'ms'),
  entry('tracking_mpc.weight_lateral', 'weight of lateral error'),
  entry('latency_ms', 'from command to actuation', 'ms'),
  entry('tracking_mpc.weight_heading', 'weight of heading error'),
];
const keys = (words: string) => settingsFound(ALL, words).map(({ key }) => key);

it('a search for settings has the one that is called so first', () => {
  expect(keys('latency')).toEqual(['latency_ms', 'delay.expected_ms']);
  expect(keys('')).toHaveLength(4);
});
