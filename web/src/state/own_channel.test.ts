import { afterEach, expect, it } from 'vitest';
import { COLUMN_COUNT, plotRow } from './columns';
import { History } from './history';
import { formulaText, ownChannel, ownFormula } from './own_channel';
import { frameWith } from './test_messages';

afterEach(() => {
  formulaText.value = '';
});

it('gives the formula of each row', () => {
  const history = new History(COLUMN_COUNT, 10);
  for (const speed of [10, 20, 30]) history.push(plotRow(frameWith({ speed_mps: speed, yaw_rate_radps: 0.1 }), []));
  formulaText.value = 'speed_mps * yaw_rate_radps';
  expect([...ownChannel(history, 0, 3)]).toEqual([1, 2, 3]);
  expect([...ownChannel(history, 1, 2)]).toEqual([2]);
  formulaText.value = '7';
  expect([...ownChannel(history, 0, 3)]).toEqual([7, 7, 7]);
});

it('is nothing without a formula, and where it is not understood', () => {
  expect(ownFormula.value).toBeNull();
  formulaText.value = 'speed *';
  expect(ownFormula.value).toMatchObject({ problem: expect.stringContaining('speed') });
  expect(ownChannel(new History(COLUMN_COUNT, 10), 0, 3)).toHaveLength(0);
});
