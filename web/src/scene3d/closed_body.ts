import { clamp, firstSince } from '../lib/math';
import { type Colour, mirroredRing, onSide, plate, type Vector } from './mesh';
import { ACCENT, GLASS, LAMP, LIGHT, type Measures, type Parts, RUBBER, WHITE } from './parts';

// Bodies with a roof: a saloon, a van and a coupé. Lengths and heights are those of the shape, drawn for a car of its
// usual length and scaled to the one driven; axles, track, wheels and width are those of the car.

/** A closed body in profile. Along the car: 0 at the tail, 1 at the nose; heights from the road [m]. */
export interface Profile {
  readonly usualLength: number; // [m]
  /** The upper edge of the body, which the glass stands on. */
  readonly belt: { readonly along: readonly number[]; readonly height: readonly number[] };
  /** The glass: where it begins and ends at the belt, and where the roof does. */
  readonly glass: readonly [tail: number, roofTail: number, roofNose: number, nose: number];
  readonly roof: number;
  readonly sill: number;
  readonly lamps: number; // height
  readonly upper: Colour;
  readonly lower: Colour;
  readonly eye: { readonly along: number; readonly height: number };
  /** Height of a wing on the tail; none where it is missing. */
  readonly wing?: number;
}

/** A car of four doors. */
export const SALOON: Profile = {
  usualLength: 4.3,
  belt: { along: [0, 0.04, 0.18, 0.68, 0.9, 0.98, 1], height: [0.86, 0.96, 0.98, 0.94, 0.8, 0.68, 0.56] },
  glass: [0.13, 0.3, 0.5, 0.68],
  roof: 1.4,
  sill: 0.2,
  lamps: 0.72,
  upper: WHITE,
  lower: WHITE,
  eye: { along: 0.5, height: 1.16 },
};

/** A van, high and with a steep front. */
export const VAN: Profile = {
  usualLength: 4.57,
  belt: { along: [0, 0.5, 0.96, 0.985, 1], height: [1.06, 1.08, 1.06, 0.9, 0.6] },
  glass: [0.01, 0.05, 0.83, 0.965],
  roof: 1.94,
  sill: 0.26,
  lamps: 0.78,
  upper: WHITE,
  lower: ACCENT,
  eye: { along: 0.79, height: 1.5 },
};

/** Low, with a long nose, a roof that falls to the tail, and a wing. */
export const COUPE: Profile = {
  usualLength: 4.4,
  belt: { along: [0, 0.03, 0.2, 0.62, 0.85, 0.97, 1], height: [0.72, 0.86, 0.9, 0.84, 0.74, 0.58, 0.46] },
  glass: [0.06, 0.36, 0.48, 0.66],
  roof: 1.2,
  sill: 0.16,
  lamps: 0.66,
  upper: ACCENT,
  lower: WHITE,
  eye: { along: 0.46, height: 1.02 },
  wing: 1.06,
};

/** Height of the belt at a place along the car, linear between its points. */
function beltAt({ along, height }: Profile['belt'], place: number): number {
  const next = Math.max(1, firstSince(along, place));
  const [a, b] = [along[next - 1] ?? 0, along[next] ?? 1];
  const [low, high] = [height[next - 1] ?? 0, height[next] ?? 0];
  return low + ((high - low) * clamp(place - a, 0, 1)) / (b - a || 1);
}

/** Sections along the car [m], and the lower edge of the body in each: the sill, or the arch over a wheel. */
function edgesOf(measures: Measures, profile: Profile, k: number): { x: number; low: number }[] {
  const { front, rear, nose, tail, radius } = measures;
  const [arch, sill] = [1.14 * radius, profile.sill * k];
  const edges = profile.belt.along.map((along) => ({ x: tail + along * (nose - tail), low: sill }));
  for (const axle of [front, rear])
    for (const share of [-1, -0.92, -0.7, -0.35, 0, 0.35, 0.7, 0.92, 1]) {
      const height = radius + arch * Math.sqrt(Math.max(0, 1 - share * share));
      edges.push({ x: axle + share * arch, low: Math.abs(share) === 1 ? sill : Math.max(sill, height) });
    }
  const inArch = (x: number): boolean => [front, rear].some((axle) => Math.abs(x - axle) < arch * 0.999);
  const isOfArch = (low: number): boolean => low > sill;
  return edges
    .filter(({ x, low }) => x >= tail && x <= nose && (isOfArch(low) || !inArch(x)))
    .sort((a, b) => a.x - b.x || a.low - b.low);
}

/** Adds the body of a profile; returns the driver's eyes and the centre of the steering wheel. */
export function addClosedBody(
  { paint, dark, lamps, headlamps }: Parts,
  measures: Measures,
  profile: Profile,
): { eye: Vector; steeringWheel: Vector } {
  const { nose, tail, halfWidth, halfTrack, tyre, length } = measures;
  const k = length / profile.usualLength;
  const place = (along: number): number => tail + along * (nose - tail);
  const height = (x: number): number => k * beltAt(profile.belt, (x - tail) / (nose - tail));
  const half = halfWidth;
  const inner = Math.min(halfTrack - tyre / 2 - 0.04 * k, 0.82 * half);
  const edges = edgesOf(measures, profile, k);
  // Narrower at both ends.
  const wide = (x: number): number => half * (1 - 0.1 * Math.abs((2 * (x - tail)) / (nose - tail) - 1) ** 4);

  // Between the wheels, then the sides over them.
  const middle = edges.map(({ x }) => plate(x, inner, profile.sill * k, height(x)));
  paint.loft(middle, (_x, face) => (face === 1 ? profile.upper : profile.lower));
  for (const side of [-1, 1]) {
    const rings = edges.map(({ x, low }) => {
      const [out, top] = [wide(x), height(x)];
      const shoulder = Math.max(low + 0.02 * k, top - 0.1 * k);
      return onSide(side, [
        [x, inner, low],
        [x, out - 0.03 * k, low],
        [x, out, Math.min(low + 0.08 * k, shoulder - 0.01 * k)],
        [x, out, shoulder],
        [x, out - 0.07 * k, Math.max(top, shoulder + 0.01 * k)],
        [x, inner, Math.max(top, shoulder + 0.01 * k)],
      ]);
    });
    paint.loft(rings, profile.lower);
  }

  // Glass all round, with the roof on it.
  const [g0, r0, r1, g1] = profile.glass.map(place) as [number, number, number, number];
  const roof = profile.roof * k;
  const pane = (x: number, top: number, share: number): Vector[] => {
    const low = height(x) - 0.02 * k;
    const high = Math.max(top, low + 0.03 * k);
    return mirroredRing(x, [
      [half * 0.9, low],
      [half * share, high - 0.06 * k > low ? high - 0.06 * k : low + 0.01 * k],
      [half * (share - 0.06), high],
    ]);
  };
  const isRoof = (x: number, face: number): boolean => face >= 1 && face <= 3 && x > r0 && x < r1;
  paint.loft(
    [
      pane(g0, 0, 0.86),
      pane(r0, roof, 0.8),
      pane((r0 + r1) / 2, roof * 1.01, 0.81),
      pane(r1, roof, 0.8),
      pane(g1, 0, 0.86),
    ],
    (x, face) => (isRoof(x, face) ? profile.upper : GLASS),
  );

  // Bumpers, floor, lamps.
  const [low, z] = [profile.sill * k, profile.lamps * k];
  dark.box([tail - 0.01, -half * 0.84, low], [tail + 0.1 * k, half * 0.84, low + 0.2 * k], RUBBER);
  dark.box([nose - 0.1 * k, -half * 0.84, low], [nose + 0.01, half * 0.84, low + 0.2 * k], RUBBER);
  dark.box([tail + 0.1 * k, -inner, low - 0.05 * k], [nose - 0.1 * k, inner, low], RUBBER);
  for (const side of [-1, 1]) {
    const [a, b] = [side * half * 0.62, side * half * 0.84];
    lamps.box([tail - 0.012, a, z], [tail + 0.05 * k, b, z + 0.12 * k], LAMP);
    headlamps.box([nose - 0.12 * k, a, z - 0.16 * k], [nose + 0.012, b, z - 0.05 * k], LIGHT);
    const [m0, m1] = [side * (half * 0.93), side * (half + 0.08 * k)];
    dark.box([g1 - 0.34 * k, m0, height(g1)], [g1 - 0.26 * k, m1, height(g1) + 0.13 * k], RUBBER);
  }
  if (profile.wing !== undefined) {
    const top = profile.wing * k;
    paint.box([tail + 0.02 * k, -0.86 * half, top - 0.035 * k], [tail + 0.34 * k, 0.86 * half, top], ACCENT);
    for (const side of [-1, 1]) {
      const [a, b] = [side * 0.86 * half, side * 0.88 * half];
      paint.box([tail, a, top - 0.14 * k], [tail + 0.36 * k, b, top + 0.05 * k], WHITE);
      const post = side * 0.5 * half;
      dark.rod([tail + 0.26 * k, post, 0.8 * k], [tail + 0.18 * k, post, top - 0.02 * k], 0.04 * k, RUBBER);
    }
  }
  const y = 0.4 * half;
  const x = place(profile.eye.along);
  return {
    eye: [x, y, profile.eye.height * k],
    steeringWheel: [x + 0.45 * k, y, (profile.eye.height - 0.3) * k],
  };
}
