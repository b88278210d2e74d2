import { computed } from '@preact/signals';
import { persisted } from '../lib/persisted';
import { store } from '../lib/store';
import { CAMERAS, type CameraName, DEFAULT_ORBIT, type Orbit, zoomedOrbit } from './cameras';
import { renderer } from './renderer';

export type Dimension = '3d' | '2d';

const isChoice = (value: unknown): boolean => value === '3d' || value === '2d' || value === '';
const isCamera = (value: unknown): boolean => CAMERAS.some(({ view }) => view === value);

/** The dimension chosen, empty at first; kept in the browser's storage. */
const choice = persisted<Dimension | ''>('dimension', '', isChoice);

/** 3D by default with a graphics card; without one it takes processor time that the controller may need. */
export const dimension = computed<Dimension>(() => choice.value || (renderer() === 'processor' ? '2d' : '3d'));

/** Whether the map is shown only because 3D would be expensive here. */
export const isSpared = computed(() => choice.value === '' && dimension.value === '2d');

export const camera = persisted<CameraName>('camera', 'chase', isCamera);

/** Why there is no 3D picture, as a sentence; null if it is available. */
export const obstacle = store.signal<string | null>('page', null);

/** Whether the 3D picture is loaded and drawn. Until then, and without it, the map has the full size. */
export const isReady = store.signal('page', false);

export const wants3d = computed(() => dimension.value === '3d' && obstacle.value === null);
export const shows3d = computed(() => wants3d.value && isReady.value);

export const orbit: { value: Orbit } = { value: DEFAULT_ORBIT };

export function nextCamera(): void {
  const at = CAMERAS.findIndex(({ view }) => view === camera.value);
  camera.value = CAMERAS[(at + 1) % CAMERAS.length]?.view ?? 'chase';
}

export function zoomCamera(factor: number): void {
  orbit.value = zoomedOrbit(orbit.value, factor);
}

export function choose(next: Dimension): void {
  if (next === '3d') obstacle.value = null; // try again
  choice.value = next;
}
