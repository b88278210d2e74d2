import { type Box, firstSince, type Point } from '../lib/math';
import type { Losses, MarkedCorner } from '../state/road_marks';
import type { Brush } from './brush';
import { project } from './camera';
import type { Line } from './line';
import type { RoadShape } from './scene';

// What is painted on the road or stands beside it on the map: kerbs, start line, numbers of corners, time lost.

const pointOf = (line: Line, i: number): Point => ({ x: line.x[i] ?? NaN, y: line.y[i] ?? NaN });

/** The point `metres` outward from point `i` of an edge, at right angles to the road. */
function beside(edge: Line, centre: Line, i: number, metres: number): Point {
  const [e, c] = [pointOf(edge, i), pointOf(centre, i)];
  const half = Math.hypot(e.x - c.x, e.y - c.y) || 1;
  return { x: e.x + ((e.x - c.x) / half) * metres, y: e.y + ((e.y - c.y) / half) * metres };
}

/** Index of the road's point at a place along its centre line [m]. */
const indexAt = ({ lengths }: RoadShape, place: number): number =>
  Math.min(firstSince(lengths, place), lengths.length - 1);

/** Indices of the road's points from one place to another, over the first point where the road is closed. */
function indicesOf(road: RoadShape, from: number, to: number): number[] {
  const [first, end] = [indexAt(road, from), indexAt(road, to)];
  const count = road.lengths.length;
  const all: number[] = [];
  for (let i = first; i !== end && all.length < count; i = (i + 1) % count) all.push(i);
  return [...all, end];
}

/** Whether a point is at most `margin` outside a view [m]. */
const isIn = (view: Box, { x, y }: Point, margin: number): boolean =>
  x > view.minX - margin && x < view.maxX + margin && y > view.minY - margin && y < view.maxY + margin;

const KERB_DASH_M = 2; // chosen

/** Red and white along both edges of each corner, `width` metres wide; nothing where the track has no kerbs. */
export function drawKerbs(
  { ctx, view, colours }: Brush,
  road: RoadShape,
  corners: readonly MarkedCorner[],
  width: number,
): void {
  if (!(width > 0)) return;
  ctx.lineWidth = width;
  for (const { from, to, apex } of corners) {
    if (!isIn(view, pointOf(road.centre, indexAt(road, apex)), 150)) continue;
    const along = indicesOf(road, from, to);
    for (const edge of [road.left, road.right]) {
      const path = new Path2D();
      for (const i of along) {
        const { x, y } = beside(edge, road.centre, i, width / 2);
        path.lineTo(x, y);
      }
      ctx.strokeStyle = colours.mark;
      ctx.stroke(path);
      ctx.setLineDash([KERB_DASH_M, KERB_DASH_M]);
      ctx.strokeStyle = colours.kerb;
      ctx.stroke(path);
      ctx.setLineDash([]);
    }
  }
}

const CHEQUERS = 8; // across the road; chosen

/** Two rows of chequers across the road. */
export function drawStartLine({ ctx, colours, px, size }: Brush, road: RoadShape, place: number): void {
  const i = indexAt(road, place);
  const [left, right, centre] = [pointOf(road.left, i), pointOf(road.right, i), pointOf(road.centre, i)];
  const [ax, ay] = [(right.x - left.x) / CHEQUERS, (right.y - left.y) / CHEQUERS];
  const across = Math.hypot(ax, ay) || 1;
  const deep = Math.max(0.6 * size, 2 * px);
  const [dx, dy] = [(-ay / across) * deep, (ax / across) * deep];
  if (!Number.isFinite(centre.x + ax + dx)) return;
  for (let column = 0; column < CHEQUERS; ++column)
    for (const row of [-1, 0]) {
      const [x, y] = [left.x + column * ax + row * dx, left.y + column * ay + row * dy];
      ctx.fillStyle = (column + row) % 2 === 0 ? colours.mark : colours.wheel;
      ctx.beginPath();
      ctx.moveTo(x, y);
      ctx.lineTo(x + ax, y + ay);
      ctx.lineTo(x + ax + dx, y + ay + dy);
      ctx.lineTo(x + dx, y + dy);
      ctx.fill();
    }
}

const LABEL_PX = 16; // from the road's edge; chosen

/** "T3" on the outside of each corner, upright whatever way the map is turned. */
export function drawCornerNumbers(
  { ctx, camera, colours, ratio }: Brush,
  road: RoadShape,
  corners: readonly MarkedCorner[],
): void {
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.font = `600 12px ${colours.font}`;
  ctx.textAlign = 'center';
  ctx.textBaseline = 'middle';
  for (const { number, apex, turn } of corners) {
    const outside = turn > 0 ? road.right : road.left;
    const { x, y } = project(camera, beside(outside, road.centre, indexAt(road, apex), LABEL_PX / camera.scale));
    if (!(x > 0 && y > 0 && x < ctx.canvas.width / ratio && y < ctx.canvas.height / ratio)) continue;
    const text = `T${number}`;
    const half = ctx.measureText(text).width / 2 + 5;
    ctx.fillStyle = colours.land;
    ctx.globalAlpha = 0.85;
    ctx.fillRect(x - half, y - 9, 2 * half, 18);
    ctx.globalAlpha = 1;
    ctx.fillStyle = colours.ink;
    ctx.fillText(text, x, y);
  }
}

/** The line of a lap: red where it lost time, green where it gained, faint where neither. */
export function drawLosses({ ctx, colours }: Brush, { line, pieces, most }: Losses, width: number): void {
  ctx.lineWidth = width;
  for (const { first, end, lost } of pieces) {
    const path = new Path2D();
    for (let i = first; i <= end; ++i) path.lineTo(line.x[i % line.x.length] ?? NaN, line.y[i % line.x.length] ?? NaN);
    ctx.strokeStyle = lost > 0 ? colours.lost : colours.won;
    ctx.globalAlpha = 0.12 + 0.8 * Math.min(1, Math.abs(lost) / most);
    ctx.stroke(path);
  }
  ctx.globalAlpha = 1;
}
