import { expect, it } from 'vitest';
import { gripRadius, reachOf } from './gg_view';

it('the grip circle and the trail lie within the diagram', () => {
  for (let radius = 0; radius < 6; radius += 0.07)
    for (let most = 0; most < 6; most += 0.07) {
      const reach = reachOf(most, radius);
      expect(reach).toBeGreaterThanOrEqual(radius);
      expect(reach).toBeGreaterThanOrEqual(most);
    }
  expect(reachOf(1, NaN)).toBe(reachOf(1, 0));
});

it('the grip circle is told by the axle that uses more, in bends alone', () => {
  expect(gripRadius(-8, 0.8, 0.5)).toBeCloseTo(10);
  expect(gripRadius(8, 0.5, 1)).toBeCloseTo(8);
  expect(gripRadius(2, 0.9, 0.9)).toBeNaN(); // of a straight
  expect(gripRadius(8, 0.3, 0.4)).toBeNaN();
  expect(gripRadius(8, NaN, NaN)).toBeNaN();
});
