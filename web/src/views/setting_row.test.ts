import { describe, expect, it } from 'vitest';
import { readSchema, type SchemaEntry } from '../protocol/schema';
import { labelOf } from '../state/setting_search';
import { rangeOf } from './setting_row';

const entry = (change: object): SchemaEntry =>
  readSchema([{ key: 'a.b', kind: 'number', minimum: 0, maximum: 1, ...change }])[0] as SchemaEntry;

describe('the row of a setting', () => {
  it('is called by the words of its key, without the unit that stands beside it', () => {
    expect(labelOf({ key: 'tracking_mpc.speed_limit_mps', unit: 'm/s' })).toBe('speed limit');
    expect(labelOf({ key: 'latency_ms', unit: 'ms' })).toBe('latency');
    expect(labelOf({ key: 'vehicle.load_per_speed', unit: '1/s' })).toBe('load per speed');
    expect(labelOf({ key: 'tracking_mpc.weight_steer_rate', unit: 's²/rad²' })).toBe('weight steer rate');
  });

  it('has a slider where a range means something', () => {
    const range = { minimum: 0, maximum: 500, scale: 'linear', isInteger: false };
    expect(rangeOf(entry({ maximum: 500 }), 100)).toEqual(range);
    expect(rangeOf(entry({ kind: 'integer', minimum: 5, maximum: 100 }), 40)?.isInteger).toBe(true);
    expect(rangeOf(entry({ maximum: 9007199254740992 }), 1)).toBeNull(); // seed
    expect(rangeOf(entry({ minimum: null }), 1)).toBeNull();
    expect(rangeOf(entry({ maximum: 0 }), 0)).toBeNull();
  });
});
