import type { GhostSource } from '../scene3d/ghost';

/** Another drive that is shown as the ghost; null shows the best lap. Plain data for the drawing loop. */
export const ghostShown = { source: null as GhostSource | null };
