import { expect, it } from 'vitest';
import { RUNG, STATUS } from '../protocol/messages';
import { pedalInWords, solverInWords } from './sentence';
import { frameWith } from './test_messages';

it('tells the brake as a share of full braking', () => {
  const texts = [-0.02, -1, 0.4, NaN].map((throttle) => pedalInWords(throttle, 0.04));
  expect(texts).toEqual(['brake 50 %', 'brake 100 %', 'drive 40 %', '–']);
  for (const limit of [1, NaN]) expect(pedalInWords(-0.3, limit), 'NaN: of an older program').toBe('brake 30 %');
});

it('calls being off the road no wrong number', () => {
  const off = frameWith({ is_off_track: true, rung: RUNG.RETURN_TO_ROAD, solve_status: STATUS.NOT_FINITE });
  expect(solverInWords(off).text).toBe('The controller has no plan off the road');
  expect(solverInWords({ ...off, is_off_track: false, rung: RUNG.BRAKE }).severity).toBe('bad');
});
