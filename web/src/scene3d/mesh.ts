// Builder of meshes from triangles, boxes, rods and lofted sections, in flat shading.

/** A point or a direction: x, y, z [m], in W or in the axes of a car (x forward, y left, z up). */
export type Vector = readonly [number, number, number];

/** Red, green, blue in [0, 1], linear (not sRGB). */
export type Colour = readonly [number, number, number];

/** Triangles for the graphics card: three corners each, with normal and colour. */
export interface MeshData {
  readonly positions: Float32Array;
  readonly normals: Float32Array;
  readonly colours: Float32Array;
}

const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];

const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** sRGB colour #rrggbb as linear colour. */
export function colourOf(hex: string): Colour {
  const channel = (at: number): number => {
    const value = parseInt(hex.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  };
  return [channel(1), channel(3), channel(5)];
}

/** Collects flat-shaded triangles; corners run counter-clockwise seen from outside. */
export class MeshBuilder {
  readonly #positions: number[] = [];
  readonly #normals: number[] = [];
  readonly #colours: number[] = [];

  triangle(a: Vector, b: Vector, c: Vector, colour: Colour): void {
    const [x, y, z] = cross(minus(b, a), minus(c, a));
    const length = Math.hypot(x, y, z);
    if (!(length > 1e-12)) return; // degenerate
    for (const corner of [a, b, c]) {
      this.#positions.push(...corner);
      this.#normals.push(x / length, y / length, z / length);
      this.#colours.push(...colour);
    }
  }

  /** A flat face with four corners, as two triangles. */
  quad(a: Vector, b: Vector, c: Vector, d: Vector, colour: Colour): void {
    this.triangle(a, b, c, colour);
    this.triangle(a, c, d, colour);
  }

  /** A box with its faces along the axes, between two opposite corners. */
  box(one: Vector, other: Vector, colour: Colour): void {
    const [x, y, z] = [0, 1, 2].map((axis) => [one[axis] ?? 0, other[axis] ?? 0].sort((a, b) => a - b)) as [
      number[],
      number[],
      number[],
    ];
    const [left, right, low, high] = [y[0] ?? 0, y[1] ?? 0, z[0] ?? 0, z[1] ?? 0];
    const ring = (at = 0): Vector[] => [
      [at, left, low],
      [at, right, low],
      [at, right, high],
      [at, left, high],
    ];
    this.loft([ring(x[0]), ring(x[1])], colour);
  }

  /** A closed surface over sections along x, each counter-clockwise seen from ahead (where y points right). */
  loft(sections: readonly (readonly Vector[])[], colour: Colour | ((x: number, face: number) => Colour)): void {
    const paint = typeof colour === 'function' ? colour : (): Colour => colour;
    for (let i = 0; i + 1 < sections.length; ++i) {
      const [here, next] = [sections[i] ?? [], sections[i + 1] ?? []];
      for (let k = 0; k < here.length; ++k) {
        const [a, b] = [here[k], here[(k + 1) % here.length]];
        const [c, d] = [next[(k + 1) % here.length], next[k]];
        if (a && b && c && d) this.quad(a, b, c, d, paint((a[0] + d[0]) / 2, k));
      }
    }
    const [first, last] = [sections[0] ?? [], sections.at(-1) ?? []];
    this.#fan([...first].reverse(), paint(first[0]?.[0] ?? 0, -1));
    this.#fan(last, paint(last[0]?.[0] ?? 0, -2));
  }

  /** The end face of a closed surface. */
  #fan(ring: readonly Vector[], colour: Colour): void {
    for (let k = 1; k + 1 < ring.length; ++k) {
      const [a, b, c] = [ring[0], ring[k], ring[k + 1]];
      if (a && b && c) this.triangle(a, b, c, colour);
    }
  }

  /** A straight rod of four sides between two points. */
  rod(from: Vector, to: Vector, width: number, colour: Colour): void {
    const along = minus(to, from);
    const side = cross(along, Math.abs(along[2]) > Math.abs(along[0]) + Math.abs(along[1]) ? [1, 0, 0] : [0, 0, 1]);
    const k = width / 2 / Math.hypot(...side);
    const u: Vector = [side[0] * k, side[1] * k, side[2] * k];
    const w = cross(u, along);
    const m = width / 2 / Math.hypot(...w);
    const v: Vector = [w[0] * m, w[1] * m, w[2] * m];
    const corner = (p: Vector, i: number, j: number): Vector => [
      p[0] + i * u[0] + j * v[0],
      p[1] + i * u[1] + j * v[1],
      p[2] + i * u[2] + j * v[2],
    ];
    const ring = (p: Vector): Vector[] => [corner(p, -1, -1), corner(p, 1, -1), corner(p, 1, 1), corner(p, -1, 1)];
    const [a, b] = [ring(from), ring(to)];
    for (let i = 0; i < 4; ++i) {
      const [p, q, r, s] = [a[i], b[i], b[(i + 1) % 4], a[(i + 1) % 4]];
      if (p && q && r && s) this.quad(p, q, r, s, colour);
    }
  }

  data(): MeshData {
    return {
      positions: new Float32Array(this.#positions),
      normals: new Float32Array(this.#normals),
      colours: new Float32Array(this.#colours),
    };
  }
}

/** A section from its half at y ≥ 0, bottom to top, mirrored. */
export function mirroredRing(x: number, half: readonly (readonly [y: number, z: number])[]): Vector[] {
  const left = half.map(([y, z]): Vector => [x, y, z]);
  const right = [...half]
    .reverse()
    .filter(([y]) => y > 0)
    .map(([y, z]): Vector => [x, -y, z]);
  return [...left, ...right];
}

/** An upright plate across the car, so wide to each side. */
export const plate = (x: number, half: number, low: number, high: number): Vector[] =>
  mirroredRing(x, [
    [half, low],
    [half, high],
  ]);

/** A section drawn for the left side, on that side or mirrored to the right. */
export const onSide = (side: number, corners: readonly Vector[]): readonly Vector[] =>
  side > 0 ? corners : corners.map(([x, y, z]): Vector => [x, -y, z]).reverse();
