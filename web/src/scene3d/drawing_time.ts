/** The part of a WebGL 2 context that reports when drawing is finished. */
export type Fences = Pick<
  WebGL2RenderingContext,
  'fenceSync' | 'deleteSync' | 'getSyncParameter' | 'flush' | 'SYNC_GPU_COMMANDS_COMPLETE' | 'SYNC_STATUS' | 'SIGNALED'
>;

/** Largest share of the time that drawing may take; chosen. */
const SHARE = 2 / 3;
/** Longest pause between pictures [ms]: the first one takes seconds, in which shaders are compiled; chosen. */
const LONGEST_REST = 250;

/**
 * Tells when a requested picture is finished and when the next may be requested; one at a time, without waiting.
 */
export class DrawingTime {
  readonly #fences: Fences;
  #fence: WebGLSync | null = null;
  #begun = -Infinity;
  #took = 0; // with the resolution of repaints [ms]

  constructor(fences: Fences) {
    this.#fences = fences;
  }

  /** Reports the request of a picture at this time [ms]. */
  begin(now: number): void {
    const gl = this.#fences;
    this.#fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    this.#begun = now;
  }

  /** True once for each picture, when it is finished. To be called at every repaint. */
  isDrawn(now: number): boolean {
    const gl = this.#fences;
    if (!this.#fence || gl.getSyncParameter(this.#fence, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
    gl.deleteSync(this.#fence);
    this.#fence = null;
    this.#took = now - this.#begun;
    return true;
  }

  /** Whether another picture may be requested. */
  isFree(now: number): boolean {
    const rest = Math.min(LONGEST_REST, this.#took / SHARE - this.#took);
    return this.#fence === null && now - this.#begun >= this.#took + rest - 4; // tolerates the jitter of repaints
  }
}
