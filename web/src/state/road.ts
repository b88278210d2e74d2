import type { Point } from '../lib/math';
import type { Path } from '../protocol/topics';

/** Edges and centre line in W. */
export interface RoadLines {
  readonly left: readonly Point[];
  readonly right: readonly Point[];
  readonly centre: readonly Point[];
}

/** The road and the line that the controller follows; plain data, read by the drawing loop. */
export const road = {
  lines: { left: [], right: [], centre: [] } as RoadLines,
  /** Rises with each change of the lines. */
  version: 0,
  reference: [] as readonly Point[],
};

const pointsOf = (path: Path): Point[] => path.poses.map(({ pose }) => pose.position);

/** Stores an edge or the centre line. */
export function receiveRoadLine(name: keyof RoadLines, path: Path): void {
  road.lines = { ...road.lines, [name]: pointsOf(path) };
  ++road.version;
}

/** Stores the reference line. */
export function receiveReference(path: Path): void {
  road.reference = pointsOf(path);
}
