// Meshes of a car: a body by its name, drawn in the dimensions of the car.
import type { CarSize } from '../draw/car';
import { addClosedBody, COUPE, type Profile, SALOON, VAN } from './closed_body';
import { type Colour, MeshBuilder, type MeshData, mirroredRing, onSide, plate, type Vector } from './mesh';
import { addModelCar } from './model_car';
import { ACCENT, CARBON, LAMP, LIGHT, METAL, type Measures, type Parts, RUBBER, SOOT, WHITE } from './parts';

/** The parts of a car in its own axes: x forward, y left, z up from the road, origin at the centre of mass [m]. */
export interface CarModel {
  readonly paint: MeshData; // glossy
  readonly dark: MeshData; // carbon, rubber, cloth
  readonly lamps: MeshData; // red, lit when braking
  readonly headlamps: MeshData;
  readonly helmet: MeshData; // the driver's; hidden in the cockpit view
  readonly hand: MeshData; // the steering wheel, about its own centre; it turns about its x axis
  readonly wheel: MeshData; // about its hub, axis along y, outer side to the left
  readonly wheelRadius: number;
  readonly steeringWheel: Vector; // its centre
  readonly eye: Vector; // of the driver
  readonly length: number;
  readonly width: number;
}

/** Half of a section across the car: y and z from bottom to top. */
type Half = readonly (readonly [number, number])[];

/** Half of a section with cut corners: `half` wide, from `low` to `high`. */
function section(half: number, low: number, high: number, cut = 0.35): Half {
  const c = cut * Math.min(half, high - low);
  return [
    [half - c * 0.7, low],
    [half, low + c],
    [half, high - c],
    [half - c, high],
  ];
}

/** A wheel about its hub: tyre, rim and ten spokes. */
function wheelMesh(radius: number, width: number): MeshData {
  const mesh = new MeshBuilder();
  const SIDES = 24;
  const half = width / 2;
  const point = (r: number, y: number, k: number): Vector => {
    const angle = (-2 * Math.PI * k) / SIDES;
    return [r * Math.sin(angle), y, r * Math.cos(angle)];
  };
  // From the tread inwards on either side: rings of (radius, y).
  const profile: readonly (readonly [number, number, Colour])[] = [
    [0.94, -half, RUBBER],
    [1, -half * 0.7, RUBBER],
    [1, half * 0.7, RUBBER],
    [0.94, half, RUBBER],
    [0.7, half, RUBBER],
    [0.66, half * 0.8, METAL],
  ];
  for (let k = 0; k < SIDES; ++k) {
    for (let i = 0; i + 1 < profile.length; ++i) {
      const [[r, y], [q, z, colour]] = [
        profile[i] as (typeof profile)[number],
        profile[i + 1] as (typeof profile)[number],
      ];
      mesh.quad(
        point(r * radius, y, k),
        point(q * radius, z, k),
        point(q * radius, z, k + 1),
        point(r * radius, y, k + 1),
        colour,
      );
    }
    // Ten spokes outside, with the dark between them; a plain disc inside.
    const isSpoke = k % 4 < 2;
    mesh.quad(
      point(0.66 * radius, half * (isSpoke ? 0.8 : 0.3), k),
      point(0.16 * radius, half * (isSpoke ? 0.9 : 0.3), k),
      point(0.16 * radius, half * (isSpoke ? 0.9 : 0.3), k + 1),
      point(0.66 * radius, half * (isSpoke ? 0.8 : 0.3), k + 1),
      isSpoke ? METAL : SOOT,
    );
    mesh.triangle(
      point(0.16 * radius, half * 0.9, k),
      [0, half * 0.9, 0],
      point(0.16 * radius, half * 0.9, k + 1),
      CARBON,
    );
    mesh.triangle([0, -half, 0], point(0.94 * radius, -half, k), point(0.94 * radius, -half, k + 1), SOOT);
  }
  return mesh.data();
}

/** The steering wheel: a rim with three spokes, about its own centre in the plane normal to x. */
function handMesh(k: number): MeshData {
  const mesh = new MeshBuilder();
  const [radius, thick] = [0.135 * k, 0.026 * k];
  const at = (angle: number): Vector => [0, radius * 1.1 * Math.sin(angle), radius * 0.85 * Math.cos(angle)];
  const SIDES = 16;
  for (let i = 0; i < SIDES; ++i) {
    const angle = (2 * Math.PI * i) / SIDES;
    mesh.rod(at(angle), at(angle + (2 * Math.PI) / SIDES), thick, i === 0 || i === SIDES - 1 ? ACCENT : SOOT);
  }
  for (const angle of [Math.PI / 2, -Math.PI / 2, Math.PI]) mesh.rod([0, 0, 0], at(angle), thick * 0.9, CARBON);
  mesh.box([-0.02 * k, -0.06 * k, -0.04 * k], [0.02 * k, 0.06 * k, 0.04 * k], CARBON);
  return mesh.data();
}

/** The driver's helmet with a visor. */
function helmetMesh(centre: Vector, radius: number): MeshData {
  const mesh = new MeshBuilder();
  const [ROWS, SIDES] = [6, 12];
  const point = (row: number, side: number): Vector => {
    const [v, u] = [(Math.PI * row) / ROWS, (2 * Math.PI * side) / SIDES];
    return [
      centre[0] + radius * 1.1 * Math.sin(v) * Math.cos(u),
      centre[1] + radius * Math.sin(v) * Math.sin(u),
      centre[2] + radius * Math.cos(v),
    ];
  };
  for (let row = 0; row < ROWS; ++row) {
    for (let side = 0; side < SIDES; ++side) {
      const isVisor = row === 2 && (side < 3 || side > 8);
      const colour = isVisor ? SOOT : row === 0 || row === 1 ? ACCENT : WHITE;
      mesh.quad(point(row, side), point(row + 1, side), point(row + 1, side + 1), point(row, side + 1), colour);
    }
  }
  return mesh.data();
}

/** The dimensions of a car that its parts are built from. */
function measure(size: CarSize, isClosed: boolean): Measures {
  const wheelbase = size.front_axle_m + size.rear_axle_m;
  const length = Math.max(size.body_length_m, wheelbase * 1.15);
  const k = length / 4.5; // drawn for a car of 4.5 m
  const overhang = (length - wheelbase) / 2;
  const [front, rear] = [size.front_axle_m, -size.rear_axle_m];
  const [nose, tail] = [front + overhang, rear - overhang];
  const radius = Math.min(0.33 * k, 0.16 * wheelbase);
  const tyre = isClosed ? size.tire_width_m : Math.max(size.tire_width_m, 0.24 * k);
  const halfTrack = size.track_width_m / 2;
  const halfWidth = Math.max(size.body_width_m, size.track_width_m + tyre) / 2;
  const inner = Math.max(halfTrack - tyre / 2 - 0.16 * k, 0.3 * k); // half the room between the wheels
  const at = (share: number): number => rear + share * wheelbase; // 0 rear axle, 1 front axle
  const tub = Math.min(0.36 * k, inner);
  const pod = Math.min(halfWidth - 0.1 * k, Math.max(halfTrack - 0.08 * k, tub + 0.1));
  return { k, front, rear, nose, tail, radius, tyre, halfTrack, halfWidth, inner, tub, pod, length, at };
}

/** Adds the body of a single-seater from tail to nose, with seat, hoop and windscreen. */
function addTub({ paint, dark }: Parts, { k, front, rear, nose, tail, tub, at }: Measures): void {
  const stations: readonly (readonly [x: number, half: number, low: number, high: number])[] = [
    [tail + 0.12 * k, 0.16 * k, 0.3 * k, 0.46 * k],
    [rear, 0.24 * k, 0.16 * k, 0.6 * k],
    [at(0.2), tub * 0.9, 0.1 * k, 0.76 * k],
    [at(0.34), tub, 0.1 * k, 0.9 * k],
    [at(0.37), tub, 0.1 * k, 0.66 * k],
    [at(0.6), tub, 0.1 * k, 0.62 * k],
    [at(0.66), tub * 0.96, 0.1 * k, 0.66 * k],
    [at(0.86), tub * 0.74, 0.14 * k, 0.58 * k],
    [front, tub * 0.6, 0.17 * k, 0.51 * k],
    [nose - 0.3 * k, 0.16 * k, 0.2 * k, 0.4 * k],
    [nose, 0.1 * k, 0.22 * k, 0.3 * k],
  ];
  const rings = stations.map(([x, half, low, high]) => mirroredRing(x, section(half, low, high)));
  paint.loft(rings, (x, face) => (face === 3 && x > at(0.66) ? ACCENT : face === 7 ? CARBON : WHITE));

  // The seat: a dark opening with its rim, and the hoop with its intake behind the head.
  const [wide, narrow, high] = [tub * 0.72, tub * 0.58, 0.665 * k];
  dark.quad(
    [at(0.375), -wide, high],
    [at(0.625), -narrow, high],
    [at(0.625), narrow, high],
    [at(0.375), wide, high],
    SOOT,
  );
  for (const side of [-1, 1]) {
    paint.rod([at(0.37), side * tub * 0.9, 0.68 * k], [at(0.62), side * tub * 0.8, 0.64 * k], 0.055 * k, WHITE);
  }
  dark.loft(
    [
      mirroredRing(at(0.3), section(0.13 * k, 0.84 * k, 1.0 * k)),
      mirroredRing(at(0.345), section(0.12 * k, 0.84 * k, 1.02 * k)),
    ],
    SOOT,
  );
  paint.loft(
    [
      mirroredRing(at(0.06), section(0.03 * k, 0.62 * k, 0.72 * k)),
      mirroredRing(at(0.2), section(0.09 * k, 0.7 * k, 0.92 * k)),
      mirroredRing(at(0.31), section(0.15 * k, 0.8 * k, 1.03 * k)),
    ],
    ACCENT,
  );
  // Windscreen: a low dark wedge.
  dark.loft(
    [
      mirroredRing(at(0.6), section(tub * 0.66, 0.6 * k, 0.75 * k)),
      mirroredRing(at(0.71), section(tub * 0.6, 0.6 * k, 0.64 * k)),
    ],
    CARBON,
  );
}

/** Adds side pods with their intakes, mirrors, and the floor. */
function addPods({ paint, dark }: Parts, { k, inner, tub, pod, at }: Measures): void {
  for (const side of [-1, 1]) {
    const ring = (x: number, from: number, to: number, low: number, high: number) =>
      onSide(side, [
        [x, from, low],
        [x, to - 0.06 * k, low],
        [x, to, low + 0.08 * k],
        [x, to, high - 0.09 * k],
        [x, to - 0.12 * k, high],
        [x, from, high],
      ]);
    paint.loft(
      [
        ring(at(0.1), tub * 0.5, tub * 0.95, 0.12 * k, 0.4 * k),
        ring(at(0.28), tub * 0.5, pod * 0.9, 0.1 * k, 0.5 * k),
        ring(at(0.52), tub * 0.5, pod, 0.1 * k, 0.54 * k),
        ring(at(0.62), tub * 0.5, pod * 0.97, 0.14 * k, 0.5 * k),
      ],
      (_x, face) => (face === (side > 0 ? 3 : 1) ? ACCENT : face === (side > 0 ? 0 : 4) ? CARBON : WHITE),
    );
    dark.loft(
      [
        ring(at(0.615), tub * 0.9, pod * 0.9, 0.2 * k, 0.46 * k),
        ring(at(0.627), tub * 0.9, pod * 0.88, 0.22 * k, 0.44 * k),
      ],
      SOOT,
    );
    // Mirrors.
    dark.rod([at(0.68), side * tub * 0.9, 0.6 * k], [at(0.705), side * (tub + 0.24 * k), 0.69 * k], 0.018 * k, CARBON);
    const [m0, m1] = [side * (tub + 0.2 * k), side * (tub + 0.33 * k)];
    dark.box([at(0.7), m0, 0.68 * k], [at(0.715), m1, 0.725 * k], CARBON);
  }
  dark.box([at(0.02), -pod * 0.98, 0.075 * k], [at(0.72), pod * 0.98, 0.1 * k], CARBON);
  dark.box([at(-0.1), -inner, 0.1 * k], [at(0.1), inner, 0.14 * k], CARBON);
}

/** Adds the front wing in two planes with end plates, the rear wing on its plates, and the lamps. */
function addWings({ paint, dark, lamps, headlamps }: Parts, { k, rear, nose, tail, halfWidth, inner }: Measures): void {
  const wing = halfWidth - 0.02 * k;
  const slanted = (x0: number, x1: number, z0: number, z1: number, half: number): Vector[][] => [
    plate(x0, half, z0, z0 + 0.025 * k),
    plate(x1, half, z1, z1 + 0.02 * k),
  ];
  paint.loft(slanted(nose - 0.34 * k, nose - 0.04 * k, 0.15 * k, 0.11 * k, wing), WHITE);
  paint.loft(slanted(nose - 0.46 * k, nose - 0.28 * k, 0.24 * k, 0.17 * k, wing), ACCENT);
  dark.rod([nose - 0.2 * k, 0.09 * k, 0.24 * k], [nose - 0.2 * k, 0.1 * k, 0.12 * k], 0.04 * k, CARBON);
  dark.rod([nose - 0.2 * k, -0.09 * k, 0.24 * k], [nose - 0.2 * k, -0.1 * k, 0.12 * k], 0.04 * k, CARBON);
  // Rear wing on its plates.
  const back = Math.min(inner + 0.18 * k, halfWidth);
  paint.loft(slanted(tail + 0.02 * k, tail + 0.34 * k, 0.9 * k, 0.84 * k, back), ACCENT);
  paint.loft(slanted(tail - 0.06 * k, tail + 0.1 * k, 0.99 * k, 0.93 * k, back), WHITE);
  for (const side of [-1, 1]) {
    const [a, b] = [side * wing, side * (wing + 0.025 * k)];
    paint.box([nose - 0.48 * k, a, 0.1 * k], [nose - 0.02 * k, b, 0.28 * k], ACCENT);
    const [c, d] = [side * back, side * (back + 0.025 * k)];
    paint.box([tail - 0.1 * k, c, 0.5 * k], [tail + 0.36 * k, d, 1.04 * k], WHITE);
    dark.rod([rear, side * 0.1 * k, 0.56 * k], [tail + 0.2 * k, side * 0.12 * k, 0.88 * k], 0.035 * k, CARBON);
    const [e, f] = [side * (back - 0.1 * k), side * (back - 0.3 * k)];
    lamps.box([tail - 0.005, e, 0.915 * k], [tail + 0.05 * k, f, 0.955 * k], LAMP);
  }
  lamps.box([tail + 0.08 * k, -0.07 * k, 0.34 * k], [tail + 0.13 * k, 0.07 * k, 0.42 * k], LAMP);
  for (const side of [-1, 1]) {
    const y = side * 0.115 * k;
    headlamps.box([nose - 0.26 * k, y - 0.03 * k, 0.31 * k], [nose - 0.2 * k, y + 0.03 * k, 0.35 * k], LIGHT);
  }
}

/** Adds wishbones from the tub to the hubs. */
function addWishbones({ dark }: Parts, { k, front, rear, radius, tyre, halfTrack, tub }: Measures): void {
  for (const side of [-1, 1]) {
    const y = side * (halfTrack - tyre / 2);
    for (const [x, root] of [
      [front, tub * 0.55],
      [rear, 0.22 * k],
    ] as const) {
      for (const lean of [-0.26, 0.26]) {
        dark.rod([x + lean * k, side * root, radius + 0.12 * k], [x, y, radius + 0.08 * k], 0.035 * k, CARBON);
        dark.rod([x + lean * k, side * root, radius - 0.12 * k], [x, y, radius - 0.1 * k], 0.035 * k, CARBON);
      }
    }
  }
}

/** Adds what only an Indy car has: the screen round its driver, and a fin along its engine. */
function addScreenAndFin({ paint, dark }: Parts, { k, rear, tub, at }: Measures): void {
  const frame = 0.05 * k;
  for (const side of [-1, 1]) {
    dark.rod([at(0.37), side * tub * 0.86, 0.7 * k], [at(0.36), side * tub * 0.7, 0.98 * k], frame, SOOT);
    dark.rod([at(0.36), side * tub * 0.7, 0.98 * k], [at(0.52), side * tub * 0.66, 0.95 * k], frame, SOOT);
    dark.rod([at(0.52), side * tub * 0.66, 0.95 * k], [at(0.62), side * tub * 0.3, 0.92 * k], frame, SOOT);
    dark.rod([at(0.62), side * tub * 0.3, 0.92 * k], [at(0.64), 0, 0.91 * k], frame, SOOT);
  }
  dark.rod([at(0.64), 0, 0.91 * k], [at(0.74), 0, 0.64 * k], frame, SOOT);
  const fin = (x: number, low: number, high: number): Vector[] => plate(x, 0.012 * k, low * k, high * k);
  paint.loft([fin(rear - 0.1 * k, 0.56, 0.86), fin(at(0.16), 0.7, 1.02), fin(at(0.3), 0.84, 1.03)], ACCENT);
}

/** Kind of a body; a profile is one with a roof. */
type Body = 'formula' | 'indy' | 'model' | Profile;

/** The shape of each shipped car. */
const BODIES: Readonly<Record<string, Body>> = {
  'road-car': SALOON,
  'bmw-320i': SALOON,
  'vw-vanagon': VAN,
  udacity: COUPE,
  'tum-1200': COUPE,
  'orca-1-43': COUPE,
  indy: 'indy',
  f1tenth: 'model',
};
/** Length below which a car of another name is a model car [m]; chosen. */
const SMALL_M = 1;

/** Body of a car by its name, else by its length. */
const bodyOf = ({ car = '', body_length_m: length }: CarLooks): Body =>
  BODIES[car] ?? (length < SMALL_M ? 'model' : 'formula');

/** Dimensions and name of a car, from which its shape follows. */
export type CarLooks = CarSize & { readonly car?: string };

/**
 * Six bodies: saloon, van, coupé, Indy car, model car, and for all others an open single-seater, whose front wheels are
 * visible from every camera. Axles, track, tyres, length and width are taken from the car; the rest is invented.
 */
export function carModel(size: CarLooks): CarModel {
  const body = bodyOf(size);
  const isClosed = typeof body === 'object';
  const measures = measure(size, isClosed);
  const { k, radius, tyre, halfWidth, length, at } = measures;
  const parts: Parts = {
    paint: new MeshBuilder(),
    dark: new MeshBuilder(),
    lamps: new MeshBuilder(),
    headlamps: new MeshBuilder(),
  };
  let place = { eye: [at(0.41), 0, 0.97 * k] as Vector, steeringWheel: [at(0.6), 0, 0.66 * k] as Vector };
  if (isClosed) {
    place = addClosedBody(parts, measures, body);
  } else if (body === 'model') {
    place = addModelCar(parts, measures);
    addWishbones(parts, measures);
  } else {
    for (const add of [addTub, addPods, addWings, addWishbones]) add(parts, measures);
    if (body === 'indy') addScreenAndFin(parts, measures);
  }
  const { eye, steeringWheel } = place;
  const nobody = new MeshBuilder().data();
  const driver = isClosed ? helmetMesh(eye, 0.11 * k) : helmetMesh([at(0.425), 0, 0.82 * k], 0.14 * k);
  return {
    paint: parts.paint.data(),
    dark: parts.dark.data(),
    lamps: parts.lamps.data(),
    headlamps: parts.headlamps.data(),
    helmet: body === 'model' ? nobody : driver,
    hand: body === 'model' ? nobody : handMesh(k),
    wheel: wheelMesh(radius, tyre),
    wheelRadius: radius,
    steeringWheel,
    eye,
    length,
    width: 2 * halfWidth,
  };
}
