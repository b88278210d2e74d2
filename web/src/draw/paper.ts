import { type OnScreen, onScreen } from '../lib/on_screen';

/** A canvas in the screen's resolution; its size follows its place on the page. */
export class Paper {
  readonly canvas: HTMLCanvasElement;
  readonly box: OnScreen;

  constructor(canvas: HTMLCanvasElement, resized?: () => void) {
    this.canvas = canvas;
    this.box = onScreen(canvas, resized);
  }

  /** Device pixels to a CSS pixel; null while there is nothing to paint on. */
  prepare(): { context: CanvasRenderingContext2D; ratio: number } | null {
    const { width, height } = this.box;
    const context = this.canvas.getContext('2d');
    if (!context || width === 0 || height === 0) return null;
    const ratio = Math.min(devicePixelRatio, 2);
    const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== wide || this.canvas.height !== high)
      [this.canvas.width, this.canvas.height] = [wide, high];
    return { context, ratio };
  }
}
