import { expect, it } from 'vitest';
import { History } from './history';

it('keeps the newest rows in order', () => {
  const history = new History(2, 3);
  expect([...history.column(0)]).toEqual([]);
  expect(history.newest(0)).toBeNaN();
  for (let i = 1; i <= 10; ++i) {
    history.push([i, -i]);
    const expected = Array.from({ length: Math.min(i, 3) }, (_, k) => Math.max(1, i - 2) + k);
    expect([...history.column(0)]).toEqual(expected);
    expect([...history.column(1)]).toEqual(expected.map((value) => -value));
    expect(history.newest(1)).toBe(-i);
  }
});

it('forgets on request', () => {
  const history = new History(1, 4);
  history.push([1]);
  history.clear();
  expect(history.length).toBe(0);
  history.push([7]);
  expect([...history.column(0)]).toEqual([7]);
});

it('never grows', () => {
  const history = new History(1, 5);
  const memory = history.column(0).buffer;
  for (let i = 0; i < 1000; ++i) history.push([i]);
  expect(history.column(0).buffer).toBe(memory);
  expect(history.column(0)).toHaveLength(5);
});

it('copies another', () => {
  const [from, to] = [new History(1, 3), new History(1, 3)];
  for (const value of [1, 2, 3, 4]) from.push([value]);
  to.copyFrom(from);
  from.push([5]);
  expect([...to.column(0)]).toEqual([2, 3, 4]);
});

it('marks what a short row leaves out as unknown', () => {
  const history = new History(2, 2);
  history.push([1]);
  expect(history.newest(1)).toBeNaN();
});
