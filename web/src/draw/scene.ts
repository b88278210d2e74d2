import type { Box, Point } from '../lib/math';
import type { Limit } from '../protocol/topics';
import type { Hindsight, Pose } from '../state/hindsight';
import type { RoadLines } from '../state/road';
import type { Losses, MarkedCorner } from '../state/road_marks';
import { type Camera, groundGrid, transformOf, worldInView } from './camera';
import type { CarShape } from './car';
import { addLine, type Line, lengthsOf, lineOf, longestStep, stretchesInside } from './line';
import { drawCornerNumbers, drawKerbs, drawLosses, drawStartLine } from './road_marks';
import type { Theme } from './theme';

/** The content of one picture of the map; lengths in metres, angles in radians, in W. */
export interface Scene {
  readonly road: RoadShape | null;
  readonly racingLine: Limit | null; // of the fastest lap possible
  readonly corners: readonly MarkedCorner[];
  readonly kerb: number; // width [m]
  readonly start: number; // of laps, along the centre line [m]
  readonly losses: Losses | null; // the line of a lap, coloured by the time lost on it
  readonly reference: readonly Point[];
  readonly trace: Line; // where the car has been
  readonly plan: Line; // from the car on
  readonly size: number; // scale of lines and paint; 1 for full-size cars
  readonly hindsight: Hindsight | null; // a past plan and the path driven since
  readonly faults: readonly Point[]; // where faults began
  readonly ghost: Pose | null; // drawn in the car's shape
  readonly car: { x: number; y: number; yaw: number; isBraking: boolean; shape: CarShape } | null;
}

/** A road's lines with equally many points; points of equal index are opposite each other. */
export interface RoadShape {
  readonly left: Line;
  readonly right: Line;
  readonly centre: Line;
  readonly lengths: Float64Array; // of the centre up to each point [m]
  readonly reach: number; // longest step plus largest half width: the margin for clipping to the view [m]
}

export function roadShape(road: RoadLines): RoadShape | null {
  const count = Math.min(road.left.length, road.right.length, road.centre.length);
  if (count < 2) return null;
  const [left, right, centre] = [road.left, road.right, road.centre].map((points) =>
    lineOf(points.slice(0, count)),
  ) as [Line, Line, Line];
  const far = (edge: Line, i: number): number =>
    Math.hypot((edge.x[i] ?? 0) - (centre.x[i] ?? 0), (edge.y[i] ?? 0) - (centre.y[i] ?? 0));
  const halves = Array.from({ length: count }, (_, i) => Math.max(far(left, i), far(right, i)));
  const steps = [left, right, centre].map((line) => longestStep(line));
  return {
    left,
    right,
    centre,
    lengths: lengthsOf(centre),
    reach: Math.max(...steps) + halves.reduce((a, b) => Math.max(a, b), 0),
  };
}

type Context = CanvasRenderingContext2D;

function stroke(ctx: Context, path: Path2D, colour: string, width: number): void {
  ctx.strokeStyle = colour;
  ctx.lineWidth = width;
  ctx.stroke(path);
}

/**
 * A square grid on the ground, which shows speed off the road too. Stroked line by line: as one path of crossing lines
 * it took a tenth of a core with software rendering.
 */
function drawGround(ctx: Context, camera: Camera, colour: string, ratio: number, size: number): void {
  const { spacing, from, to } = groundGrid(camera, ctx.canvas.width / ratio, ctx.canvas.height / ratio, 5 * size);
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1 / camera.scale;
  const draw = (x: number, y: number, toX: number, toY: number): void => {
    ctx.beginPath();
    ctx.moveTo(x, y);
    ctx.lineTo(toX, toY);
    ctx.stroke();
  };
  for (let x = from.x; x <= to.x; x += spacing) draw(x, from.y, x, to.y);
  for (let y = from.y; y <= to.y; y += spacing) draw(from.x, y, to.x, y);
}

function drawRoad(
  ctx: Context,
  { left, right, centre, lengths, reach }: RoadShape,
  view: Box,
  colours: Theme,
  px: number,
  size: number,
): void {
  const stretches = stretchesInside(centre, view, reach);
  const [surface, edges] = [new Path2D(), new Path2D()];
  for (const [first, end] of stretches) {
    addLine(surface, left, first, end);
    for (let i = end - 1; i >= first; --i) surface.lineTo(right.x[i] ?? NaN, right.y[i] ?? NaN);
    surface.closePath();
    for (const edge of [left, right]) addLine(edges, edge, first, end);
  }
  ctx.fillStyle = colours.road;
  ctx.fill(surface);
  stroke(ctx, edges, colours.mark, Math.max(0.15 * size, 1.5 * px));
  ctx.setLineDash([3 * size, 6 * size]);
  for (const [first, end] of stretches) {
    const dashes = new Path2D();
    addLine(dashes, centre, first, end);
    ctx.lineDashOffset = lengths[first] ?? 0; // keeps the dashes fixed to the road
    stroke(ctx, dashes, colours.mark, Math.max(0.1 * size, 0.75 * px));
  }
  ctx.lineDashOffset = 0;
  ctx.setLineDash([]);
}

const JUMP_M = 20; // the car was placed elsewhere: no line across the jump

/** The part of a line that is in view; longer steps than `reach` are jumps [m]. */
function drawInView(ctx: Context, points: Line, view: Box, reach: number, colour: string, width: number): void {
  const path = new Path2D();
  for (const [first, end] of stretchesInside(points, view, reach)) addLine(path, points, first, end, reach);
  stroke(ctx, path, colour, width);
}

function trail(points: readonly Point[]): Path2D {
  const path = new Path2D();
  for (const { x, y } of points) path.lineTo(x, y);
  return path;
}

function line(xs: ArrayLike<number>, ys: ArrayLike<number>): Path2D {
  const path = new Path2D();
  for (let i = 0; i < xs.length; ++i) path.lineTo(xs[i] ?? NaN, ys[i] ?? NaN);
  return path;
}

const reaches = new WeakMap<Limit, number>();

/** Thin and solid: dashes would double the cost. */
function drawRacingLine(ctx: Context, limit: Limit, view: Box, colours: Theme, px: number, size: number): void {
  const points = { x: limit.x_m, y: limit.y_m };
  const reach = reaches.get(limit) ?? longestStep(points);
  reaches.set(limit, reach);
  drawInView(ctx, points, view, reach, colours.b, Math.max(0.2 * size, 1.5 * px));
}

/** A past plan as a broad band, with the path driven since on top. */
function drawHindsight(
  ctx: Context,
  { plan, drivenX, drivenY }: Hindsight,
  colours: Theme,
  px: number,
  size: number,
): void {
  ctx.globalAlpha = 0.6;
  stroke(ctx, line(plan.x_m, plan.y_m), colours.pastPlan, Math.max(1.1 * size, 8 * px));
  ctx.globalAlpha = 1;
  stroke(ctx, line(drivenX, drivenY), colours.a, Math.max(0.18 * size, 2 * px));
}

function drawWheels(ctx: Context, shape: CarShape, colour: string): void {
  ctx.fillStyle = colour;
  for (const wheel of shape.wheels) {
    ctx.save();
    ctx.translate(wheel.x, wheel.y);
    ctx.rotate(wheel.angle);
    ctx.fillRect(-shape.wheelLength / 2, -shape.wheelWidth / 2, shape.wheelLength, shape.wheelWidth);
    ctx.restore();
  }
}

/** Radii of a body seen from above: tail, nose, nose, tail. */
const NOSE_M = [0.5, 0.9, 0.9, 0.5];

function drawCar(ctx: Context, car: NonNullable<Scene['car']>, colours: Theme, px: number): void {
  const { shape } = car;
  const { size } = shape;
  const length = shape.front - shape.rear;
  ctx.save();
  ctx.translate(car.x, car.y);
  ctx.rotate(car.yaw);
  // From far away the car is drawn enlarged, at least 18 px long, with a ring around it.
  const grown = Math.max(1, (18 * px) / length);
  if (grown > 1) {
    ctx.beginPath();
    ctx.arc(0, 0, 15 * px, 0, 2 * Math.PI);
    ctx.strokeStyle = colours.a;
    ctx.lineWidth = 3 * px;
    ctx.stroke();
  }
  ctx.scale(grown, grown);
  drawWheels(ctx, shape, colours.wheel);

  const narrow = shape.halfWidth * 0.84; // narrower than the wheels, so that they are seen to steer
  ctx.beginPath();
  ctx.roundRect(
    shape.rear,
    -narrow,
    length,
    2 * narrow,
    NOSE_M.map((radius) => radius * size),
  );
  ctx.fillStyle = colours.car;
  ctx.fill();
  ctx.strokeStyle = colours.wheel;
  ctx.lineWidth = Math.max(0.06 * size, (1 * px) / grown);
  ctx.stroke();

  ctx.beginPath();
  ctx.roundRect(shape.rear + 0.24 * length, -0.78 * narrow, 0.4 * length, 1.56 * narrow, 0.4 * size);
  ctx.fillStyle = colours.glass;
  ctx.fill();
  ctx.beginPath();
  ctx.roundRect(shape.rear + 0.3 * length, -0.66 * narrow, 0.24 * length, 1.32 * narrow, 0.3 * size);
  ctx.fillStyle = colours.car;
  ctx.fill();

  if (car.isBraking) {
    ctx.fillStyle = colours.lost;
    for (const y of [-0.85, 0.45]) ctx.fillRect(shape.rear - 0.04 * size, y * narrow, 0.22 * size, 0.4 * narrow);
  }
  ctx.restore();
}

/** A triangle where a fault began. */
function drawFault(ctx: Context, { x, y }: Point, colours: Theme, px: number, unit: number): void {
  const size = Math.max(0.9 * unit, 7 * px);
  ctx.beginPath();
  ctx.moveTo(x, y + size);
  ctx.lineTo(x - 0.87 * size, y - 0.5 * size);
  ctx.lineTo(x + 0.87 * size, y - 0.5 * size);
  ctx.closePath();
  ctx.fillStyle = colours.lost;
  ctx.fill();
  ctx.strokeStyle = colours.sheet;
  ctx.lineWidth = 1.5 * px;
  ctx.stroke();
}

/** The car's outline at another pose. */
function outline(ctx: Context, pose: Pose, { shape }: NonNullable<Scene['car']>, px: number): void {
  const grown = Math.max(1, (18 * px) / (shape.front - shape.rear));
  ctx.translate(pose.x, pose.y);
  ctx.rotate(pose.yaw);
  ctx.scale(grown, grown);
  ctx.beginPath();
  ctx.roundRect(
    shape.rear,
    -0.84 * shape.halfWidth,
    shape.front - shape.rear,
    1.68 * shape.halfWidth,
    NOSE_M.map((radius) => radius * shape.size),
  );
}

/** The pose that the plan of a second ago predicts for now. */
function drawPredicted(ctx: Context, pose: Pose, car: NonNullable<Scene['car']>, colours: Theme, px: number): void {
  ctx.save();
  outline(ctx, pose, car, px);
  ctx.restore();
  ctx.strokeStyle = colours.pastPlan;
  ctx.lineWidth = Math.max(0.15 * car.shape.size, 1.5 * px);
  ctx.stroke();
}

/** The ghost car; not drawn where it would overlap the car itself. */
function drawGhost(ctx: Context, ghost: Pose, car: NonNullable<Scene['car']>, colours: Theme, px: number): void {
  const { shape } = car;
  const { size } = shape;
  if (Math.hypot(ghost.x - car.x, ghost.y - car.y) < Math.max(size, (18 * px) / (shape.front - shape.rear))) return;
  ctx.save();
  outline(ctx, ghost, car, px);
  ctx.globalAlpha = 0.45;
  ctx.fillStyle = colours.b;
  ctx.fill();
  ctx.restore();
}

/**
 * The static part of the scene: ground, road, racing line. Covers the whole canvas, which has `ratio` device pixels
 * to a CSS pixel.
 */
export function drawWorld(
  ctx: Context,
  scene: Pick<Scene, 'road' | 'racingLine' | 'corners' | 'kerb' | 'start' | 'losses' | 'size'>,
  camera: Camera,
  colours: Theme,
  ratio: number,
): void {
  ctx.setTransform(1, 0, 0, 1, 0, 0);
  ctx.fillStyle = colours.land;
  ctx.fillRect(0, 0, ctx.canvas.width, ctx.canvas.height);
  ctx.setTransform(...transformOf(camera, ratio));
  ctx.lineJoin = 'round';
  const px = 1 / camera.scale; // one CSS pixel in metres
  const { size } = scene;
  const view = worldInView(camera, ctx.canvas.width / ratio, ctx.canvas.height / ratio);
  drawGround(ctx, camera, colours.landLine, ratio, size);
  if (scene.road) {
    drawRoad(ctx, scene.road, view, colours, px, size);
    drawKerbs(ctx, scene.road, scene.corners, scene.kerb, view, colours);
    drawStartLine(ctx, scene.road, scene.start, colours, px, size);
  }
  if (scene.losses) drawLosses(ctx, scene.losses, colours, Math.max(1 * size, 6 * px));
  if (scene.racingLine) drawRacingLine(ctx, scene.racingLine, view, colours, px, size);
  if (scene.road) drawCornerNumbers(ctx, scene.road, scene.corners, camera, colours, ratio);
}

/** The moving part of the scene, on top of drawWorld(). */
export function drawMoving(ctx: Context, scene: Scene, camera: Camera, colours: Theme, ratio: number): void {
  ctx.setTransform(...transformOf(camera, ratio));
  ctx.lineJoin = 'round';
  const px = 1 / camera.scale;
  const { size } = scene;
  const view = worldInView(camera, ctx.canvas.width / ratio, ctx.canvas.height / ratio);
  drawInView(ctx, scene.trace, view, JUMP_M * Math.max(size, 0.1), colours.a, Math.max(0.2 * size, 2 * px));
  if (!scene.road) stroke(ctx, trail(scene.reference), colours.quiet, Math.max(0.12 * size, 1.5 * px));
  if (scene.hindsight) drawHindsight(ctx, scene.hindsight, colours, px, size);
  stroke(ctx, line(scene.plan.x, scene.plan.y), colours.plan, Math.max(0.45 * size, 4 * px));
  for (const mark of scene.faults) drawFault(ctx, mark, colours, px, size);
  if (scene.ghost && scene.car) drawGhost(ctx, scene.ghost, scene.car, colours, px);
  if (scene.car) drawCar(ctx, scene.car, colours, px);
  if (scene.hindsight?.predicted && scene.car) drawPredicted(ctx, scene.hindsight.predicted, scene.car, colours, px);
}

/** Where the cursor of the plots stands. */
export function drawCursor(ctx: Context, at: Point, camera: Camera, colours: Theme, ratio: number): void {
  ctx.setTransform(...transformOf(camera, ratio));
  const px = 1 / camera.scale;
  for (const [radius, colour, width] of [
    [9, colours.wheel, 5],
    [9, colours.act, 3],
  ] as const) {
    ctx.beginPath();
    ctx.arc(at.x, at.y, radius * px, 0, 2 * Math.PI);
    ctx.strokeStyle = colour;
    ctx.lineWidth = width * px;
    ctx.stroke();
  }
}

/** The whole track, small. */
export function drawOutline(ctx: Context, { centre }: RoadShape, camera: Camera, colours: Theme, ratio: number): void {
  ctx.setTransform(...transformOf(camera, ratio));
  ctx.lineJoin = 'round';
  const px = 1 / camera.scale;
  const path = new Path2D();
  addLine(path, centre, 0, centre.x.length);
  stroke(ctx, path, colours.sheet, 7 * px);
  stroke(ctx, path, colours.quiet, 2.5 * px);
}

/** The car on it, or the cursor of the plots. */
export function drawDot(
  ctx: Context,
  car: Point,
  camera: Camera,
  colours: Theme,
  ratio: number,
  colour = colours.ink,
): void {
  ctx.setTransform(...transformOf(camera, ratio));
  const px = 1 / camera.scale;
  ctx.beginPath();
  ctx.arc(car.x, car.y, 5 * px, 0, 2 * Math.PI);
  ctx.fillStyle = colour;
  ctx.fill();
  ctx.strokeStyle = colours.sheet;
  ctx.lineWidth = 2 * px;
  ctx.stroke();
}
