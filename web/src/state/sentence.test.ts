import { describe, expect, it } from 'vitest';
import { RUNG, STATUS } from '../protocol/messages';
import { pedalInWords, solverInWords } from './sentence';
import { frameWith } from './test_messages';

describe('the words beside the numbers', () => {
  it('tells the brake as a share of full braking', () => {
    expect(pedalInWords(-0.02, 0.04)).toBe('brake 50 %');
    expect(pedalInWords(-1, 0.04)).toBe('brake 100 %');
    expect(pedalInWords(-0.3, 1)).toBe('brake 30 %');
    expect(pedalInWords(-0.3, NaN), 'of an older program').toBe('brake 30 %');
    expect(pedalInWords(0.4, 0.04)).toBe('drive 40 %');
    expect(pedalInWords(NaN, 0.04)).toBe('–');
  });

  it('calls being off the road no wrong number', () => {
    const off = frameWith({ is_off_track: true, rung: RUNG.RETURN_TO_ROAD, solve_status: STATUS.NOT_FINITE });
    expect(solverInWords(off).text).toBe('The controller has no plan off the road');
    expect(solverInWords({ ...off, is_off_track: false, rung: RUNG.BRAKE }).severity).toBe('bad');
  });
});
