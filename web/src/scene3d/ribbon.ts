// Flat bands on the ground: a ring buffer of pieces, and a band along a line.

/** The end of a band, where its next piece is joined. */
interface End {
  readonly leftX: number;
  readonly leftY: number;
  readonly rightX: number;
  readonly rightY: number;
  readonly strength: number;
}

/**
 * Bands on the ground in a ring buffer of pieces, shared by several tracks (for example one for each wheel); when it is
 * full the oldest pieces are overwritten. A piece is a quad of four corners, x, y, z each, in a slot of its own.
 */
export class RibbonRing {
  readonly capacity: number;
  readonly positions: Float32Array;
  /** Red, green, blue (full) and opacity of each corner. */
  readonly colours: Uint8Array;
  /** Two triangles for each slot; empty slots have no area. */
  readonly indices: Uint32Array;
  /** Number of pieces written so far. */
  written = 0;
  readonly #ends: (End | null)[];

  constructor(capacity: number, tracks: number) {
    this.capacity = capacity;
    this.positions = new Float32Array(capacity * 12);
    this.colours = new Uint8Array(capacity * 16).fill(255);
    this.indices = new Uint32Array(capacity * 6);
    for (let i = 0; i < capacity; ++i)
      this.indices.set(
        [0, 1, 2, 0, 2, 3].map((corner) => 4 * i + corner),
        6 * i,
      );
    this.#ends = Array.from({ length: tracks }, () => null);
  }

  /** Slot of the next piece. */
  get next(): number {
    return this.written % this.capacity;
  }

  /** Continues a track to a pair of points; the first pair after lift() writes nothing yet. */
  push(track: number, leftX: number, leftY: number, rightX: number, rightY: number, strength: number): void {
    const from = this.#ends[track];
    this.#ends[track] = { leftX, leftY, rightX, rightY, strength };
    if (!from) return;
    const slot = this.next;
    const corners = [from.leftX, from.leftY, 0, from.rightX, from.rightY, 0, rightX, rightY, 0, leftX, leftY, 0];
    this.positions.set(corners, 12 * slot);
    [from.strength, from.strength, strength, strength].forEach((each, corner) => {
      this.colours[16 * slot + 4 * corner + 3] = Math.round(255 * each);
    });
    ++this.written;
  }

  /** The next pair of this track begins a new band. */
  lift(track: number): void {
    this.#ends[track] = null;
  }

  clear(): void {
    this.positions.fill(0);
    this.#ends.fill(null);
    this.written = 0;
  }
}

/**
 * Left and right corners of a band of `width` along a line: x, y, z of two corners for each of `count` points, written
 * into `positions` from its start. `px`, `py` hold the points.
 */
export function writeRibbon(
  px: ArrayLike<number>,
  py: ArrayLike<number>,
  count: number,
  width: number,
  positions: Float32Array,
): void {
  for (let i = 0; i < count; ++i) {
    const [a, b] = [Math.max(0, i - 1), Math.min(count - 1, i + 1)];
    const [dx, dy] = [(px[b] ?? 0) - (px[a] ?? 0), (py[b] ?? 0) - (py[a] ?? 0)];
    const length = Math.hypot(dx, dy);
    const k = length > 0 ? width / 2 / length : 0;
    const [x, y] = [px[i] ?? 0, py[i] ?? 0];
    positions.set([x - dy * k, y + dx * k, 0, x + dy * k, y - dx * k, 0], 6 * i);
  }
}

/** Indices of the triangles of a band of `count` pairs of corners, facing up. */
export function ribbonIndices(count: number): Uint32Array {
  const indices = new Uint32Array(Math.max(0, count - 1) * 6);
  for (let i = 0; i + 1 < count; ++i) indices.set([2 * i, 2 * i + 1, 2 * i + 3, 2 * i, 2 * i + 3, 2 * i + 2], 6 * i);
  return indices;
}
