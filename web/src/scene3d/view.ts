// Content of the 3D picture at a moment.
import { cursorMark } from '../state/cursor';
import { hindsight } from '../state/hindsight';
import { layers } from '../state/layers';
import { limit } from '../state/limit';
import { link } from '../state/link';
import { live } from '../state/live';
import { road } from '../state/road';
import { isPaused, run } from '../state/run';
import { session } from './session';
import { camera3d, orbit } from './view_state';

/** The user's preference for little motion. */
const stillness = matchMedia('(prefers-reduced-motion: reduce)');

/** The content of the picture, read at every repaint. */
export const viewNow = () => ({
  session,
  run: run.value,
  road: road.lines,
  roadVersion: road.version,
  plan: live.plan,
  hindsight: layers.hindsight.value ? hindsight(live.pastPlans, live.plots, live.frame?.time_s ?? NaN) : null,
  racingLine: layers.racingLine.value ? limit.value : null,
  ghost: session.ghost,
  cursor: cursorMark(), // of the plots
  camera: camera3d.value ?? 'chase',
  orbit: orbit.value,
  isHeld: isPaused.value || link.value !== 'live',
  hasReducedMotion: stillness.matches, // preferred by the user
});
export type View = Readonly<ReturnType<typeof viewNow>>;
