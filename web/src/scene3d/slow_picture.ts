import { type Camera, type Scene, SRGBColorSpace, type WebGLRenderer, WebGLRenderTarget } from 'three';
import { DrawingTime } from './drawing_time';

/** Functions missing from the types of three.js. */
type Renderer = WebGLRenderer & {
  setRenderTargetFramebuffer(target: WebGLRenderTarget, framebuffer: WebGLFramebuffer): void;
};

/**
 * Pictures with software rendering. There the browser reads the canvas back at each repaint, and the page blocks until
 * it is drawn. So a picture is drawn into a framebuffer and copied to the canvas when it is finished: the page waits
 * for the copy only.
 */
export class SlowPicture {
  readonly #renderer: WebGLRenderer;
  readonly #gl: WebGL2RenderingContext;
  readonly #time: DrawingTime;
  readonly #target = new WebGLRenderTarget(1, 1);
  readonly #framebuffer: WebGLFramebuffer;
  readonly #colour: WebGLRenderbuffer;
  readonly #depth: WebGLRenderbuffer;

  constructor(renderer: WebGLRenderer) {
    this.#renderer = renderer;
    const gl = renderer.getContext() as WebGL2RenderingContext;
    this.#gl = gl;
    this.#time = new DrawingTime(gl);
    [this.#framebuffer, this.#colour, this.#depth] = [
      gl.createFramebuffer(),
      gl.createRenderbuffer(),
      gl.createRenderbuffer(),
    ];
    // The target has sRGB colours, as the screen: three.js draws so for XR render targets.
    Object.assign(this.#target, { isXRRenderTarget: true });
    this.#target.texture.colorSpace = SRGBColorSpace;
    (renderer as Renderer).setRenderTargetFramebuffer(this.#target, this.#framebuffer);
  }

  /** Whether another picture may be drawn. */
  isFree(now: number): boolean {
    return this.#time.isFree(now);
  }

  /** Begins to compile the shaders of a picture. */
  compile(scene: Scene, camera: Camera, now: number): void {
    this.#renderer.setRenderTarget(this.#target); // shaders depend on the target
    this.#renderer.compile(scene, camera);
    this.#renderer.setRenderTarget(null);
    this.#time.begin(now);
  }

  /** True once, when the shaders are compiled. To be called at every repaint until then. */
  isCompiled(now: number): boolean {
    return this.#time.isDrawn(now);
  }

  /** Begins to draw a picture of this size. */
  draw(scene: Scene, camera: Camera, width: number, height: number, now: number): void {
    if (this.#target.width !== width || this.#target.height !== height) this.#resize(width, height);
    this.#renderer.setRenderTarget(this.#target);
    this.#renderer.render(scene, camera);
    this.#renderer.setRenderTarget(null);
    this.#time.begin(now);
  }

  /** Gives target and buffers another size. */
  #resize(width: number, height: number): void {
    const gl = this.#gl;
    this.#target.setSize(width, height);
    this.#renderer.state.bindFramebuffer(gl.FRAMEBUFFER, this.#framebuffer);
    for (const [buffer, format, place] of [
      [this.#colour, gl.RGBA8, gl.COLOR_ATTACHMENT0],
      [this.#depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT],
    ] as const) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
    }
    gl.bindRenderbuffer(gl.RENDERBUFFER, null);
    this.#renderer.state.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** Copies the picture to the canvas if it is finished; returns whether it was. To be called at every repaint. */
  show(now: number): boolean {
    if (!this.#time.isDrawn(now)) return false;
    const gl = this.#gl;
    const { width, height } = this.#target;
    if (gl.canvas.width !== width || gl.canvas.height !== height) this.#renderer.setSize(width, height, false);
    this.#renderer.state.bindFramebuffer(gl.READ_FRAMEBUFFER, this.#framebuffer);
    this.#renderer.state.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    this.#renderer.state.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
    return true;
  }

  dispose(): void {
    this.#gl.deleteFramebuffer(this.#framebuffer);
    this.#gl.deleteRenderbuffer(this.#colour);
    this.#gl.deleteRenderbuffer(this.#depth);
    this.#target.dispose();
  }
}
