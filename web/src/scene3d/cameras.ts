// Cameras of the 3D picture: chase, top, cockpit and free, with smoothing from picture to picture.
import type { Line } from '../draw/line';
import { clamp, mix, wrapAngle } from '../lib/math';
import type { Vector } from './mesh';

/** Cameras of the 3D picture. */
export type CameraName = 'chase' | 'top' | 'cockpit' | 'free';

/** The cameras as they are offered. */
export const CAMERAS: readonly { value: CameraName; label: string; title: string }[] = [
  { value: 'chase', label: 'Chase', title: 'From behind the car' },
  { value: 'top', label: 'Top', title: 'From above, looking ahead' },
  { value: 'cockpit', label: 'Cockpit', title: "From the driver's eyes" },
  { value: 'free', label: 'Free', title: 'Round the car: drag, arrow keys, wheel' },
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

/** The free camera at first; chosen. */
export const DEFAULT_ORBIT: Orbit = { azimuth: 0.75, elevation: 0.3, zoom: 1 };

/** The orbit turned by angles [rad], above the ground and below the zenith. */
export const orbited = (orbit: Orbit, azimuth: number, elevation: number): Orbit => ({
  ...orbit,
  azimuth: wrapAngle(orbit.azimuth + azimuth),
  elevation: clamp(orbit.elevation + elevation, 0.04, 1.5),
});

/** The orbit with its distance multiplied, within bounds that keep the car in sight. */
export const zoomedOrbit = (orbit: Orbit, factor: number): Orbit => ({
  ...orbit,
  zoom: clamp(orbit.zoom * factor, 0.3, 6),
});

/** The vertical field of view [rad]: that of a wide picture, more on tall ones so that the width is kept. */
const lens = (wide: number, aspect: number): number =>
  aspect >= 1.2 ? wide : 2 * Math.atan(Math.tan(wide / 2) * Math.min(1.7, 1.2 / aspect));

/** Shape and content of a picture, which decide where a camera stands. */
export interface Lens {
  readonly aspect: number; // width by height
  /** The points of the plan, in W [m]: the views from behind and from above hold all of them. */
  readonly plan: Line | null;
  readonly orbit: Orbit;
  readonly isCut: boolean; // no gliding, for readers who prefer reduced motion
}

/** A place of the camera behind the car: turned about the car [rad], at a multiple of the usual distance. */
interface Stand {
  readonly turn: number;
  readonly far: number;
}

/** The usual stand, straight behind the car. */
const STRAIGHT: Stand = { turn: 0, far: 1 };
/** Shares of half the picture's width, and from above of half its height, in which the plan stays; chosen. */
const MARGIN = 0.84;
const TOP_MARGIN = 0.65; // less: the camera's name stands in the corner
/** Multiples of the usual distance that are tried behind the car, and that distance in lengths of the car; chosen. */
const FAR = [1, 1.3, 1.7, 2.2, 3];
const BACK = 1.62;
/** Time constants of the smoothed heading, from above and otherwise, and of the smoothed speed [s]; chosen. */
const TURN_S = { top: 0.35, other: 0.22 } as const;
const SPEED_S = 0.6;

/** The way from one stand to another, by a share of it. */
const between = (from: Stand, to: Stand, share: number): Stand => ({
  turn: mix(from.turn, to.turn, share),
  far: mix(from.far, to.far, share),
});

/**
 * Follows the car; heading and speed are smoothed, so that the view turns with corners and not with every bump.
 */
export class CameraMan {
  #heading = NaN; // smoothed [rad]; not-a-number: the next view is a cut
  #speed = NaN; // smoothed [m/s]
  #stand = STRAIGHT; // behind the car, in the last view

  /** The next view is a cut: no smoothing from the previous one. */
  cut(): void {
    this.#heading = NaN;
  }

  /** The view `seconds` after the last one. */
  shoot(name: CameraName, car: Subject, lens: Lens, seconds: number): Shot {
    const isFirst = Number.isNaN(this.#heading);
    const share = isFirst || lens.isCut ? 1 : 1 - Math.exp(-seconds / TURN_S[name === 'top' ? 'top' : 'other']);
    const from = isFirst ? car.yaw : this.#heading;
    this.#heading = wrapAngle(from + wrapAngle(car.yaw - from) * share);
    const before = Number.isNaN(this.#speed) ? car.speed : this.#speed;
    this.#speed = mix(before, car.speed, 1 - Math.exp(-seconds / SPEED_S));
    if (name === 'chase') return this.#chase(car, lens, share);
    if (name === 'top') return this.#top(car, lens);
    return name === 'cockpit' ? this.#cockpit(car, lens) : this.#free(car, lens);
  }

  /** From behind the car; aside or farther away where the plan would leave the picture. */
  #chase(car: Subject, { aspect, plan, orbit: { zoom }, isCut }: Lens, share: number): Shot {
    const widening = isCut ? 0 : 0.14 * clamp(this.#speed / 50, 0, 1);
    const fieldOfView = lens(0.92 + widening, aspect);
    const holds = ({ turn, far }: Stand): boolean => {
      const [cos, sin] = [Math.cos(this.#heading + turn), Math.sin(this.#heading + turn)];
      const half = MARGIN * Math.tan(fieldOfView / 2) * aspect;
      for (let i = 0; i < (plan?.x.length ?? 0); ++i) {
        const [dx, dy] = [(plan?.x[i] ?? NaN) - car.x, (plan?.y[i] ?? NaN) - car.y];
        const ahead = cos * dx + sin * dy + BACK * car.length * zoom * far;
        if (Math.abs(cos * dy - sin * dx) > half * ahead) return false;
      }
      return true;
    };
    const wanted = this.#standFor(car, plan, holds);
    // On the way to it the plan stays inside, too.
    const glided = [share, 0.4, 0.6, 0.8]
      .filter((each) => each >= share)
      .map((each) => between(this.#stand, wanted, each));
    this.#stand = (isCut ? null : glided.find(holds)) ?? wanted;
    const { turn, far } = this.#stand;
    const [cos, sin] = [Math.cos(this.#heading + turn), Math.sin(this.#heading + turn)];
    const [back, ahead] = [BACK * car.length * zoom * far, 1.5 * car.length * far];
    return {
      position: [car.x - back * cos, car.y - back * sin, 0.62 * car.length * zoom ** 1.15 * far],
      target: [car.x + ahead * cos, car.y + ahead * sin, 0.1 * car.length * far],
      up: [0, 0, 1],
      fieldOfView,
    };
  }

  /** The nearest and straightest stand that holds the plan; the farthest where none does. */
  #standFor(car: Subject, plan: Lens['plan'], holds: (stand: Stand) => boolean): Stand {
    const last = (plan?.x.length ?? 0) - 1;
    if (!plan || last < 0) return STRAIGHT;
    const [dx, dy] = [(plan.x[last] ?? NaN) - car.x, (plan.y[last] ?? NaN) - car.y];
    const off = Math.hypot(dx, dy) > 1e-6 ? wrapAngle(Math.atan2(dy, dx) - this.#heading) : 0;
    for (const far of FAR)
      for (let part = 0; part <= 1; part += 0.1) if (holds({ turn: part * off, far })) return { turn: part * off, far };
    return { turn: off, far: FAR.at(-1) ?? 1 };
  }

  /** From above, as high as the plan needs, with the car below the middle. */
  #top(car: Subject, { aspect, plan, orbit: { zoom } }: Lens): Shot {
    const [cos, sin] = [Math.cos(this.#heading), Math.sin(this.#heading)];
    const fieldOfView = lens(0.75, aspect);
    const half = Math.tan(fieldOfView / 2);
    let [least, most, aside] = [0, 0, 0];
    for (let i = 0; i < (plan?.x.length ?? 0); ++i) {
      const [dx, dy] = [(plan?.x[i] ?? NaN) - car.x, (plan?.y[i] ?? NaN) - car.y];
      const ahead = cos * dx + sin * dy;
      [least, most] = [Math.min(least, ahead), Math.max(most, ahead)];
      aside = Math.max(aside, Math.abs(cos * dy - sin * dx));
    }
    const reach = TOP_MARGIN * half; // by the height
    const height = Math.max(16 * car.length * zoom, (most - least) / (2 * reach), aside / (MARGIN * half * aspect));
    const shift = clamp(0.2 * height, most - reach * height, least + reach * height);
    return {
      position: [car.x + shift * cos, car.y + shift * sin, height],
      target: [car.x + shift * cos, car.y + shift * sin, 0],
      up: [cos, sin, 0],
      fieldOfView,
    };
  }

  /** From the driver's eyes, fixed to the car. */
  #cockpit(car: Subject, { aspect, orbit: { zoom } }: Lens): Shot {
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

  /** Round the car, as the user has set it. */
  #free(car: Subject, { aspect, orbit: { azimuth, elevation, zoom } }: Lens): Shot {
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
