import { expect, it, vi } from 'vitest';
import { addShortcuts, allShortcuts, isTakenBy, shortcutFor, ticks } from './keys';

const press = (key: string, more: object = {}) => ({
  key,
  ctrlKey: false,
  metaKey: false,
  altKey: false,
  repeat: false,
  ...more,
});
const input = (type: string) => ({ tagName: 'INPUT', type });

it('finds what was added last, and forgets it again', () => {
  const [first, second] = [vi.fn(), vi.fn()];
  const rest = { label: 'S', does: 'steps' };
  const end = addShortcuts('Run', { ...rest, keys: ['s'], action: first });
  const endSecond = addShortcuts('Run', { ...rest, keys: ['s'], action: second });
  shortcutFor(press('S'), null)?.action();
  expect(second).toHaveBeenCalledOnce();
  endSecond();
  shortcutFor(press('s'), null)?.action();
  expect(first).toHaveBeenCalledOnce();
  end();
  expect(shortcutFor(press('s'), null)).toBeNull();
  expect(allShortcuts()).toEqual([]);
});

it('leaves the browser its own keys, and does not repeat', () => {
  const end = addShortcuts('Run', { keys: ['s'], label: 'S', does: '', action: () => undefined });
  for (const more of [{ ctrlKey: true }, { metaKey: true }, { altKey: true }, { repeat: true }])
    expect(shortcutFor(press('s', more), null)).toBeNull();
  expect(shortcutFor(press('s'), null)).not.toBeNull();
  end();
});

it('leaves the focused element what it answers to', () => {
  expect(isTakenBy({ tagName: 'BUTTON' }, 'enter')).toBe(true);
  expect(isTakenBy({ tagName: 'BUTTON' }, 's')).toBe(false);
  expect(isTakenBy(input('text'), 's')).toBe(true);
  expect(isTakenBy(input('number'), '1')).toBe(true);
  expect(isTakenBy(input('text'), 'escape')).toBe(false);
  expect(isTakenBy(input('range'), 'arrowleft')).toBe(true);
  expect(isTakenBy(input('range'), ' ')).toBe(false);
  expect(isTakenBy({ tagName: 'SELECT' }, 'arrowdown')).toBe(true);
  expect(isTakenBy({ tagName: 'DIV' }, 'arrowdown')).toBe(false);
  expect(isTakenBy(null, 's')).toBe(false);
});

it('pauses by Space wherever nothing is typed', () => {
  for (const target of [{ tagName: 'BUTTON' }, { tagName: 'SUMMARY' }, { tagName: 'A' }, input('checkbox')])
    expect(isTakenBy(target, ' '), target.tagName).toBe(false);
  for (const target of [input('text'), input('search'), { tagName: 'SELECT' }, { tagName: 'TEXTAREA' }])
    expect(isTakenBy(target, ' '), target.tagName).toBe(true);
  expect(ticks(input('checkbox'), 'Enter')).toBe(true);
  expect(ticks(input('text'), 'Enter')).toBe(false);
});
