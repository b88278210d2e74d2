import { expect, it } from 'vitest';
import { boundsOf, extent, extrapolate, niceCeil, wrapAngle } from './math';

it('wraps angles into one turn', () => {
  const turns = [0, Math.PI, Math.PI, 7 - 2 * Math.PI, -20 + 6 * Math.PI].map((angle) => expect.closeTo(angle, 12));
  expect([0, Math.PI, -Math.PI, 7, -20].map(wrapAngle)).toEqual(turns);
});

it('bounds points and passes over what is not a number', () => {
  const [a, unknown, b] = [
    { x: 1, y: 2 },
    { x: NaN, y: 9 },
    { x: -3, y: 5 },
  ] as const;
  expect(boundsOf([a, unknown, b])).toEqual({ minX: -3, minY: 2, maxX: 1, maxY: 5 });
  expect(boundsOf([])).toBeNull();
  expect(boundsOf([{ x: Infinity, y: 0 }])).toBeNull();
});

it('finds the next nice number', () => {
  const nice = [0.03, 1, 1.5, 80, 100, 0.2].map((value) => expect.closeTo(value, 12));
  expect([0.028, 1, 1.01, 73, 81, 0.2].map(niceCeil)).toEqual(nice);
});

it('finds the extent of what is finite', () => {
  expect([[NaN, 3, -1, NaN], [NaN], []].map(extent)).toEqual([[-1, 3], null, null]);
});

it('goes on along an arc', () => {
  // A circle of radius 20 m at 10 m/s, 0.1 s: midpoint rule, error below R (ω t)³ / 24 = 1e-4 m.
  const next = extrapolate({ x: 20, y: 0, yaw: Math.PI / 2 }, { vx: 10, vy: 0, yawRate: 0.5 }, 0.1);
  expect(Math.hypot(next.x, next.y)).toBeCloseTo(20, 3);
  expect(Math.atan2(next.y, next.x)).toBeCloseTo(0.05, 4);
  expect(next.yaw).toBeCloseTo(Math.PI / 2 + 0.05, 12);
});

it('goes straight on when yaw rate and side speed are unknown', () => {
  const next = extrapolate({ x: 0, y: 0, yaw: 0 }, { vx: 10, vy: NaN, yawRate: NaN }, 0.1);
  expect(next).toEqual({ x: 1, y: 0, yaw: 0 });
});
