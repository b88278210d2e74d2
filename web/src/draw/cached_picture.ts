/** A part of a picture that is painted once and then copied until its key changes. */
export class CachedPicture {
  #canvas: HTMLCanvasElement | null = null;
  #key: readonly unknown[] = [];

  /**
   * The part in `width` × `height` device pixels. `paint` is called with an empty canvas when the key has changed.
   */
  picture(
    key: readonly unknown[],
    width: number,
    height: number,
    paint: (context: CanvasRenderingContext2D) => void,
  ): HTMLCanvasElement {
    this.#canvas ??= document.createElement('canvas');
    const canvas = this.#canvas;
    if (canvas.width === width && canvas.height === height && isSame(key, this.#key)) return canvas;
    [canvas.width, canvas.height] = [width, height]; // clears it too
    this.#key = key;
    const context = canvas.getContext('2d');
    if (context) paint(context);
    return canvas;
  }
}

/** Whether two lists hold the same values, one by one. */
export const isSame = (a: readonly unknown[], b: readonly unknown[]): boolean =>
  a.length === b.length && a.every((each, i) => Object.is(each, b[i]));
