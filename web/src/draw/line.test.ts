import { expect, it } from 'vitest';
import { addLine, aheadOf, type Line, lengthsOf, lineOf, longestStep, stretchesInside } from './line';

/** A wave of 400 points, about 1 m apart, that enters and leaves a box often. */
const wave: Line = lineOf(Array.from({ length: 400 }, (_, i) => ({ x: i * 0.8, y: 30 * Math.sin(i / 12) })));
const box = { minX: 100, minY: -10, maxX: 180, maxY: 12 };

/** Whether a piece of a line touches the box, by walking along it in small steps. */
function touches({ x, y }: Line, i: number): boolean {
  for (let share = 0; share <= 1; share += 1 / 256) {
    const px = (x[i] ?? NaN) + ((x[i + 1] ?? NaN) - (x[i] ?? NaN)) * share;
    const py = (y[i] ?? NaN) + ((y[i + 1] ?? NaN) - (y[i] ?? NaN)) * share;
    if (px >= box.minX && px <= box.maxX && py >= box.minY && py <= box.maxY) return true;
  }
  return false;
}

it('leaves a line out where it is out of the picture, and nowhere else', () => {
  const stretches = stretchesInside(wave, box, longestStep(wave));
  expect(stretches.length).toBeGreaterThan(1);
  const isDrawn = (i: number): boolean => stretches.some(([first, end]) => i >= first && i + 1 < end);
  for (let i = 0; i + 1 < wave.x.length; ++i) if (touches(wave, i)) expect(isDrawn(i), `piece ${i}`).toBe(true);
  const drawn = stretches.reduce((sum, [first, end]) => sum + end - first, 0);
  expect(drawn).toBeLessThan(wave.x.length / 3);
});

it('draws a line whole where all of it is in the picture, and not at all where none is', () => {
  expect(stretchesInside(wave, { minX: -1, minY: -99, maxX: 999, maxY: 99 }, 0)).toEqual([[0, 400]]);
  expect(stretchesInside(wave, { minX: 500, minY: 500, maxX: 600, maxY: 600 }, 1)).toEqual([]);
});

it('knows the lengths of a line, and its longest step', () => {
  const line = { x: [0, 3, 3, 100], y: [0, 4, 5, 5] };
  expect([...lengthsOf(line)]).toEqual([0, 5, 6, 103]);
  expect(longestStep(line)).toBe(97);
  expect(longestStep({ x: [], y: [] })).toBe(0);
});

it('breaks a line where it jumps', () => {
  const calls: string[] = [];
  const path = {
    moveTo: (x: number) => calls.push(`move ${x}`),
    lineTo: (x: number) => calls.push(`line ${x}`),
  } as unknown as Path2D;
  addLine(path, { x: [0, 1, 50, 51, 52], y: [0, 0, 0, 0, 0] }, 0, 5, 20);
  expect(calls).toEqual(['move 0', 'line 1', 'move 50', 'line 51', 'line 52']);
});

it('lies ahead of a pose from its first point before it on', () => {
  const line = { x: [0, 10, 20, 10, 0], y: [0, 0, 5, 10, 10] }; // comes back
  expect(aheadOf(line, { x: 5, y: 0, yaw: 0 })).toEqual({ x: [10, 20, 10, 0], y: [0, 5, 10, 10] });
  expect(aheadOf(line, { x: 5, y: 0, yaw: Math.PI })).toEqual(line);
  expect(aheadOf(line, { x: 30, y: 0, yaw: 0 })).toEqual({ x: [], y: [] });
});
