import { expect, it } from 'vitest';
import { readSchema } from '../protocol/schema';
import { link } from './link';
import { canSet } from './operate';
import { schema, settings } from './settings';

it('what is fixed when a run starts cannot be set by a viewer', () => {
  link.value = 'live';
  schema.value = readSchema([
    { key: 'latency_ms', kind: 'number', is_live: true, is_fixed: false },
    { key: 'guard.mode', kind: 'choice', is_live: false, is_fixed: true },
    { key: 'vehicle.friction', kind: 'number', is_live: true, is_fixed: true },
  ]);
  settings.value = new Map(schema.value.map(({ key }) => [key, 1]));
  expect(schema.value.map(({ key }) => canSet(key))).toEqual([true, false, false]);
});
