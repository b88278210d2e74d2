import { describe, expect, it } from 'vitest';
import { boundsOf, extent, extrapolate, niceCeil, wrapAngle } from './math';

describe('math', () => {
  it('wraps angles into one turn', () => {
    expect(wrapAngle(0)).toBe(0);
    expect(wrapAngle(Math.PI)).toBeCloseTo(Math.PI, 12);
    expect(wrapAngle(-Math.PI)).toBeCloseTo(Math.PI, 12);
    expect(wrapAngle(7)).toBeCloseTo(7 - 2 * Math.PI, 12);
    expect(wrapAngle(-20)).toBeCloseTo(-20 + 6 * Math.PI, 12);
  });

  it('bounds points and passes over what is not a number', () => {
    expect(
      boundsOf([
        { x: 1, y: 2 },
        { x: NaN, y: 9 },
        { x: -3, y: 5 },
      ]),
    ).toEqual({ minX: -3, minY: 2, maxX: 1, maxY: 5 });
    expect(boundsOf([])).toBeNull();
    expect(boundsOf([{ x: Infinity, y: 0 }])).toBeNull();
  });

  it('finds the next nice number', () => {
    expect(niceCeil(0.028)).toBeCloseTo(0.03, 12);
    expect(niceCeil(1)).toBe(1);
    expect(niceCeil(1.01)).toBe(1.5);
    expect(niceCeil(73)).toBe(80);
    expect(niceCeil(81)).toBe(100);
    expect(niceCeil(0.2)).toBeCloseTo(0.2, 12);
  });

  it('finds the extent of what is finite', () => {
    expect(extent([NaN, 3, -1, NaN])).toEqual([-1, 3]);
    expect(extent([NaN])).toBeNull();
    expect(extent([])).toBeNull();
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
});
