import { describe, expect, it } from 'vitest';
import { allRound, behind, fitting, groundGrid, project, unproject, worldInView, zoomed } from './camera';

describe('a place on the screen', () => {
  it('is the point of the world that appears there', () => {
    const camera = { centre: { x: 12, y: -7 }, at: { x: 300, y: 200 }, scale: 4, rotation: 0.7 };
    const back = unproject(camera, project(camera, { x: 33, y: 5 }));
    expect(back.x).toBeCloseTo(33, 9);
    expect(back.y).toBeCloseTo(5, 9);
  });
});

describe('camera', () => {
  it('shows north up and east right', () => {
    const camera = { centre: { x: 100, y: 50 }, at: { x: 400, y: 300 }, scale: 10, rotation: 0 };
    expect(project(camera, { x: 100, y: 50 })).toEqual({ x: 400, y: 300 });
    const east = project(camera, { x: 110, y: 50 });
    expect(east.x).toBeCloseTo(500, 9);
    expect(east.y).toBeCloseTo(300, 9);
    expect(project(camera, { x: 100, y: 60 }).y).toBeCloseTo(200, 9);
  });

  it.each([0, 1, -2.5, Math.PI])('looks up the screen behind a car heading %f', (heading) => {
    const camera = behind({ x: 5, y: -7 }, heading, 800, 600, 60);
    const ahead = project(camera, { x: 5 + 10 * Math.cos(heading), y: -7 + 10 * Math.sin(heading) });
    expect(ahead.x).toBeCloseTo(400, 6);
    expect(ahead.y).toBeCloseTo(432 - 100, 6);
    const left = project(camera, { x: 5 - 10 * Math.sin(heading), y: -7 + 10 * Math.cos(heading) });
    expect(left.x).toBeCloseTo(300, 6);
    expect(left.y).toBeCloseTo(432, 6);
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
    const corners = [
      [minX, minY],
      [maxX, minY],
      [maxX, maxY],
      [minX, maxY],
    ].map(([x = 0, y = 0]) => project(camera, { x, y }));
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
      const corners = [
        [from.x, from.y],
        [to.x, from.y],
        [to.x, to.y],
        [from.x, to.y],
      ].map(([x = 0, y = 0]) => project(camera, { x, y }));
      // Each corner of the screen lies on the same side of all four edges of the grid.
      for (const [px, py] of [
        [0, 0],
        [800, 0],
        [800, 600],
        [0, 600],
      ] as const) {
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
});
