// The map on a canvas: ground, road and racing line; trace, plan, cars and marks; and the small map.
import type { Point } from '../lib/math';
import type { Pose } from '../lib/poses';
import type { Limit } from '../protocol/topics';
import type { Hindsight } from '../state/hindsight';
import type { RoadLines } from '../state/road';
import type { Losses, MarkedCorner } from '../state/road_marks';
import { type Brush, brushOn } from './brush';
import { type Camera, groundGrid } from './camera';
import type { CarShape } from './car';
import { addLine, type Line, lengthsOf, lineOf, longestStep, stretchesInside } from './line';
import { drawCornerNumbers, drawKerbs, drawLosses, drawStartLine } from './road_marks';
import { theme } from './theme';

/** The content of one picture of the map; lengths in metres, angles in radians, in W. */
export interface Scene {
  readonly road: RoadShape | null;
  readonly racingLine: Limit | null; // of the fastest lap possible
  readonly corners: readonly MarkedCorner[];
  readonly kerb: number; // width [m]
  readonly isWhole: boolean; // the whole track: without what shows speed, the grid and the kerbs
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

/** Shape of a road; null before its lines are known. */
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

/** Strokes a path. */
function stroke({ ctx }: Brush, path: Path2D, colour: string, width: number): void {
  ctx.strokeStyle = colour;
  ctx.lineWidth = width;
  ctx.stroke(path);
}

/**
 * A square grid on the ground, which shows speed off the road too. Stroked line by line: as one path of crossing lines
 * it took a tenth of a core with software rendering.
 */
function drawGround({ ctx, camera, colours, ratio, px, size }: Brush): void {
  const { spacing, from, to } = groundGrid(camera, ctx.canvas.width / ratio, ctx.canvas.height / ratio, 5 * size);
  ctx.strokeStyle = colours.landLine;
  ctx.lineWidth = px;
  const draw = (x: number, y: number, toX: number, toY: number): void => {
    ctx.beginPath();
    ctx.moveTo(x, y);
    ctx.lineTo(toX, toY);
    ctx.stroke();
  };
  for (let x = from.x; x <= to.x; x += spacing) draw(x, from.y, x, to.y);
  for (let y = from.y; y <= to.y; y += spacing) draw(from.x, y, to.x, y);
}

/** Draws the part of the road that is in view: surface, edges, dashed centre line. */
function drawRoad(brush: Brush, { left, right, centre, lengths, reach }: RoadShape): void {
  const { ctx, view, colours, px, size } = brush;
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
  stroke(brush, edges, colours.mark, Math.max(0.15 * size, 1.5 * px));
  ctx.setLineDash([3 * size, 6 * size]);
  for (const [first, end] of stretches) {
    const dashes = new Path2D();
    addLine(dashes, centre, first, end);
    ctx.lineDashOffset = lengths[first] ?? 0; // keeps the dashes fixed to the road
    stroke(brush, dashes, colours.mark, Math.max(0.1 * size, 0.75 * px));
  }
  ctx.lineDashOffset = 0;
  ctx.setLineDash([]);
}

/** Step of the trace beyond which the car was placed elsewhere: no line is drawn across it [m]; chosen. */
const JUMP_M = 20;

/** The part of a line that is in view; longer steps than `reach` are jumps [m]. */
function drawInView(brush: Brush, points: Line, reach: number, colour: string, width: number): void {
  const path = new Path2D();
  for (const [first, end] of stretchesInside(points, brush.view, reach)) addLine(path, points, first, end, reach);
  stroke(brush, path, colour, width);
}

/** Draws a whole line. */
function drawLine(brush: Brush, line: Line, colour: string, width: number): void {
  const path = new Path2D();
  addLine(path, line, 0, line.x.length);
  stroke(brush, path, colour, width);
}

/** Longest step of each racing line [m]: found once, because lines are long. */
const reaches = new WeakMap<Limit, number>();

/** Draws the racing line, thin and solid: dashes would double the cost. */
function drawRacingLine(brush: Brush, limit: Limit): void {
  const points = { x: limit.x_m, y: limit.y_m };
  const reach = reaches.get(limit) ?? longestStep(points);
  reaches.set(limit, reach);
  drawInView(brush, points, reach, brush.colours.b, Math.max(0.2 * brush.size, 1.5 * brush.px));
}

/** Draws a past plan as a broad band, with the path driven since on top. */
function drawHindsight(brush: Brush, { plan, drivenX, drivenY }: Hindsight): void {
  const { ctx, colours, px, size } = brush;
  ctx.globalAlpha = 0.6;
  drawLine(brush, { x: plan.x_m, y: plan.y_m }, colours.pastPlan, Math.max(1.1 * size, 8 * px));
  ctx.globalAlpha = 1;
  drawLine(brush, { x: drivenX, y: drivenY }, colours.a, Math.max(0.18 * size, 2 * px));
}

/** Draws the wheels, in the axes of the car. */
function drawWheels({ ctx, colours }: Brush, shape: CarShape): void {
  ctx.fillStyle = colours.wheel;
  for (const wheel of shape.wheels) {
    ctx.save();
    ctx.translate(wheel.x, wheel.y);
    ctx.rotate(wheel.angle);
    ctx.fillRect(-shape.wheelLength / 2, -shape.wheelWidth / 2, shape.wheelLength, shape.wheelWidth);
    ctx.restore();
  }
}

/** Radii of the corners of a body seen from above: tail, nose, nose, tail [m]; chosen. */
const CORNER_RADII_M = [0.5, 0.9, 0.9, 0.5];
/** Width of the drawn body to that of the car: narrower, so that the wheels are seen to steer; chosen. */
const NARROW = 0.84;

type Car = NonNullable<Scene['car']>;

/** Factor by which a car is enlarged from far away, so that it is at least 18 px long. */
const grownBy = ({ front, rear }: CarShape, px: number): number => Math.max(1, (18 * px) / (front - rear));

/** The outline of a car's body at a pose, as the path that is drawn next; in the axes of the body until restored. */
function outline({ ctx, px }: Brush, { x, y, yaw }: Point & { yaw: number }, { shape }: Car): void {
  const { front, rear, halfWidth, size } = shape;
  const [grown, narrow] = [grownBy(shape, px), NARROW * halfWidth];
  ctx.save();
  ctx.translate(x, y);
  ctx.rotate(yaw);
  ctx.scale(grown, grown);
  ctx.beginPath();
  ctx.roundRect(
    rear,
    -narrow,
    front - rear,
    2 * narrow,
    CORNER_RADII_M.map((radius) => radius * size),
  );
}

/** Draws the car with its wheels and brake lamps; from far away with a ring round it. */
function drawCar(brush: Brush, car: Car): void {
  const { ctx, colours, px } = brush;
  const { shape } = car;
  const { size } = shape;
  const length = shape.front - shape.rear;
  const [grown, narrow] = [grownBy(shape, px), NARROW * shape.halfWidth];
  if (grown > 1) {
    ctx.beginPath();
    ctx.arc(car.x, car.y, 15 * px, 0, 2 * Math.PI);
    ctx.strokeStyle = colours.a;
    ctx.lineWidth = 3 * px;
    ctx.stroke();
  }
  outline(brush, car, car);
  drawWheels(brush, shape);
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

/** Draws a triangle where a fault began. */
function drawFault({ ctx, colours, px, size: unit }: Brush, { x, y }: Point): void {
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

/** Draws the outline of the car at the pose that a past plan predicted for now. */
function drawPredicted(brush: Brush, pose: Pose, car: Car): void {
  outline(brush, pose, car);
  brush.ctx.restore();
  brush.ctx.strokeStyle = brush.colours.pastPlan;
  brush.ctx.lineWidth = Math.max(0.15 * car.shape.size, 1.5 * brush.px);
  brush.ctx.stroke();
}

/** Draws the ghost car, except where it would overlap the car itself. */
function drawGhost(brush: Brush, ghost: Pose, car: Car): void {
  const { ctx, colours, px } = brush;
  const { size } = car.shape;
  if (Math.hypot(ghost.x - car.x, ghost.y - car.y) < Math.max(size, grownBy(car.shape, px))) return;
  outline(brush, ghost, car);
  ctx.globalAlpha = 0.45;
  ctx.fillStyle = colours.b;
  ctx.fill();
  ctx.restore();
}

/** Draws the static part of the scene on the whole canvas: ground, road, racing line. */
export function drawWorld(
  ctx: CanvasRenderingContext2D,
  scene: Pick<Scene, 'road' | 'racingLine' | 'corners' | 'kerb' | 'isWhole' | 'start' | 'losses' | 'size'>,
  camera: Camera,
  ratio: number,
): void {
  ctx.setTransform(1, 0, 0, 1, 0, 0);
  ctx.fillStyle = theme().land;
  ctx.fillRect(0, 0, ctx.canvas.width, ctx.canvas.height);
  const brush = brushOn(ctx, camera, ratio, scene.size);
  if (!scene.isWhole) drawGround(brush);
  if (scene.road) {
    drawRoad(brush, scene.road);
    if (!scene.isWhole) drawKerbs(brush, scene.road, scene.corners, scene.kerb);
    drawStartLine(brush, scene.road, scene.start);
  }
  if (scene.losses) drawLosses(brush, scene.losses, Math.max(1 * brush.size, 6 * brush.px));
  if (scene.racingLine) drawRacingLine(brush, scene.racingLine);
  if (scene.road) drawCornerNumbers(brush, scene.road, scene.corners);
}

/** Draws the moving part of the scene, on top of drawWorld(). */
export function drawMoving(ctx: CanvasRenderingContext2D, scene: Scene, camera: Camera, ratio: number): void {
  const brush = brushOn(ctx, camera, ratio, scene.size);
  const { colours, px, size } = brush;
  drawInView(brush, scene.trace, JUMP_M * Math.max(size, 0.1), colours.a, Math.max(0.2 * size, 2 * px));
  if (!scene.road) drawLine(brush, lineOf(scene.reference), colours.quiet, Math.max(0.12 * size, 1.5 * px));
  if (scene.hindsight) drawHindsight(brush, scene.hindsight);
  drawLine(brush, scene.plan, colours.plan, Math.max(0.45 * size, 4 * px));
  for (const mark of scene.faults) drawFault(brush, mark);
  if (scene.ghost && scene.car) drawGhost(brush, scene.ghost, scene.car);
  if (scene.car) drawCar(brush, scene.car);
  if (scene.hindsight?.predicted && scene.car) drawPredicted(brush, scene.hindsight.predicted, scene.car);
}

/** Draws a ring where the cursor of the plots stands. */
export function drawCursor(ctx: CanvasRenderingContext2D, at: Point, camera: Camera, ratio: number): void {
  const { colours, px } = brushOn(ctx, camera, ratio);
  for (const [colour, width] of [
    [colours.wheel, 5],
    [colours.act, 3],
  ] as const) {
    ctx.beginPath();
    ctx.arc(at.x, at.y, 9 * px, 0, 2 * Math.PI);
    ctx.strokeStyle = colour;
    ctx.lineWidth = width * px;
    ctx.stroke();
  }
}

/** Draws the small map: the whole track, and the line of a lap in the colours of the time lost. */
export function drawOutline(
  ctx: CanvasRenderingContext2D,
  { centre }: RoadShape,
  losses: Losses | null,
  camera: Camera,
  ratio: number,
): void {
  const brush = brushOn(ctx, camera, ratio);
  const { colours, px } = brush;
  drawLine(brush, centre, colours.sheet, 7 * px);
  drawLine(brush, centre, colours.quiet, 2.5 * px);
  const onPaper = { ...colours, lost: colours.lostInText, won: colours.wonInText };
  if (losses) drawLosses({ ...brush, colours: onPaper }, losses, 4 * px);
}

/** Draws the car on the small map, as a dot. */
export function drawDot(ctx: CanvasRenderingContext2D, car: Point, camera: Camera, ratio: number): void {
  const { colours, px } = brushOn(ctx, camera, ratio);
  ctx.beginPath();
  ctx.arc(car.x, car.y, 5 * px, 0, 2 * Math.PI);
  ctx.fillStyle = colours.ink;
  ctx.fill();
  ctx.strokeStyle = colours.sheet;
  ctx.lineWidth = 2 * px;
  ctx.stroke();
}
