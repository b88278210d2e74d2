import { expect, it } from 'vitest';
import { readSchema, type SchemaEntry } from '../protocol/schema';
import { labelOf } from '../state/setting_search';
import { rangeOf } from './setting_row';

const entry = (change: object): SchemaEntry =>
  readSchema([{ key: 'a.b', kind: 'number', minimum: 0, maximum: 1, ...change }])[0] as SchemaEntry;

it('is called by the words of its key, without the unit that stands beside it', () => {
  const units = { 'tracking_mpc.speed_limit_mps': 'm/s', latency_ms: 'ms', 'vehicle.load_per_speed': '1/s' };
  const labels = Object.entries(units).map(([key, unit]) => labelOf({ key, unit }));
  expect(labels).toEqual(['speed limit', 'latency', 'load per speed']);
  expect(labelOf({ key: 'tracking_mpc.weight_steer_rate', unit: 's²/rad²' })).toBe('weight steer rate');
});

it('has a slider where a range means something', () => {
  const range = { minimum: 0, maximum: 500, scale: 'linear', isInteger: false };
  expect(rangeOf(entry({ maximum: 500 }), 100)).toEqual(range);
  expect(rangeOf(entry({ kind: 'integer', minimum: 5, maximum: 100 }), 40)?.isInteger).toBe(true);
  for (const none of [{ maximum: 9007199254740992 }, { minimum: null }, { maximum: 0 }]) // the first: seed
    expect(rangeOf(entry(none), 0)).toBeNull();
});
