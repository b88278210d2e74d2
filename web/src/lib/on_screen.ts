/**
 * What the browser tells of an element's box of its own accord: asking for it would make it lay out the page at once.
 */
export interface OnScreen {
  /** Without border and padding, in whole CSS pixels; 0 while it is not shown at all. */
  readonly width: number;
  readonly height: number;
  /** Some of it is in the window and not scrolled away. */
  readonly isSeen: boolean;
  end(): void;
}

/** Follows an element; `resized` is called when it has another size. */
export function onScreen(element: Element, resized: () => void = () => undefined): OnScreen {
  const sizes = new ResizeObserver(([entry]) => {
    if (!entry) return;
    const { width, height } = entry.contentRect;
    [state.width, state.height] = [Math.round(width), Math.round(height)];
    resized();
  });
  const places = new IntersectionObserver((entries) => (state.isSeen = entries.at(-1)?.isIntersecting ?? false));
  const state = {
    width: 0,
    height: 0,
    isSeen: false,
    end(): void {
      sizes.disconnect();
      places.disconnect();
    },
  };
  sizes.observe(element);
  places.observe(element);
  return state;
}
