import { describe, expect, it } from 'vitest';
import { carModel } from './car_mesh';
import type { MeshData } from './mesh';

/** Dimensions of a car [m]: to the axles, between its wheels, of a tyre, and of the body. */
const sizeOf = (front: number, rear: number, track: number, tyre: number, length: number, width: number) => ({
  ...{ front_axle_m: front, rear_axle_m: rear, track_width_m: track, tire_width_m: tyre },
  ...{ body_length_m: length, body_width_m: width },
});
const SIZE = sizeOf(1.25, 1.45, 1.6, 0.205, 4.3, 1.8);
const model = carModel(SIZE);

const corners = ({ positions }: MeshData): number[][] =>
  Array.from({ length: positions.length / 3 }, (_, i) => [...positions.slice(3 * i, 3 * i + 3)]);

/** Volume inside a closed skin by the divergence theorem: positive when its triangles face outwards. */
function volume({ positions }: MeshData): number {
  let sum = 0;
  for (let i = 0; i < positions.length; i += 9) {
    const [ax = 0, ay = 0, az = 0, bx = 0, by = 0, bz = 0, cx = 0, cy = 0, cz = 0] = positions.slice(i, i + 9);
    sum += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
  }
  return sum / 6;
}

/** Corners that the other side does not have. */
function missingInMirror(part: MeshData): string[] {
  const key = ([x, y, z]: number[], side: number): string =>
    [x, (y ?? 0) * side || 0, z].map((v) => (v ?? 0).toFixed(4).replace('-0.0000', '0.0000')).join();
  const here = new Set(corners(part).map((corner) => key(corner, 1)));
  return corners(part)
    .map((corner) => key(corner, -1))
    .filter((corner) => !here.has(corner));
}

describe('the car', () => {
  it('turns the skin of its driver and wheels outwards, and stands on the road', () => {
    for (const part of ['helmet', 'hand', 'wheel'] as const) expect(volume(model[part]), part).toBeGreaterThan(0);
    // A wheel of radius r and width w lies within a cylinder.
    expect(volume(model.wheel)).toBeLessThan(Math.PI * model.wheelRadius ** 2 * 0.24);
    const heights = [...corners(model.paint), ...corners(model.dark)].map(([, , z]) => z ?? NaN);
    expect(Math.min(...heights)).toBeGreaterThan(0.05);
    expect(Math.max(...heights)).toBeLessThan(1.3);
  });

  it('has finite normals of length one', () => {
    for (const { normals } of [model.paint, model.wheel, model.hand])
      for (let i = 0; i < normals.length; i += 3) expect(Math.hypot(...normals.slice(i, i + 3))).toBeCloseTo(1, 5);
  });

  it('can be small', () => {
    const toy = carModel(sizeOf(0.16, 0.16, 0.2, 0.03, 0.5, 0.27));
    expect(toy.wheelRadius).toBeLessThan(0.06);
    expect(Math.max(...corners(toy.paint).map(([, , z]) => z ?? NaN))).toBeLessThan(0.15);
  });
});

describe('bodies', () => {
  const BODIES = ['formula-student', 'indy', 'road-car', 'vw-vanagon', 'udacity', 'f1tenth'];
  const all = BODIES.map((car) => carModel({ ...SIZE, car }));

  it('are six, each closed, as long as the car, and the same in a mirror', () => {
    expect(new Set(all.map(({ paint, dark }) => `${paint.positions.join()} ${dark.positions.join()}`)).size).toBe(6);
    for (const [i, body] of all.entries()) {
      const skin = [...corners(body.paint), ...corners(body.dark)];
      const xs = skin.map(([x]) => x ?? NaN);
      expect(Math.max(...xs) - Math.min(...xs), BODIES[i]).toBeCloseTo(SIZE.body_length_m, 0);
      expect(Math.max(...skin.map(([, y]) => y ?? NaN)), BODIES[i]).toBeLessThanOrEqual(body.width / 2 + 0.1);
      for (const part of [body.paint, body.dark, body.lamps, body.headlamps, body.wheel]) {
        expect(volume(part), BODIES[i]).toBeGreaterThan(0);
        expect(part.positions.every(Number.isFinite), BODIES[i]).toBe(true);
        if (part !== body.wheel) expect(missingInMirror(part), BODIES[i]).toEqual([]);
      }
      expect(body.paint.positions.length / 9, BODIES[i]).toBeLessThan(3000);
    }
  });

  it('belong to cars by name, and to small ones of any name', () => {
    const toy = { ...SIZE, body_length_m: 0.5, front_axle_m: 0.16, rear_axle_m: 0.15 };
    expect(carModel({ ...toy, car: 'mine' }).helmet.positions).toHaveLength(0);
    expect(carModel({ ...toy, car: 'orca-1-43' }).helmet.positions.length).toBeGreaterThan(0);
    expect(carModel({ ...SIZE, car: 'mine' })).toEqual(model);
  });
});

describe('cars with a roof', () => {
  const cars = {
    'road-car': SIZE,
    'bmw-320i': { ...SIZE, body_width_m: 1.61, track_width_m: 1.375 },
    'vw-vanagon': sizeOf(1.15, 1.31, 1.559, 0.185, 4.569, 1.844),
  };
  for (const [car, size] of Object.entries(cars)) {
    it(`${car} is as long, wide and high as such a car, and closed`, () => {
      const closed = carModel({ ...size, car });
      const all = corners(closed.paint);
      const range = (axis: 0 | 1 | 2): number =>
        Math.max(...all.map((corner) => corner[axis] ?? NaN)) - Math.min(...all.map((corner) => corner[axis] ?? NaN));
      expect(range(0)).toBeCloseTo(size.body_length_m, 1);
      expect(range(1)).toBeCloseTo(Math.max(size.body_width_m, size.track_width_m + size.tire_width_m), 1);
      const top = Math.max(...all.map(([, , z]) => z ?? NaN));
      expect(top).toBeGreaterThan(car === 'vw-vanagon' ? 1.85 : 1.3);
      expect(top).toBeLessThan(car === 'vw-vanagon' ? 2.05 : 1.6);
      // A body fills about half of its box: the skin is closed and turned outwards.
      expect(volume(closed.paint) / (range(0) * range(1) * top)).toBeGreaterThan(0.35);
      expect(volume(closed.paint) / (range(0) * range(1) * top)).toBeLessThan(1);
    });

    it(`${car} leaves room for its wheels, and for the driver's eyes`, () => {
      const closed = carModel({ ...size, car });
      const { wheelRadius: radius } = closed;
      for (const x of [size.front_axle_m, -size.rear_axle_m]) {
        const above = corners(closed.paint).filter(
          ([px = 0, py = 0, pz = 0]) =>
            Math.hypot(px - x, pz - radius) < radius * 0.98 && Math.abs(py) > size.track_width_m / 2,
        );
        expect(above).toEqual([]);
      }
      const [, , z] = closed.eye;
      expect(z).toBeLessThan(Math.max(...corners(closed.paint).map(([, , high]) => high ?? NaN)));
      expect(z).toBeGreaterThan(0.9);
    });
  }
});
