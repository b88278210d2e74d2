// Cameras of the map: from world coordinates to pixels and back, following the car or showing the whole track.
import { type Box, clamp, type Point } from '../lib/math';

/** World to screen: x right, y up in W; pixels right and down on the screen. CSS pixels. */
export interface Camera {
  readonly centre: Point; // in W [m]
  readonly at: Point; // where the centre appears [px]
  readonly scale: number; // [px/m]
  readonly rotation: number; // of the world, counter-clockwise [rad]
}

/** The six numbers of CanvasRenderingContext2D.setTransform, for `ratio` device pixels to a CSS pixel. */
export function transformOf(camera: Camera, ratio: number): [number, number, number, number, number, number] {
  const k = camera.scale * ratio;
  const [cos, sin] = [Math.cos(camera.rotation) * k, Math.sin(camera.rotation) * k];
  const { x, y } = camera.centre;
  // Screen y points down: a counter-clockwise turn of the world, then a mirror.
  return [cos, -sin, -sin, -cos, camera.at.x * ratio - cos * x + sin * y, camera.at.y * ratio + sin * x + cos * y];
}

/** Where a point of the world appears [px]. */
export function project(camera: Camera, point: Point): Point {
  const [a, b, c, d, e, f] = transformOf(camera, 1);
  return { x: a * point.x + c * point.y + e, y: b * point.x + d * point.y + f };
}

/** The point of the world that appears at a place of the screen: the inverse of project(). */
export function unproject(camera: Camera, at: Point): Point {
  const [a, b, c, d, e, f] = transformOf(camera, 1);
  const [x, y, size] = [at.x - e, at.y - f, a * d - b * c];
  return { x: (d * x - c * y) / size, y: (a * y - b * x) / size };
}

/** A box of the world, along its axes, that holds all that a picture of this size shows. */
export function worldInView(camera: Camera, width: number, height: number): Box {
  // The transform is a reflection: except for its scale it is its own inverse.
  const [cos, sin] = [Math.cos(camera.rotation) / camera.scale, Math.sin(camera.rotation) / camera.scale];
  const [left, right, top, bottom] = [-camera.at.x, width - camera.at.x, -camera.at.y, height - camera.at.y];
  const xs = [cos * left, cos * right].flatMap((x) => [x - sin * top, x - sin * bottom]);
  const ys = [-sin * left, -sin * right].flatMap((y) => [y - cos * top, y - cos * bottom]);
  const { x, y } = camera.centre;
  return { minX: x + Math.min(...xs), maxX: x + Math.max(...xs), minY: y + Math.min(...ys), maxY: y + Math.max(...ys) };
}

/** What is kept free at the edges of a picture [px]. */
export interface Insets {
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
  readonly left: number;
}

/** The whole box in view, within the insets. */
export function fitting(box: Box, width: number, height: number, { top, right, bottom, left }: Insets): Camera {
  const spanX = Math.max(box.maxX - box.minX, 1);
  const spanY = Math.max(box.maxY - box.minY, 1);
  const [wide, high] = [Math.max(width - left - right, 1), Math.max(height - top - bottom, 1)];
  return {
    centre: { x: (box.minX + box.maxX) / 2, y: (box.minY + box.maxY) / 2 },
    at: { x: left + wide / 2, y: top + high / 2 },
    scale: Math.min(wide / spanX, high / spanY),
    rotation: 0,
  };
}

/** The same inset at each edge [px]. */
export const allRound = (margin: number): Insets => ({ top: margin, right: margin, bottom: margin, left: margin });

/**
 * The car below the middle, looking up the screen; `heading` is a smoothed yaw. The picture shows so many metres across
 * its smaller side, and more where one of `points` would be outside: `margin` is kept free at every edge [px].
 */
export function behind(
  car: Point,
  heading: number,
  width: number,
  height: number,
  metresAcross: number,
  points: readonly Point[] = [],
  margin = 24,
): Camera {
  const at = { x: width / 2, y: height * 0.72 };
  const [cos, sin] = [Math.cos(heading), Math.sin(heading)];
  let scale = Math.min(width, height) / metresAcross;
  for (const { x, y } of points) {
    const [ahead, left] = [cos * (x - car.x) + sin * (y - car.y), Math.abs(cos * (y - car.y) - sin * (x - car.x))];
    const room = Math.max(1, (ahead > 0 ? at.y : height - at.y) - margin);
    scale = Math.min(scale, room / Math.abs(ahead), Math.max(1, width / 2 - margin) / left);
  }
  return { centre: car, at, scale, rotation: Math.PI / 2 - heading };
}

/**
 * Lines of a square grid that cover the view: `least` metres apart, or twice, four times … that: 40 px or more
 * (chosen).
 */
export function groundGrid(
  camera: Camera,
  width: number,
  height: number,
  least = 5,
): { spacing: number; from: Point; to: Point } {
  const spacing = least * 2 ** Math.max(0, Math.ceil(Math.log2(40 / camera.scale / least)));
  // For any rotation the view lies within this distance of the point that the camera looks at.
  const reach =
    Math.hypot(Math.max(camera.at.x, width - camera.at.x), Math.max(camera.at.y, height - camera.at.y)) / camera.scale;
  const { x, y } = camera.centre;
  const snap = (value: number): number => Math.floor(value / spacing) * spacing;
  return {
    spacing,
    from: { x: snap(x - reach), y: snap(y - reach) },
    to: { x: snap(x + reach) + spacing, y: snap(y + reach) + spacing },
  };
}

/** Width of the view after one turn of the wheel or press of a key, from 15 m to 2 km (chosen) [m]. */
export const zoomed = (metresAcross: number, factor: number): number => clamp(metresAcross * factor, 15, 2000);
