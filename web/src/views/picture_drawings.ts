const drawings = new Set<() => void>();

/** Has `draw` called for a picture of the page, whether its canvas is scrolled away or not. Returns its end. */
export function drawnForPictures(draw: () => void): () => void {
  drawings.add(draw);
  return () => void drawings.delete(draw);
}

/**
 * Draws everything as it is now, also what is scrolled away and so stands still. Done at the next microtask, as uPlot
 * draws there.
 */
export async function drawAll(): Promise<void> {
  for (const draw of drawings) draw();
  await Promise.resolve();
}
