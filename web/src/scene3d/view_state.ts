// Choice of the camera, and whether the 3D picture can be shown.
import { computed } from '@preact/signals';
import { persisted } from '../lib/persisted';
import { store } from '../lib/store';
import { CAMERAS, type CameraName, DEFAULT_ORBIT, type Orbit, zoomedOrbit } from './cameras';
import { renderer } from './renderer';

/** Views from above that are drawn flat. */
export type FlatView = 'track' | 'ahead';
export type CameraChoice = CameraName | FlatView;

/** All cameras, in the order of the key that changes them. */
export const ALL_CAMERAS: readonly { value: CameraChoice; label: string; title: string }[] = [
  ...CAMERAS,
  { value: 'track', label: 'Track', title: 'The whole track, from above' },
  { value: 'ahead', label: 'Map', title: 'The road about the car, from above' },
];

const isCamera = (value: unknown): boolean => value === '' || ALL_CAMERAS.some((each) => each.value === value);

/** The camera chosen, empty at first; kept in the browser's storage. */
const chosen = persisted<CameraChoice | ''>('camera', '', isCamera);

/** From behind the car with a graphics card; without one that takes processor time which the controller may need. */
export const camera = computed<CameraChoice>(() => chosen.value || (renderer() === 'processor' ? 'track' : 'chase'));

/** Why there is no 3D picture, as a sentence; null if it is available. */
export const obstacle = store.signal<string | null>('page', null);

/** Whether the 3D picture is loaded and drawn. Until then, and without it, the track has the full size. */
export const isReady = store.signal('page', false);

/** The camera of the 3D picture; null where the picture is flat. */
export const camera3d = computed<CameraName | null>(
  () => CAMERAS.find(({ value }) => value === camera.value && obstacle.value === null)?.value ?? null,
);
/** Whether the 3D picture is shown. */
export const shows3d = computed(() => camera3d.value !== null && isReady.value);

/** Where the free camera is; plain data, read by the drawing loop. */
export const orbit: { value: Orbit } = { value: DEFAULT_ORBIT };

/** Chooses a camera. */
export function choose(next: CameraChoice): void {
  obstacle.value = null; // the 3D picture is tried again
  chosen.value = next;
}

/** Chooses the next camera. */
export function nextCamera(): void {
  const at = ALL_CAMERAS.findIndex(({ value }) => value === camera.value);
  choose(ALL_CAMERAS[(at + 1) % ALL_CAMERAS.length]?.value ?? 'chase');
}

/** Multiplies the distance of the 3D cameras. */
export function zoomCamera(factor: number): void {
  orbit.value = zoomedOrbit(orbit.value, factor);
}
