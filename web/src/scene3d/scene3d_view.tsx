// Canvas of the 3D picture: loads its code, draws at every repaint, and explains why there is none.
import { useEffect, useRef } from 'preact/hooks';
import { onThemeChange } from '../draw/theme';
import { everyFrame } from '../state/ticker';
import { listenToPointers } from './pointer';
import { renderer } from './renderer';
import { session } from './session';
import type { Stage } from './stage';
import { viewNow } from './view';
import { camera3d, isReady, obstacle, shows3d } from './view_state';

/** Draws on the canvas until the returned function is called; loads the 3D code first. Sets `obstacle` on failure. */
function play(canvas: HTMLCanvasElement): () => void {
  const ends: (() => void)[] = [];
  let isOver = false;
  const stop = (): void => {
    isOver = true;
    isReady.value = false;
    for (const end of ends.splice(0).reverse()) end();
  };
  /** Ends the picture with the reason. */
  const give = (sentence: string): void => {
    if (isOver) return;
    stop();
    obstacle.value = sentence;
  };
  if (renderer() === 'none') {
    give('This browser offers no WebGL 2, so the track is drawn flat.');
    return stop;
  }
  const lost = (event: Event): void => {
    event.preventDefault();
    give('The browser stopped the 3D picture, so the track is drawn flat. Choose the camera to try again.');
  };
  import('./stage').then(
    ({ Stage: Made }) => {
      if (isOver) return;
      let stage: Stage;
      try {
        stage = new Made(canvas, session, renderer() === 'processor');
      } catch {
        return give('The 3D picture could not be set up, so the track is drawn flat.');
      }
      canvas.addEventListener('webglcontextlost', lost);
      ends.push(() => {
        canvas.removeEventListener('webglcontextlost', lost);
        stage.dispose();
      });
      const answer = (event: Event): void => void Object.assign(event, { geometry: stage.geometry() });
      canvas.addEventListener('geometry', answer); // asked by tests: is anything over the car or its plan?
      ends.push(() => canvas.removeEventListener('geometry', answer));
      ends.push(listenToPointers(canvas));
      ends.push(onThemeChange(() => stage.repaint()));
      ends.push(
        everyFrame((now) => {
          stage.paint(now, viewNow());
          if (stage.hasPicture && !isReady.value) isReady.value = true; // until then the map has the full size
        }),
      );
    },
    () => give('The 3D picture could not be loaded, so the track is drawn flat. Choose the camera to try again.'),
  );
  return stop;
}

/** The run in 3D; `label` describes the picture for screen readers. */
export function Scene3dView({ label }: { label: string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => (canvas.current ? play(canvas.current) : undefined), []);
  const isFree = camera3d.value === 'free';
  return (
    <canvas
      ref={canvas}
      class="map-3d cover"
      style={{
        touchAction: isFree ? 'none' : 'pan-y',
        cursor: 'grab',
        outlineOffset: '-3px', // of the focus: inside the picture
        visibility: shows3d.value ? 'visible' : 'hidden',
      }}
      role={isFree ? 'application' : 'img'}
      aria-label={isFree ? `${label}. Arrow keys turn the camera.` : label}
      {...(isFree ? { tabIndex: 0 } : {})}
    />
  );
}
