// Curves of all plots: through known points, with gaps where points are unknown.

/** What a curve is drawn with: a canvas, or the path of a picture. */
export interface Pen {
  moveTo(x: number, y: number): void;
  lineTo(x: number, y: number): void;
}

/** The stretches [first, end) of points that are known and follow one another. */
export function knownStretches(
  count: number,
  isKnown: (i: number) => boolean,
  isGapBefore: (i: number) => boolean = () => false,
): [number, number][] {
  const stretches: [number, number][] = [];
  for (let i = 0; i < count; ++i) {
    if (!isKnown(i)) continue;
    const last = stretches.at(-1);
    if (last?.[1] === i && !isGapBefore(i)) last[1] = i + 1;
    else stretches.push([i, i + 1]);
  }
  return stretches;
}

/** Draws a stretch; of points that share a pixel column, the first, the highest, the lowest and the last. */
export function drawStretch(
  pen: Pen,
  [first, end]: readonly [number, number],
  x: (i: number) => number,
  y: (i: number) => number,
): void {
  pen.moveTo(x(first), y(first));
  for (let i = first + 1; i < end; ) {
    const column = Math.floor(x(i));
    let [last, low, high] = [i, y(i), y(i)];
    for (; last + 1 < end && Math.floor(x(last + 1)) === column; ++last) {
      low = Math.min(low, y(last + 1));
      high = Math.max(high, y(last + 1));
    }
    pen.lineTo(x(i), y(i));
    if (last > i + 2) {
      pen.lineTo(x(i), low);
      pen.lineTo(x(i), high);
    } else if (last === i + 2) pen.lineTo(x(i + 1), y(i + 1));
    if (last > i) pen.lineTo(x(last), y(last));
    i = last + 1;
  }
}

/** The path of a curve in a picture. */
export function curvePath(count: number, x: (i: number) => number, y: (i: number) => number): string {
  let path = '';
  const add = (letter: string) => (px: number, py: number) => {
    path += `${letter}${px.toFixed(1)} ${py.toFixed(1)}`;
  };
  const pen = { moveTo: add('M'), lineTo: add('L') };
  for (const stretch of knownStretches(count, (i) => Number.isFinite(y(i)))) drawStretch(pen, stretch, x, y);
  return path;
}
