import { expect, it } from 'vitest';
import { frameOf, MARGIN, type Plot, pathOf, type Series } from './plot';

const WIDTH = 500;
const plot = (part: Plot['part'], draw: Series['draw'], values: (number | null)[]): Plot => ({
  part,
  title: '',
  x: '',
  series: [{ draw, tone: 'ink', name: '', values }],
});
const pathIn = (shown: Plot): string => shown.series.map((each) => pathOf(each, frameOf(shown, WIDTH))).join('');

it('a chart is as wide as asked for, with all values within', () => {
  const frame = frameOf(plot('chart', 'line', [-1, -2, 10, 3]), WIDTH);
  expect(frame.width).toBe(WIDTH);
  const places = [frame.x(-1) - MARGIN.left, WIDTH - MARGIN.right - frame.x(10), frame.y(3) - MARGIN.top];
  for (const room of [...places, frame.height - MARGIN.bottom - frame.y(-2)]) expect(room).toBeGreaterThan(0);
  expect(frame.xTicks).toContain(10);
  expect(frame.yTicks).toContain(0);
});

it('bars stand on the lower edge of a chart', () => {
  const bars = plot('chart', 'cells', [1, 0, 1, 5, 2, 0, 1, 0]);
  const frame = frameOf(bars, WIDTH);
  expect(frame.y(0)).toBeCloseTo(frame.height - MARGIN.bottom);
  expect(frame.x(3)).toBeLessThan(WIDTH - MARGIN.right);
  expect(pathIn(bars).match(/M[^M]*z/g)).toHaveLength(2);
});

it('what is not known is a gap in a line, and no dot', () => {
  expect(pathIn(plot('chart', 'line', [0, 0, 1, 1, 2, null, 3, 3, 4, 4])).replace(/[^ML]/g, '')).toBe('MLML');
  for (const values of [[], [3, 4], [null, 1, 2, null]])
    expect(pathIn(plot('chart', 'dots', values))).not.toMatch(/NaN|Infinity/);
});

it('a map has both axes to one scale, whatever its shape', () => {
  for (const values of [
    [0, 0, 100, 1],
    [0, 0, 1, 100],
    [5, 5, 6, 6],
  ]) {
    const frame = frameOf(plot('map', 'line', values), WIDTH);
    expect(frame.x(1) - frame.x(0)).toBeCloseTo(frame.y(0) - frame.y(1));
    expect([frame.width, frame.height < WIDTH]).toEqual([WIDTH, true]);
  }
});
