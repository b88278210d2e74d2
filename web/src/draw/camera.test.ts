import { expect, it } from 'vitest';
import type { Point } from '../lib/math';
import { allRound, behind, fitting, groundGrid, project, unproject, worldInView, zoomed } from './camera';

/** A point up to nine digits. */
const near = (x: number, y: number) => ({ x: expect.closeTo(x, 9), y: expect.closeTo(y, 9) });
/** Corners of a box, one after the other. */
const cornersOf = (minX: number, minY: number, maxX: number, maxY: number): Point[] =>
  [minX, maxX, maxX, minX].map((x, i) => ({ x, y: i < 2 ? minY : maxY }));

it('finds the point of the world at a place on the screen', () => {
  const camera = { centre: { x: 12, y: -7 }, at: { x: 300, y: 200 }, scale: 4, rotation: 0.7 };
  expect(unproject(camera, project(camera, { x: 33, y: 5 }))).toEqual(near(33, 5));
});

it('shows north up and east right', () => {
  const camera = { centre: { x: 100, y: 50 }, at: { x: 400, y: 300 }, scale: 10, rotation: 0 };
  expect(project(camera, { x: 100, y: 50 })).toEqual({ x: 400, y: 300 });
  expect(project(camera, { x: 110, y: 50 })).toEqual(near(500, 300));
  expect(project(camera, { x: 100, y: 60 })).toEqual(near(400, 200));
});

it.each([0, 1, -2.5, Math.PI])('looks up the screen behind a car heading %f', (heading) => {
  const camera = behind({ x: 5, y: -7 }, heading, 800, 600, 60);
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  expect(project(camera, { x: 5 + 10 * c, y: -7 + 10 * s }), 'ahead').toEqual(near(400, 432 - 100));
  expect(project(camera, { x: 5 - 10 * s, y: -7 + 10 * c }), 'to the left').toEqual(near(300, 432));
});

it('fits a box with its margin', () => {
  const camera = fitting({ minX: -100, minY: 0, maxX: 300, maxY: 100 }, 1000, 500, allRound(20));
  expect(project(camera, { x: -100, y: 0 }).x).toBeCloseTo(20, 9);
  expect(project(camera, { x: 300, y: 100 }).x).toBeCloseTo(980, 9);
  expect(fitting({ minX: 1, minY: 1, maxX: 1, maxY: 1 }, 100, 100, allRound(60)).scale).toBeGreaterThan(0);
});

it.each([0, 0.7, 2, -3])('knows the box of the world in view, heading %f', (heading) => {
  const camera = behind({ x: 1234, y: -567 }, heading, 800, 600, 100);
  const { minX, minY, maxX, maxY } = worldInView(camera, 800, 600);
  const corners = cornersOf(minX, minY, maxX, maxY).map((corner) => project(camera, corner));
  // The box just holds the picture: turned back, its corners lie on or beyond the edges, and no edge is farther than
  // it has to be.
  const [xs, ys] = [corners.map(({ x }) => x), corners.map(({ y }) => y)];
  expect(Math.min(...xs)).toBeLessThan(1e-9);
  expect(Math.max(...xs)).toBeGreaterThan(800 - 1e-9);
  expect(Math.min(...ys)).toBeLessThan(1e-9);
  expect(Math.max(...ys)).toBeGreaterThan(600 - 1e-9);
  const [c, s] = [Math.abs(Math.cos(camera.rotation)), Math.abs(Math.sin(camera.rotation))];
  expect((maxX - minX) * camera.scale).toBeCloseTo(800 * c + 600 * s, 6);
  expect((maxY - minY) * camera.scale).toBeCloseTo(800 * s + 600 * c, 6);
});

it('covers any view with a grid that is not too dense', () => {
  for (const heading of [0, 0.7, 2, -3]) {
    const camera = behind({ x: 1234, y: -567 }, heading, 800, 600, 100);
    const { spacing, from, to } = groundGrid(camera, 800, 600);
    expect(spacing * camera.scale).toBeGreaterThanOrEqual(40);
    expect(Math.abs(from.x % spacing)).toBe(0);
    const corners = cornersOf(from.x, from.y, to.x, to.y).map((corner) => project(camera, corner));
    // Each corner of the screen lies on the same side of all four edges of the grid.
    for (const { x: px, y: py } of cornersOf(0, 0, 800, 600)) {
      const sides = corners.map((a, i) => {
        const b = corners[(i + 1) % 4] ?? a;
        return Math.sign((b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x));
      });
      expect(new Set(sides).size).toBe(1);
    }
  }
  const far = { centre: { x: 0, y: 0 }, at: { x: 400, y: 300 }, scale: 0.3, rotation: 0 };
  expect(groundGrid(far, 800, 600).spacing).toBe(160);
});

it.each([0, 1, -2.5])('holds a plan that would leave the picture, heading %f', (heading) => {
  const car = { x: 5, y: -7 };
  const at = (ahead: number, left: number) => ({
    x: car.x + ahead * Math.cos(heading) - left * Math.sin(heading),
    y: car.y + ahead * Math.sin(heading) + left * Math.cos(heading),
  });
  const plan = [at(0, 0), at(90, 20), at(120, 95)];
  const camera = behind(car, heading, 390, 600, 60, plan, 64);
  for (const point of plan) {
    const { x, y } = project(camera, point);
    expect(x).toBeGreaterThan(64 - 1e-6);
    expect(x).toBeLessThan(390 - 64 + 1e-6);
    expect(y).toBeGreaterThan(64 - 1e-6);
  }
});

it('keeps the zoom in bounds', () => {
  expect(zoomed(60, 1.25)).toBe(75);
  expect(zoomed(16, 0.5)).toBe(15);
  expect(zoomed(1999, 2)).toBe(2000);
});
