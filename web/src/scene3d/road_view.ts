// The road in the scene of three.js.
import { BufferAttribute, BufferGeometry, type DataTexture, Group, Mesh, MeshBasicMaterial, type Scene } from 'three';
import type { RoadLines } from '../state/road';
import { greyTexture, Order, underTexture } from './landscape';
import { noiseTile } from './noise';
import type { Palette } from './palette';
import { type FlatMesh, roadMeshes } from './road_mesh';

const GRAIN_M = 5; // size of the asphalt texture; chosen
const PIECE = 120 * 18; // numbers of a piece that is drawn or left out as a whole: 120 quads; chosen

/** Texture coordinates of corners on the ground. */
function placeOnGrain(positions: Float32Array): Float32Array {
  const uv = new Float32Array((positions.length / 3) * 2);
  for (let i = 0; i < uv.length; i += 2) {
    uv[i] = (positions[(i / 2) * 3] ?? 0) / GRAIN_M;
    uv[i + 1] = (positions[(i / 2) * 3 + 1] ?? 0) / GRAIN_M;
  }
  return uv;
}

/** The road in the scene; rebuilt for another road or palette. */
export class RoadView {
  readonly #scene: Scene;
  readonly #grain: DataTexture;
  readonly #rough: MeshBasicMaterial;
  readonly #smooth = new MeshBasicMaterial({ vertexColors: true, depthWrite: false });
  #parts: Group | null = null;

  constructor(scene: Scene, anisotropy: number) {
    this.#scene = scene;
    this.#grain = greyTexture(noiseTile(128, 0.3, [9, 31, 64, 64], 5), 128, anisotropy);
    this.#rough = new MeshBasicMaterial({
      vertexColors: true,
      depthWrite: false,
      map: this.#grain,
      color: underTexture([1, 1, 1]),
    });
  }

  show(lines: RoadLines | null, isClosed: boolean, kerb: number, colours: Palette, size: number): void {
    this.#remove();
    if (!lines) return;
    const meshes = roadMeshes(lines, isClosed, kerb, colours.road, size);
    this.#parts = new Group();
    this.#add(meshes.verge, Order.verge, this.#rough);
    this.#add(meshes.kerbs, Order.kerbs, this.#smooth);
    this.#add(meshes.surface, Order.surface, this.#rough);
    this.#add(meshes.lines, Order.lines, this.#smooth);
    this.#scene.add(this.#parts);
  }

  /** In pieces along the road, so that those out of view are not drawn. */
  #add({ positions, colours }: FlatMesh, order: number, material: MeshBasicMaterial): void {
    for (let from = 0; from < positions.length; from += PIECE) {
      const corners = positions.subarray(from, from + PIECE);
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(corners, 3));
      geometry.setAttribute('color', new BufferAttribute(colours.subarray(from, from + PIECE), 3));
      if (material.map) geometry.setAttribute('uv', new BufferAttribute(placeOnGrain(corners), 2));
      const mesh = new Mesh(geometry, material);
      mesh.renderOrder = order;
      this.#parts?.add(mesh);
    }
  }

  #remove(): void {
    if (!this.#parts) return;
    this.#scene.remove(this.#parts);
    for (const mesh of this.#parts.children as Mesh[]) mesh.geometry.dispose();
    this.#parts = null;
  }

  dispose(): void {
    this.#remove();
    this.#rough.dispose();
    this.#smooth.dispose();
    this.#grain.dispose();
  }
}
