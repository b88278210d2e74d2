/**
 * Size and visibility of an element as the browser's observers report them: reading them directly would force a layout.
 */
export interface OnScreen {
  /** Size without border and padding, in whole CSS pixels; 0 while it is not displayed. */
  readonly width: number;
  readonly height: number;
  /** Whether any of it is inside the window and not scrolled away. */
  readonly isSeen: boolean;
  end(): void;
}

/** Observes an element; `resized` is called when its size changes. */
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
