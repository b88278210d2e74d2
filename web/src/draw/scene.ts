import type { Point } from '../lib/math';
import type { Limit, Plan } from '../protocol/topics';
import type { Hindsight, Pose } from '../state/hindsight';
import type { Road } from '../state/app_state';
import { groundGrid, transformOf, type Camera } from './camera';
import type { CarShape } from './car';
import { speedColour } from './speed_colour';
import type { Theme } from './theme';

/** Everything one picture of the map is made of; lengths in metres, angles in radians, in W. */
export interface Scene {
  readonly road: RoadShape | null;
  readonly racingLine: Limit | null; // of the fastest lap possible
  readonly reference: readonly Point[];
  readonly traceX: Float64Array;
  readonly traceY: Float64Array;
  readonly plan: Plan | null;
  readonly speedScale: number; // the speed that has the last colour [m/s]
  readonly hindsight: Hindsight | null; // what was predicted, beside what came
  readonly ghost: Pose | null; // drawn in the car's shape
  readonly car: { x: number; y: number; yaw: number; isBraking: boolean; shape: CarShape } | null;
}

/** A road as shapes the canvas keeps. */
export interface RoadShape {
  readonly surface: Path2D;
  readonly edges: Path2D;
  readonly centre: Path2D;
  readonly start: Path2D;
}

function trail(points: readonly Point[], into: Path2D = new Path2D()): Path2D {
  points.forEach(({ x, y }, i) => (i === 0 ? into.moveTo(x, y) : into.lineTo(x, y)));
  return into;
}

export function roadShape({ left, right, centre }: Road): RoadShape | null {
  const [firstLeft, firstRight] = [left[0], right[0]];
  if (!firstLeft || !firstRight) return null;
  const surface = trail([...left, ...[...right].reverse()]);
  surface.closePath();
  return { surface, edges: trail(right, trail(left)), centre: trail(centre), start: trail([firstLeft, firstRight]) };
}

type Context = CanvasRenderingContext2D;

function stroke(ctx: Context, path: Path2D, colour: string, width: number): void {
  ctx.strokeStyle = colour;
  ctx.lineWidth = width;
  ctx.stroke(path);
}

/** A square grid on the ground, so that speed is seen where there is no road either. */
function drawGround(ctx: Context, camera: Camera, colour: string, ratio: number): void {
  const { spacing, from, to } = groundGrid(camera, ctx.canvas.width / ratio, ctx.canvas.height / ratio);
  const lines = new Path2D();
  for (let x = from.x; x <= to.x; x += spacing) {
    lines.moveTo(x, from.y);
    lines.lineTo(x, to.y);
  }
  for (let y = from.y; y <= to.y; y += spacing) {
    lines.moveTo(from.x, y);
    lines.lineTo(to.x, y);
  }
  stroke(ctx, lines, colour, 1 / camera.scale);
}

function drawRoad(ctx: Context, road: RoadShape, colours: Theme, px: number): void {
  ctx.fillStyle = colours.road;
  ctx.fill(road.surface);
  stroke(ctx, road.edges, colours.edge, Math.max(0.15, 1.5 * px));
  ctx.setLineDash([3, 6]);
  stroke(ctx, road.centre, colours.centreLine, Math.max(0.1, 0.75 * px));
  ctx.setLineDash([]);
  stroke(ctx, road.start, colours.edge, Math.max(0.5, 2 * px));
}

function drawTrace(ctx: Context, xs: Float64Array, ys: Float64Array, colour: string, width: number): void {
  const path = new Path2D();
  for (let i = 0; i < xs.length; ++i) {
    const [x, y] = [xs[i] ?? NaN, ys[i] ?? NaN];
    // The car was put somewhere else: no line from there to here.
    const jumped = i === 0 || Math.hypot(x - (xs[i - 1] ?? NaN), y - (ys[i - 1] ?? NaN)) > 20;
    if (jumped) path.moveTo(x, y);
    else path.lineTo(x, y);
  }
  stroke(ctx, path, colour, width);
}

function drawPlan(ctx: Context, plan: Plan, speedScale: number, width: number): void {
  ctx.lineCap = 'round';
  for (let i = 0; i + 1 < plan.x_m.length; ++i) {
    const segment = new Path2D();
    segment.moveTo(plan.x_m[i] ?? NaN, plan.y_m[i] ?? NaN);
    segment.lineTo(plan.x_m[i + 1] ?? NaN, plan.y_m[i + 1] ?? NaN);
    stroke(ctx, segment, speedColour((plan.speed_mps[i] ?? NaN) / speedScale), width);
  }
  ctx.lineCap = 'butt';
}

function line(xs: ArrayLike<number>, ys: ArrayLike<number>): Path2D {
  const path = new Path2D();
  for (let i = 0; i < xs.length; ++i) path.lineTo(xs[i] ?? NaN, ys[i] ?? NaN);
  return path;
}

let lastLine: { of: Limit; path: Path2D } | null = null;

/** Thin and solid: to dash a whole lap in each picture takes a tenth of the main thread. The canvas keeps its shape. */
function drawRacingLine(ctx: Context, limit: Limit, colours: Theme, px: number): void {
  if (lastLine?.of !== limit) lastLine = { of: limit, path: line(limit.x_m, limit.y_m) };
  stroke(ctx, lastLine.path, colours.racingLine, Math.max(0.2, 1.5 * px));
}

/** A plan as a broad band, and on it the way that was then driven. */
function drawHindsight(ctx: Context, { plan, drivenX, drivenY }: Hindsight, colours: Theme, px: number): void {
  ctx.globalAlpha = 0.6;
  stroke(ctx, line(plan.x_m, plan.y_m), colours.foreseen, Math.max(1.1, 8 * px));
  ctx.globalAlpha = 1;
  stroke(ctx, line(drivenX, drivenY), colours.came, Math.max(0.18, 2 * px));
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

function drawCar(ctx: Context, car: NonNullable<Scene['car']>, colours: Theme, px: number): void {
  const { shape } = car;
  const length = shape.front - shape.rear;
  ctx.save();
  ctx.translate(car.x, car.y);
  ctx.rotate(car.yaw);
  // From far away a car of true size is a speck: never shorter than 18 px, and then with a ring around it.
  const grown = Math.max(1, (18 * px) / length);
  if (grown > 1) {
    ctx.beginPath();
    ctx.arc(0, 0, 15 * px, 0, 2 * Math.PI);
    ctx.strokeStyle = colours.accent;
    ctx.lineWidth = 3 * px;
    ctx.stroke();
  }
  ctx.scale(grown, grown);
  drawWheels(ctx, shape, colours.wheel);

  const narrow = shape.halfWidth * 0.84; // the wheels stand out a little, or nobody would see them steer
  ctx.beginPath();
  ctx.roundRect(shape.rear, -narrow, length, 2 * narrow, [0.5, 0.9, 0.9, 0.5]);
  ctx.fillStyle = colours.carBody;
  ctx.fill();
  ctx.strokeStyle = colours.carEdge;
  ctx.lineWidth = Math.max(0.06, (1 * px) / grown);
  ctx.stroke();

  ctx.beginPath();
  ctx.roundRect(shape.rear + 0.24 * length, -0.78 * narrow, 0.4 * length, 1.56 * narrow, 0.4);
  ctx.fillStyle = colours.carGlass;
  ctx.fill();
  ctx.beginPath();
  ctx.roundRect(shape.rear + 0.3 * length, -0.66 * narrow, 0.24 * length, 1.32 * narrow, 0.3);
  ctx.fillStyle = colours.carBody;
  ctx.fill();

  if (car.isBraking) {
    ctx.fillStyle = colours.brake;
    for (const y of [-0.85, 0.45]) ctx.fillRect(shape.rear - 0.04, y * narrow, 0.22, 0.4 * narrow);
  }
  ctx.restore();
}

/** The car's outline at another pose. */
function outline(ctx: Context, pose: Pose, { shape }: NonNullable<Scene['car']>, px: number): void {
  const grown = Math.max(1, (18 * px) / (shape.front - shape.rear));
  ctx.translate(pose.x, pose.y);
  ctx.rotate(pose.yaw);
  ctx.scale(grown, grown);
  ctx.beginPath();
  ctx.roundRect(shape.rear, -0.84 * shape.halfWidth, shape.front - shape.rear, 1.68 * shape.halfWidth, [0.5, 0.9, 0.9, 0.5]);
}

/** Where the car was to be now, by the plan of a second ago. */
function drawForeseen(ctx: Context, pose: Pose, car: NonNullable<Scene['car']>, colours: Theme, px: number): void {
  ctx.save();
  outline(ctx, pose, car, px);
  ctx.restore();
  ctx.strokeStyle = colours.foreseen;
  ctx.lineWidth = Math.max(0.15, 1.5 * px);
  ctx.stroke();
}

/** Another drive's car; nothing where it would only smudge the car itself. */
function drawGhost(ctx: Context, ghost: Pose, car: NonNullable<Scene['car']>, colours: Theme, px: number): void {
  const { shape } = car;
  if (Math.hypot(ghost.x - car.x, ghost.y - car.y) < Math.max(1, (18 * px) / (shape.front - shape.rear))) return;
  ctx.save();
  outline(ctx, ghost, car, px);
  ctx.globalAlpha = 0.45;
  ctx.fillStyle = colours.accent;
  ctx.fill();
  ctx.restore();
}

/** Draws the picture on the whole canvas, which has `ratio` device pixels to a CSS pixel. */
export function drawScene(ctx: Context, scene: Scene, camera: Camera, colours: Theme, ratio: number): void {
  ctx.setTransform(1, 0, 0, 1, 0, 0);
  ctx.fillStyle = colours.ground;
  ctx.fillRect(0, 0, ctx.canvas.width, ctx.canvas.height);
  ctx.setTransform(...transformOf(camera, ratio));
  ctx.lineJoin = 'round';
  const px = 1 / camera.scale; // one CSS pixel in metres

  drawGround(ctx, camera, colours.groundLine, ratio);
  if (scene.road) drawRoad(ctx, scene.road, colours, px);
  if (scene.racingLine) drawRacingLine(ctx, scene.racingLine, colours, px);
  drawTrace(ctx, scene.traceX, scene.traceY, colours.trace, Math.max(0.2, 2 * px));
  stroke(ctx, trail(scene.reference), scene.road ? colours.reference : colours.faint, Math.max(0.12, 1.5 * px));
  if (scene.hindsight) drawHindsight(ctx, scene.hindsight, colours, px);
  if (scene.plan) drawPlan(ctx, scene.plan, scene.speedScale, Math.max(0.45, 4 * px));
  if (scene.ghost && scene.car) drawGhost(ctx, scene.ghost, scene.car, colours, px);
  if (scene.car) drawCar(ctx, scene.car, colours, px);
  if (scene.hindsight?.foreseen && scene.car) drawForeseen(ctx, scene.hindsight.foreseen, scene.car, colours, px);
}

/** The whole track in a corner, with the car as a dot. */
export function drawInset(ctx: Context, road: RoadShape, car: Point | null, camera: Camera, colours: Theme, ratio: number): void {
  ctx.setTransform(...transformOf(camera, ratio));
  ctx.lineJoin = 'round';
  const px = 1 / camera.scale;
  stroke(ctx, road.centre, colours.panel, 7 * px);
  stroke(ctx, road.centre, colours.faint, 2.5 * px);
  if (!car) return;
  ctx.beginPath();
  ctx.arc(car.x, car.y, 5 * px, 0, 2 * Math.PI);
  ctx.fillStyle = colours.accent;
  ctx.fill();
  ctx.strokeStyle = colours.panel;
  ctx.lineWidth = 2 * px;
  ctx.stroke();
}
