import { computed, signal } from '@preact/signals';
import { persisted } from '../lib/persisted';
import { CAMERAS, type CameraName, DEFAULT_ORBIT, type Orbit, zoomedOrbit } from './cameras';
import { renderer } from './renderer';

export type Dimension = '3d' | '2d';

const isChoice = (value: unknown): boolean => value === '3d' || value === '2d' || value === '';
const isCamera = (value: unknown): boolean => CAMERAS.some(({ view }) => view === value);

/** What the reader has chosen, nothing at first; outlives the page. */
const choice = persisted<Dimension | ''>('dimension', '', isChoice);

/** Three dimensions from the start where a graphics card draws them; elsewhere that costs what the car may need. */
export const dimension = computed<Dimension>(() => choice.value || (renderer() === 'processor' ? '2d' : '3d'));

/** The map is shown only because 3D would be dear here. */
export const isSpared = computed(() => choice.value === '' && dimension.value === '2d');

export const camera = persisted<CameraName>('camera', 'chase', isCamera);

/** Why there is no 3D picture, for people; null while nothing stands against it. */
export const obstacle = signal<string | null>(null);

/** The 3D picture is loaded and drawn. Until then, and without it, the map fills its place. */
export const isReady = signal(false);

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
  if (next === '3d') obstacle.value = null; // asked for again, tried again
  choice.value = next;
}
