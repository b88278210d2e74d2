import { expect, it } from 'vitest';
import { UNKNOWN_FRAME } from '../protocol/messages';
import { learnedOf } from './learned';

it('says estimates with two standard deviations', () => {
  const delay = { learned_delay_s: 0.058, learned_delay_sd_s: 0.003 };
  const offset = { learned_steer_offset_rad: -0.035, learned_steer_offset_sd_rad: 0.001 };
  const frame = { ...UNKNOWN_FRAME, ...delay, ...offset, learned_grip: 0.85, learned_grip_sd: 0.01 };
  expect(learnedOf(frame).map((each) => each.text)).toEqual(['+58 ± 6 ms', '−2.01 ± 0.11°', '0.85 ± 0.02']);
});
it('is empty where nothing is estimated', () => {
  expect(learnedOf(UNKNOWN_FRAME)).toEqual([]);
});
