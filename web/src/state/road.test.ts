import { expect, it } from 'vitest';
import { receiveReference, receiveRoadLine, road } from './road';
import { pathOf } from './test_messages';

it('has edges and a centre line, and a version that rises with each', () => {
  const { version, lines } = road;
  receiveRoadLine('left', pathOf([0, 1], [5, 1]));
  receiveRoadLine('right', pathOf([0, -1]));
  receiveRoadLine('centre', pathOf([0, 0]));
  const point = (x: number, y: number) => ({ x, y });
  expect(road.lines).toEqual({ left: [point(0, 1), point(5, 1)], right: [point(0, -1)], centre: [point(0, 0)] });
  expect(road.version).toBe(version + 3);
  expect(lines).not.toBe(road.lines); // a drawing may keep the old lines until it draws the new ones
});

it('has a reference, which changes at every step and is no change of the road', () => {
  const { version } = road;
  receiveReference(pathOf([5, 5]));
  expect(road.reference).toEqual([{ x: 5, y: 5 }]);
  expect(road.version).toBe(version);
});
