// Bands on the ground in the scene of three.js.
import { BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, Mesh, MeshBasicMaterial, type Scene } from 'three';
import type { Line } from '../draw/line';
import type { Colour } from './mesh';
import { type RibbonRing, ribbonIndices, writeRibbon } from './ribbon';

/** Flat triangles on the ground that change from picture to picture; `perPiece`: numbers of a piece to upload. */
class FlatView {
  protected readonly mesh: Mesh<BufferGeometry, MeshBasicMaterial>;
  readonly #scene: Scene;
  readonly #attributes: readonly (readonly [attribute: BufferAttribute, perPiece: number])[];

  constructor(
    scene: Scene,
    order: number,
    indices: Uint32Array,
    positions: readonly [Float32Array, perPiece: number],
    colours: readonly [Uint8Array, perPiece: number],
  ) {
    this.#scene = scene;
    const geometry = new BufferGeometry();
    const [places, tints] = [new BufferAttribute(positions[0], 3), new BufferAttribute(colours[0], 4, true)];
    geometry.setAttribute('position', places.setUsage(DynamicDrawUsage));
    geometry.setAttribute('color', tints.setUsage(DynamicDrawUsage));
    geometry.setIndex(new BufferAttribute(indices, 1));
    this.#attributes = [
      [places, positions[1]],
      [tints, colours[1]],
    ];
    this.mesh = new Mesh(geometry, new MeshBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }));
    this.mesh.renderOrder = order;
    this.mesh.frustumCulled = false;
    scene.add(this.mesh);
  }

  paint(colour: Colour): void {
    this.mesh.material.color = new Color().setRGB(...colour);
  }

  /** Uploads pieces, each as the first one and how many, and draws `count` triangles' corners. */
  protected upload(pieces: readonly (readonly [first: number, count: number])[], count: number): void {
    for (const [attribute, perPiece] of this.#attributes) {
      attribute.clearUpdateRanges();
      for (const [first, length] of pieces) attribute.addUpdateRange(first * perPiece, length * perPiece);
      attribute.needsUpdate = true;
    }
    this.mesh.geometry.setDrawRange(0, count);
  }

  dispose(): void {
    this.#scene.remove(this.mesh);
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** Shows a ring of bands; uploads only the pieces written since the last picture. */
export class RingView extends FlatView {
  readonly #ring: RibbonRing;
  #uploaded = 0;

  constructor(scene: Scene, ring: RibbonRing, order: number, opacity: number) {
    super(scene, order, ring.indices, [ring.positions, 12], [ring.colours, 16]);
    this.#ring = ring;
    this.mesh.material.opacity = opacity;
  }

  update(): void {
    const { written, capacity } = this.#ring;
    const fresh = written - this.#uploaded;
    if (fresh === 0) return;
    const isAll = fresh < 0 || fresh >= capacity;
    const from = isAll ? 0 : this.#uploaded % capacity;
    const count = isAll ? capacity : fresh;
    const first = Math.min(count, capacity - from); // the others are at the ring's beginning
    this.upload(
      [
        [from, first],
        [0, count - first],
      ],
      6 * Math.min(written, capacity),
    );
    this.#uploaded = written;
  }
}

/** A band along a line of at most `capacity` points that changes from picture to picture. */
export class BandView extends FlatView {
  readonly #capacity: number;
  readonly #positions: Float32Array;
  readonly #colours: Uint8Array;

  constructor(scene: Scene, capacity: number, order: number) {
    const [positions, colours] = [new Float32Array(capacity * 6), new Uint8Array(capacity * 8).fill(255)];
    super(scene, order, ribbonIndices(capacity), [positions, 6], [colours, 8]);
    [this.#capacity, this.#positions, this.#colours] = [capacity, positions, colours];
    this.mesh.geometry.setDrawRange(0, 0);
  }

  show({ x, y }: Line, width: number, opacity: number): void {
    const count = Math.min(x.length, y.length, this.#capacity);
    writeRibbon(x, y, count, width, this.#positions);
    for (let i = 0; i < 2 * count; ++i) this.#colours[4 * i + 3] = 255 * opacity;
    this.upload([[0, count]], 6 * Math.max(0, count - 1));
  }
}
