import { expect, it } from 'vitest';
import { UNKNOWN_LAP } from '../protocol/messages';
import type { Setting } from '../protocol/source';
import type { Lap } from '../protocol/topics';
import { changesOf, differences, driverOf, setupInWords } from './lap_setup';

const START = new Map<string, Setting>([
  ['latency_ms', 100],
  ['tracking_mpc.racing_line', false],
]);

const lap = (more: Partial<Lap>): Lap => ({ ...UNKNOWN_LAP, by_hand_share: 0, ...more });
const changed = lap({ setting_names: ['latency_ms', 'tracking_mpc.racing_line'], setting_values: ['60', 'false'] });

it('tells the settings of a lap that are not as the run began', () => {
  expect([...changesOf(changed, START)]).toEqual([['latency_ms', '60']]);
  expect(setupInWords(changed, START)).toEqual(['latency ms 60']);
  expect(setupInWords(lap({}), START)).toEqual([]);
});

it('tells who drove, faults, and changes on the way', () => {
  const words = setupInWords(lap({ by_hand_share: 1, faults: ['half_grip'], is_mixed: true }), START);
  expect(words).toEqual(['by hand', 'fault: half grip', 'changed in the lap']);
  expect(driverOf(lap({ by_hand_share: 0.254 }))).toBe('25 % by hand');
  expect(driverOf(lap({ by_hand_share: NaN }))).toBe('');
});

it('knows no set-up in laps of older programs', () => {
  expect(setupInWords(UNKNOWN_LAP, START)).toEqual([]);
});

it('tells what differed between two laps, from either side', () => {
  expect(differences(lap({}), changed, START)).toEqual([{ what: 'latency_ms', a: '100', b: '60' }]);
  expect(differences(changed, lap({ by_hand_share: 1, faults: ['half_grip'] }), START)).toEqual([
    { what: 'driver', a: 'controller', b: 'by hand' },
    { what: 'faults', a: 'none', b: 'half grip' },
    { what: 'latency_ms', a: '60', b: '100' },
  ]);
  expect(differences(changed, changed, START)).toEqual([]);
});

it('does not guess what a setting was before it was changed', () => {
  const unknown = { what: 'latency_ms', a: 'as at the start', b: '60' };
  expect(differences(lap({}), changed, new Map())).toContainEqual(unknown);
});
