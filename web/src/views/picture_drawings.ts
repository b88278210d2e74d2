const drawings = new Set<() => void>();

/** Registers `draw` for pictures of the page, which include canvases that are scrolled away. Returns its removal. */
export function registerDrawing(draw: () => void): () => void {
  drawings.add(draw);
  return () => void drawings.delete(draw);
}

/**
 * Draws all registered canvases, including those scrolled away, which are not repainted otherwise. Resolves after a
 * microtask, in which uPlot draws.
 */
export async function drawAll(): Promise<void> {
  for (const draw of drawings) draw();
  await Promise.resolve();
}
