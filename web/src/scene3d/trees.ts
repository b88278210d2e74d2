// Places of the trees beside a road.
import type { Point } from '../lib/math';
import type { RoadLines } from '../state/road';
import { randomNumbers } from './noise';

/** A tree in W. */
export interface Tree extends Point {
  readonly height: number; // [m]
  readonly width: number;
  readonly kind: number; // of its leaves: 0, 1, 2
}

/** Size of the cells by which near points are found, and distance of trees from any edge of the road; chosen. */
const CELL_M = 12;
const CLEAR_M = 13;

/** Trees along the road with clearance to its edges; equal for equal roads. */
export function plantTrees(lines: RoadLines, limit = 420): Tree[] {
  const taken = new Map<string, Point[]>();
  const key = (x: number, y: number): string => `${Math.floor(x / CELL_M)},${Math.floor(y / CELL_M)}`;
  const note = (point: Point): void => {
    const cell = key(point.x, point.y);
    taken.set(cell, [...(taken.get(cell) ?? []), point]);
  };
  for (const edge of [lines.left, lines.right, lines.centre]) edge.forEach(note);
  const isFree = ({ x, y }: Point, clear: number): boolean => {
    const reach = Math.ceil(clear / CELL_M);
    for (let i = -reach; i <= reach; ++i) {
      for (let j = -reach; j <= reach; ++j) {
        const near = taken.get(key(x + i * CELL_M, y + j * CELL_M)) ?? [];
        if (near.some((point) => Math.hypot(point.x - x, point.y - y) < clear)) return false;
      }
    }
    return true;
  };
  const random = randomNumbers(7);
  const trees: Tree[] = [];
  const count = lines.centre.length;
  for (let tries = 0; tries < 4 * limit && trees.length < limit; ++tries) {
    const i = Math.floor(random() * count);
    const [edge, other] = random() < 0.5 ? [lines.left[i], lines.right[i]] : [lines.right[i], lines.left[i]];
    if (!edge || !other) continue;
    const width = Math.hypot(edge.x - other.x, edge.y - other.y) || 1;
    const away = (CLEAR_M + 60 * random() ** 1.6) / width;
    const spot = {
      x: edge.x + (edge.x - other.x) * away + 6 * (random() - 0.5),
      y: edge.y + (edge.y - other.y) * away + 6 * (random() - 0.5),
    };
    if (!isFree(spot, CLEAR_M - 3)) continue;
    const height = 4 + 5 * random();
    trees.push({ ...spot, height, width: height * (0.42 + 0.16 * random()), kind: Math.floor(random() * 3) });
  }
  return trees;
}
