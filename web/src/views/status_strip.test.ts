import { expect, it } from 'vitest';
import { gravity } from './status_strip';

it('a control step is as grave as the worst of it', () => {
  expect(gravity(0, 0, 0)).toBe(0);
  expect([gravity(1, 0, 0), gravity(0, 1, 0), gravity(0, 0, 1)]).toEqual([1, 1, 1]);
  expect([gravity(-2, 0, 0), gravity(0, 2, 0), gravity(1, 3, 1)]).toEqual([2, 2, 2]);
});
