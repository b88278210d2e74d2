import type { Box } from '../lib/math';
import { type Camera, transformOf, worldInView } from './camera';
import { type Theme, theme } from './theme';

/** Canvas, camera and colours with which the map is painted, in metres of the world. */
export interface Brush {
  readonly ctx: CanvasRenderingContext2D;
  readonly camera: Camera;
  readonly ratio: number; // device pixels to a CSS pixel
  readonly colours: Theme;
  readonly px: number; // one CSS pixel [m]
  readonly view: Box; // of the world, holds all that is seen
  readonly size: number; // scale of lines and paint; 1 for full-size cars
}

/** Sets the transform of a canvas such that coordinates of the world appear where the camera sees them. */
export function brushOn(ctx: CanvasRenderingContext2D, camera: Camera, ratio: number, size = 1): Brush {
  ctx.setTransform(...transformOf(camera, ratio));
  ctx.lineJoin = 'round';
  const view = worldInView(camera, ctx.canvas.width / ratio, ctx.canvas.height / ratio);
  return { ctx, camera, ratio, colours: theme(), px: 1 / camera.scale, view, size };
}
