import { describe, expect, it } from 'vitest';
import { UNKNOWN_LAP } from '../protocol/messages';
import type { Lap } from '../protocol/topics';
import { type Score, whoDrove, withScore } from './leaderboard';

const lap = (more: Partial<Lap>): Lap => ({
  ...UNKNOWN_LAP,
  is_clean: true,
  lap_time_s: 30,
  by_hand_share: 0,
  ...more,
});
const score = (who: string, time: number, track = 'oval'): Score => ({ track, car: 'udacity', who, time });

describe('the leaderboard', () => {
  it('counts clean laps of one driver, without faults', () => {
    expect(whoDrove(lap({}), 'pid', false)).toBe('pid');
    expect(whoDrove(lap({ by_hand_share: 1 }), 'pid', false)).toBe('by hand');
    expect(whoDrove(lap({}), 'pid', true)).toBe('pid, changed');
    expect(whoDrove(lap({ by_hand_share: 0.3 }), 'pid', false)).toBeNull();
    expect(whoDrove(lap({ by_hand_share: NaN }), 'pid', false)).toBeNull();
    expect(whoDrove(lap({ is_clean: false }), 'pid', false)).toBeNull();
    expect(whoDrove(lap({ faults: ['half_grip'] }), 'pid', false)).toBeNull();
    expect(whoDrove(lap({ is_mixed: true }), 'pid', false)).toBeNull();
  });

  it('keeps the best lap of each on each track, and not without end', () => {
    let all: readonly Score[] = [];
    for (const each of [
      score('pid', 40),
      score('pid', 42),
      score('pid', 39),
      score('by hand', 50),
      score('pid', 60, 'lake'),
    ])
      all = withScore(all, each);
    expect(all).toEqual([score('pid', 39), score('by hand', 50), score('pid', 60, 'lake')]);
    for (let i = 0; i < 1000; ++i) all = withScore(all, score(`driver ${i}`, 30));
    expect(all.length).toBeLessThanOrEqual(200);
  });
});
