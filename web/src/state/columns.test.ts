import { expect, it } from 'vitest';
import { FRAME_NUMBERS, UNKNOWN_FRAME } from '../protocol/messages';
import { COLUMN_COUNT, COST_TERMS, Column, costColumn, plotRow } from './columns';

it('every number of a frame has a column of its own, and each term of the cost another', () => {
  const numbers = Object.entries(UNKNOWN_FRAME).filter(([, value]) => ['number', 'boolean'].includes(typeof value));
  expect(Object.keys(Column)).toEqual(numbers.map(([name]) => name));
  const terms = Array.from({ length: COST_TERMS }, (_, term) => costColumn(term));
  const all = [...Object.values(Column), ...terms];
  expect(new Set(all).size).toBe(COLUMN_COUNT);
  expect(Math.max(...all)).toBe(COLUMN_COUNT - 1);
});

it('a row holds what the frame does, yes as 1', () => {
  const frame = { ...UNKNOWN_FRAME, time_s: 3, steer_sent_rad: -0.5, is_gated: true, lap: 2 };
  const row = plotRow(frame, new Array<number>(COLUMN_COUNT).fill(NaN));
  for (const name of FRAME_NUMBERS) expect(row[Column[name]], name).toBe(Number(frame[name]));
  expect([row[Column.time_s], row[Column.steer_sent_rad], row[Column.is_gated]]).toEqual([3, -0.5, 1]);
});
