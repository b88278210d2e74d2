/** The part of a WebGL 2 context that tells when it is done. */
export type Fences = Pick<
  WebGL2RenderingContext,
  'fenceSync' | 'deleteSync' | 'getSyncParameter' | 'flush' | 'SYNC_GPU_COMMANDS_COMPLETE' | 'SYNC_STATUS' | 'SIGNALED'
>;

/** Of the time that passes, pictures may take this share of whoever draws them. */
const SHARE = 2 / 3;
/** No rest is longer [ms]: the first picture takes seconds, in which shaders are compiled. */
const LONGEST_REST = 250;

/**
 * When a picture that was asked for is drawn, and when the next may be asked for; one at a time. Looks, and never
 * waits.
 */
export class DrawingTime {
  readonly #fences: Fences;
  #fence: WebGLSync | null = null;
  #begun = -Infinity;
  #took = 0; // as far as one can see from repaint to repaint [ms]

  constructor(fences: Fences) {
    this.#fences = fences;
  }

  /** A picture has been asked for, at this time [ms]. */
  begin(now: number): void {
    const gl = this.#fences;
    this.#fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    this.#begun = now;
  }

  /** True once for each picture: it is drawn. To be called at every repaint. */
  isDrawn(now: number): boolean {
    const gl = this.#fences;
    if (!this.#fence || gl.getSyncParameter(this.#fence, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
    gl.deleteSync(this.#fence);
    this.#fence = null;
    this.#took = now - this.#begun;
    return true;
  }

  /** Whether another picture may be asked for. */
  isFree(now: number): boolean {
    const rest = Math.min(LONGEST_REST, this.#took / SHARE - this.#took);
    return this.#fence === null && now - this.#begun >= this.#took + rest - 4; // repaints come when they come
  }
}
