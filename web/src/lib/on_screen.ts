/** What the browser tells of an element's box of its own accord: asking for it would make it lay out the page at once. */
export interface OnScreen {
  /** Without border and padding, in whole CSS pixels; 0 while it is not shown at all. */
  readonly width: number;
  readonly height: number;
  /** Some of it is in the window and not scrolled away; or drawAll() wants all. */
  readonly isSeen: boolean;
  end(): void;
}

let countsAll = false;
const repaint = (): Promise<number> => new Promise((resolve) => requestAnimationFrame(resolve));

/** Lets everything count as seen for two repaints, so that what is scrolled away is drawn as well. */
export async function drawAll(): Promise<void> {
  countsAll = true;
  await repaint();
  await repaint();
  countsAll = false;
}

/** Follows an element; `resized` is called when it has another size. */
export function onScreen(element: Element, resized: () => void = () => undefined): OnScreen {
  const sizes = new ResizeObserver(([entry]) => {
    if (!entry) return;
    const { width, height } = entry.contentRect;
    [state.width, state.height] = [Math.round(width), Math.round(height)];
    resized();
  });
  let isInside = false;
  const places = new IntersectionObserver((entries) => (isInside = entries.at(-1)?.isIntersecting ?? false));
  const state = {
    width: 0,
    height: 0,
    get isSeen() {
      return isInside || countsAll;
    },
    end(): void {
      sizes.disconnect();
      places.disconnect();
    },
  };
  sizes.observe(element);
  places.observe(element);
  return state;
}
