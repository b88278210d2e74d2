import { describe, expect, it } from 'vitest';
import { UNKNOWN_LIMIT } from '../protocol/messages';
import type { Limit } from '../protocol/topics';
import { gapCauses } from './gap_causes';
import type { CornerTime } from './time_won';

const limit: Limit = {
  ...UNKNOWN_LIMIT,
  is_known: true,
  lap_time_s: 20,
  corner_times_s: Float64Array.of(8, 12),
  without: ['latency', 'grip reserve'],
  without_lap_times_s: Float64Array.of(21.4, 20.8),
  without_corner_times_s: Float64Array.of(8.5, 12.9, 8.2, NaN),
};

const corner = (number: number, lost: number): CornerTime => ({
  number,
  lost,
  from: 0,
  to: 0,
  apex: 0,
  main: { cause: { kind: 'in' }, lost: 0 },
});

describe('the gap by cause', () => {
  it('is what the lap lost less what it would have lost without each', () => {
    const rows = gapCauses(limit, [corner(1, 0.6), corner(2, 0.9)], 1.5);
    expect(rows.map(({ name }) => name)).toEqual(['T1', 'T2', 'Lap']);
    expect(rows[0]?.gap).toBeCloseTo(0.6);
    expect(rows[0]?.taken[0]).toBeCloseTo(0.1);
    expect(rows[0]?.taken[1]).toBeCloseTo(0.4);
    expect(rows[0]?.rest).toBeCloseTo(0.1);
    expect(rows[2]?.taken[1]).toBeCloseTo(0.7);
    expect(rows[2]?.rest).toBeCloseTo(0.7);
  });

  it('leaves out of the rest what is not known', () => {
    const row = gapCauses(limit, [corner(1, 0.6), corner(2, 0.9)], 1.5)[1];
    expect(row?.taken[1]).toBeNaN();
    expect(row?.rest).toBeCloseTo(0.9);
  });

  it('is empty for a run that was not driven again, and for another number of corners', () => {
    expect(gapCauses({ ...limit, without: [] }, [corner(1, 0.6), corner(2, 0.9)], 1.5)).toEqual([]);
    expect(gapCauses(limit, [corner(1, 0.6)], 1.5)).toEqual([]);
  });
});
