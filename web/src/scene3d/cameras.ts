import { clamp, wrapAngle } from '../lib/math';
import type { Vector } from './mesh';

export type CameraName = 'chase' | 'top' | 'cockpit' | 'free';

export const CAMERAS: readonly { view: CameraName; label: string; title: string }[] = [
  { view: 'chase', label: 'Chase', title: 'From behind the car (C)' },
  { view: 'top', label: 'Top', title: 'From above, looking ahead (C)' },
  { view: 'cockpit', label: 'Cockpit', title: "From the driver's eyes (C)" },
  { view: 'free', label: 'Free', title: 'Round the car: drag, arrow keys, wheel (C)' },
];

/** Position and target of a camera in W; `up` is the picture's upward direction. */
export interface Shot {
  readonly position: Vector;
  readonly target: Vector;
  readonly up: Vector;
  readonly fieldOfView: number; // vertical [rad]
}

/** What a camera needs of the car; in W [m]. */
export interface Subject {
  readonly x: number;
  readonly y: number;
  readonly yaw: number;
  readonly speed: number;
  readonly length: number; // of the car: the camera is closer to small cars
  readonly eye: Vector; // of the driver, in the car's axes
}

/** Position of the free camera, as set by the user. */
export interface Orbit {
  azimuth: number; // 0 straight behind the car, counter-clockwise seen from above [rad]
  elevation: number; // above the ground [rad]
  zoom: number; // distance factor: 1 is the default
}

export const DEFAULT_ORBIT: Orbit = { azimuth: 0.75, elevation: 0.3, zoom: 1 };

export const orbited = (orbit: Orbit, azimuth: number, elevation: number): Orbit => ({
  ...orbit,
  azimuth: wrapAngle(orbit.azimuth + azimuth),
  elevation: clamp(orbit.elevation + elevation, 0.04, 1.5),
});

export const zoomedOrbit = (orbit: Orbit, factor: number): Orbit => ({
  ...orbit,
  zoom: clamp(orbit.zoom * factor, 0.3, 6),
});

/** The vertical field of view, wider on tall screens so that the width is kept. */
const lens = (wide: number, aspect: number): number =>
  aspect >= 1.2 ? wide : 2 * Math.atan(Math.tan(wide / 2) * Math.min(1.7, 1.2 / aspect));

/**
 * Follows the car; heading and speed are smoothed, so that the view turns with corners and not with every bump.
 */
export class CameraMan {
  #heading = NaN;
  #speed = NaN;

  /** The next view is a cut: no smoothing from the previous one. */
  cut(): void {
    this.#heading = NaN;
  }

  /**
   * The view `seconds` after the last one. With `hasReducedMotion` there is neither smoothing nor a change of the field
   * of view.
   */
  shoot(
    name: CameraName,
    car: Subject,
    orbit: Orbit,
    aspect: number,
    seconds: number,
    hasReducedMotion: boolean,
  ): Shot {
    const share =
      Number.isNaN(this.#heading) || hasReducedMotion ? 1 : 1 - Math.exp(-seconds / (name === 'top' ? 0.35 : 0.22));
    const from = Number.isNaN(this.#heading) ? car.yaw : this.#heading;
    this.#heading = wrapAngle(from + wrapAngle(car.yaw - from) * share);
    const slow = Number.isNaN(this.#speed) ? 1 : 1 - Math.exp(-seconds / 0.6);
    this.#speed =
      (Number.isNaN(this.#speed) ? car.speed : this.#speed) +
      (car.speed - (Number.isNaN(this.#speed) ? car.speed : this.#speed)) * slow;
    switch (name) {
      case 'chase':
        return this.#chase(car, orbit, aspect, hasReducedMotion);
      case 'top':
        return this.#top(car, orbit, aspect);
      case 'cockpit':
        return this.#cockpit(car, orbit, aspect);
      case 'free':
        return this.#free(car, orbit, aspect);
    }
  }

  #chase(car: Subject, { zoom }: Orbit, aspect: number, hasReducedMotion: boolean): Shot {
    const [cos, sin] = [Math.cos(this.#heading), Math.sin(this.#heading)];
    const back = 1.62 * car.length * zoom;
    const ahead = 1.5 * car.length;
    const widening = hasReducedMotion ? 0 : 0.14 * clamp(this.#speed / 50, 0, 1);
    return {
      position: [car.x - back * cos, car.y - back * sin, 0.62 * car.length * zoom ** 1.15],
      target: [car.x + ahead * cos, car.y + ahead * sin, 0.1 * car.length],
      up: [0, 0, 1],
      fieldOfView: lens(0.92 + widening, aspect),
    };
  }

  #top(car: Subject, { zoom }: Orbit, aspect: number): Shot {
    const [cos, sin] = [Math.cos(this.#heading), Math.sin(this.#heading)];
    const height = 16 * car.length * zoom;
    const shift = 0.2 * height;
    return {
      position: [car.x + shift * cos, car.y + shift * sin, height],
      target: [car.x + shift * cos, car.y + shift * sin, 0],
      up: [cos, sin, 0],
      fieldOfView: lens(0.75, aspect),
    };
  }

  #cockpit(car: Subject, { zoom }: Orbit, aspect: number): Shot {
    const [cos, sin] = [Math.cos(car.yaw), Math.sin(car.yaw)];
    const place = (x: number, y: number, z: number): Vector => [
      car.x + x * cos - y * sin,
      car.y + x * sin + y * cos,
      z,
    ];
    const [x, y, z] = car.eye;
    return {
      position: place(x, y, z),
      target: place(x + 10, y, z - 0.9),
      up: [0, 0, 1],
      fieldOfView: lens(clamp(1.05 * zoom, 0.5, 1.5), aspect),
    };
  }

  #free(car: Subject, { azimuth, elevation, zoom }: Orbit, aspect: number): Shot {
    const angle = this.#heading + Math.PI + azimuth;
    const distance = 2.1 * car.length * zoom;
    const flat = distance * Math.cos(elevation);
    const height = 0.12 * car.length;
    return {
      position: [
        car.x + flat * Math.cos(angle),
        car.y + flat * Math.sin(angle),
        height + distance * Math.sin(elevation),
      ],
      target: [car.x, car.y, height],
      up: [0, 0, 1],
      fieldOfView: lens(0.85, aspect),
    };
  }
}
