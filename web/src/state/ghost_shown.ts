import type { GhostSource } from '../scene3d/ghost';

/** Other drives that may be shown as the ghost, the first of them is. Plain data for the drawing loop. */
export const ghosts: Record<'race' | 'whatIf' | 'recording', GhostSource | null> = {
  race: null,
  whatIf: null,
  recording: null,
};

/** The drive that is shown as the ghost; null shows the best lap. */
export const ghostShown = (): GhostSource | null => ghosts.race ?? ghosts.whatIf ?? ghosts.recording;
