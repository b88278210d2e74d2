import { BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, Mesh, MeshBasicMaterial, type Scene } from 'three';
import type { Colour } from './mesh';
import { type RibbonRing, ribbonIndices, writeRibbon } from './ribbon';

const flatMaterial = (): MeshBasicMaterial =>
  new MeshBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false });

/** Shows a ring of bands; uploads only the pieces written since the last picture. */
export class RingView {
  readonly #scene: Scene;
  readonly #ring: RibbonRing;
  readonly #mesh: Mesh<BufferGeometry, MeshBasicMaterial>;
  #uploaded = 0;

  constructor(scene: Scene, ring: RibbonRing, order: number, opacity: number) {
    this.#scene = scene;
    this.#ring = ring;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(ring.positions, 3).setUsage(DynamicDrawUsage));
    geometry.setAttribute('color', new BufferAttribute(ring.colours, 4, true).setUsage(DynamicDrawUsage));
    geometry.setIndex(new BufferAttribute(ring.indices, 1));
    this.#mesh = new Mesh(geometry, flatMaterial());
    this.#mesh.material.opacity = opacity;
    this.#mesh.renderOrder = order;
    this.#mesh.frustumCulled = false;
    scene.add(this.#mesh);
  }

  paint(colour: Colour): void {
    this.#mesh.material.color = new Color().setRGB(...colour);
  }

  update(): void {
    const { written, capacity } = this.#ring;
    const fresh = written - this.#uploaded;
    if (fresh === 0) return;
    const isAll = fresh < 0 || fresh >= capacity;
    const from = this.#uploaded % capacity;
    const pieces: [number, number][] = isAll
      ? [[0, capacity]]
      : from + fresh <= capacity
        ? [[from, fresh]]
        : [
            [from, capacity - from],
            [0, from + fresh - capacity],
          ];
    for (const name of ['position', 'color'] as const) {
      const attribute = this.#mesh.geometry.getAttribute(name) as BufferAttribute;
      const perPiece = name === 'position' ? 12 : 16;
      attribute.clearUpdateRanges();
      for (const [first, count] of pieces) attribute.addUpdateRange(first * perPiece, count * perPiece);
      attribute.needsUpdate = true;
    }
    this.#uploaded = written;
    this.#mesh.geometry.setDrawRange(0, 6 * Math.min(written, capacity));
  }

  dispose(): void {
    this.#scene.remove(this.#mesh);
    this.#mesh.geometry.dispose();
    this.#mesh.material.dispose();
  }
}

/** A band along a line of at most `capacity` points that changes from picture to picture. */
export class BandView {
  readonly #scene: Scene;
  readonly #capacity: number;
  readonly #mesh: Mesh<BufferGeometry, MeshBasicMaterial>;
  readonly #positions: BufferAttribute;
  readonly #colours: BufferAttribute;

  constructor(scene: Scene, capacity: number, order: number) {
    this.#scene = scene;
    this.#capacity = capacity;
    this.#positions = new BufferAttribute(new Float32Array(capacity * 6), 3).setUsage(DynamicDrawUsage);
    this.#colours = new BufferAttribute(new Uint8Array(capacity * 8).fill(255), 4, true).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.#positions);
    geometry.setAttribute('color', this.#colours);
    geometry.setIndex(new BufferAttribute(ribbonIndices(capacity), 1));
    geometry.setDrawRange(0, 0);
    this.#mesh = new Mesh(geometry, flatMaterial());
    this.#mesh.renderOrder = order;
    this.#mesh.frustumCulled = false;
    scene.add(this.#mesh);
  }

  paint(colour: Colour): void {
    this.#mesh.material.color = new Color().setRGB(...colour);
  }

  /** `alphaAt` gives the opacity of a point by its share of the length. */
  show(px: ArrayLike<number>, py: ArrayLike<number>, width: number, alphaAt: (share: number) => number): void {
    const count = Math.min(px.length, py.length, this.#capacity);
    this.#lay(px, py, count, width);
    const colours = this.#colours.array;
    for (let i = 0; i < count; ++i) colours[8 * i + 3] = colours[8 * i + 7] = 255 * alphaAt(i / Math.max(1, count - 1));
  }

  #lay(px: ArrayLike<number>, py: ArrayLike<number>, count: number, width: number): void {
    writeRibbon(px, py, count, width, this.#positions.array as Float32Array);
    for (const [attribute, perPair] of [
      [this.#positions, 6],
      [this.#colours, 8],
    ] as const) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, count * perPair);
      attribute.needsUpdate = true;
    }
    this.#mesh.geometry.setDrawRange(0, 6 * Math.max(0, count - 1));
  }

  dispose(): void {
    this.#scene.remove(this.#mesh);
    this.#mesh.geometry.dispose();
    this.#mesh.material.dispose();
  }
}
