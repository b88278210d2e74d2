// Mouse, touch and arrow keys that move the camera of the 3D picture.
import { live } from '../state/live';
import { orbited } from './cameras';
import { camera, choose, orbit, zoomCamera } from './view_state';

/** Turns of the camera for a pixel and for a press of a key [rad], and logarithm of its zoom for a pixel; chosen. */
const TURN = 0.007;
const KEY_TURN = 0.09;
const ZOOM_PER_PIXEL = 0.0015;

/** Turns of the arrow keys: azimuth and elevation [rad]. */
const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [KEY_TURN, 0],
  ArrowRight: [-KEY_TURN, 0],
  ArrowUp: [0, KEY_TURN],
  ArrowDown: [0, -KEY_TURN],
};

/** Lets drag, pinch, wheel and arrow keys move the camera; returns a function that ends it. */
export function listenToPointers(canvas: HTMLCanvasElement): () => void {
  const down = new Map<number, { x: number; y: number }>();

  const spread = (): number => {
    const [a, b] = [...down.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };

  const begin = (event: PointerEvent): void => {
    if (event.pointerType === 'mouse' && event.button !== 0) return;
    // Touch scrolls the page unless the camera is free; a mouse always moves the camera.
    if (event.pointerType !== 'mouse' && camera.value !== 'free') return;
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  };
  const move = (event: PointerEvent): void => {
    const last = down.get(event.pointerId);
    if (!last) return;
    const before = spread();
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (down.size === 2) {
      const after = spread();
      if (before > 0 && after > 0) zoomCamera(before / after);
      return;
    }
    if (camera.value !== 'free') {
      // Starts from the present position of the camera, behind the car.
      orbit.value = { ...orbit.value, azimuth: 0, elevation: 0.3 };
      choose('free');
    }
    orbit.value = orbited(orbit.value, -dx * TURN, dy * TURN);
  };
  const end = (event: PointerEvent): void => void down.delete(event.pointerId);
  const wheel = (event: WheelEvent): void => {
    if (event.ctrlKey) return; // the browser's own zoom
    event.preventDefault();
    zoomCamera(Math.exp(event.deltaY * ZOOM_PER_PIXEL));
  };
  const key = (event: KeyboardEvent): void => {
    const turn = ARROWS[event.key];
    // While driving by hand the arrow keys steer the car.
    if (!turn || camera.value !== 'free' || live.frame?.is_manual || event.ctrlKey || event.metaKey || event.altKey)
      return;
    event.preventDefault();
    event.stopPropagation();
    orbit.value = orbited(orbit.value, turn[0], turn[1]);
  };

  const over = new AbortController();
  const { signal } = over;
  canvas.addEventListener('pointerdown', begin, { signal });
  canvas.addEventListener('pointermove', move, { signal });
  canvas.addEventListener('pointerup', end, { signal });
  canvas.addEventListener('pointercancel', end, { signal });
  canvas.addEventListener('wheel', wheel, { passive: false, signal });
  canvas.addEventListener('keydown', key, { signal });
  return () => over.abort();
}
