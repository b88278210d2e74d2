// Sky, hills, ground and trees of the 3D picture.
import {
  BackSide,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  Float32BufferAttribute,
  Fog,
  Group,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  RepeatWrapping,
  RGBAFormat,
  type Scene,
  SphereGeometry,
} from 'three';
import { mix } from '../lib/math';
import { geometryOf } from './geometry';
import { type Colour, MeshBuilder, type Vector } from './mesh';
import { noiseTile } from './noise';
import type { Palette } from './palette';
import type { Tree } from './trees';

/** Order of drawing, from far to near without writing depth, so that nothing flickers. */
export const Order = { sky: -100, hills: -90, ground: -80, verge: -70, kerbs: -60, surface: -50, lines: -40 } as const;

/** Sizes of the ground, of a cell of its grid, of the view up to the end of the fog, and of a tile of trees; chosen. */
const GROUND_M = 2400;
const TILE_M = 20;
const FAR_M = 900;
const FOREST_TILE_M = 90;

/** A seamless grey texture from values around 1. */
export function greyTexture(values: Float32Array, size: number, anisotropy: number): DataTexture {
  const bytes = new Uint8Array(size * size * 4);
  values.forEach((value, i) => {
    const grey = Math.max(0, Math.min(255, Math.round(value * 200)));
    bytes.set([grey, grey, grey, 255], 4 * i);
  });
  const texture = new DataTexture(bytes, size, size, RGBAFormat);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = anisotropy;
  texture.needsUpdate = true;
  return texture;
}

/** A material's colour such that a grey texture of mean 200/255 leaves `colour`. */
export const underTexture = (colour: Colour): Color => new Color().setRGB(...colour).multiplyScalar(255 / 200);

/** A colour between two others. */
const mixed = (a: Colour, b: Colour, share: number): Colour => [
  mix(a[0], b[0], share),
  mix(a[1], b[1], share),
  mix(a[2], b[2], share),
];

/** Sky, hills, ground and trees. */
export class Landscape {
  readonly #scene: Scene;
  readonly #around = new Group(); // moves with the camera
  readonly #sky: Mesh<SphereGeometry, MeshBasicMaterial>;
  readonly #hills: Mesh<BufferGeometry, MeshBasicMaterial>;
  readonly #ground: Mesh<PlaneGeometry, MeshBasicMaterial>;
  readonly #picture: DataTexture;
  readonly #forest = new Group();
  readonly #bark = new MeshLambertMaterial({ vertexColors: true });

  constructor(scene: Scene, anisotropy: number) {
    this.#scene = scene;
    this.#sky = new Mesh(
      new SphereGeometry(1000, 24, 12, 0, 2 * Math.PI, 0, 0.52 * Math.PI),
      new MeshBasicMaterial({ vertexColors: true, side: BackSide, depthWrite: false, fog: false }),
    );
    this.#sky.geometry.rotateX(Math.PI / 2);
    this.#sky.renderOrder = Order.sky;
    this.#hills = new Mesh(
      hillsGeometry(),
      new MeshBasicMaterial({ vertexColors: true, side: DoubleSide, depthWrite: false, fog: false }),
    );
    this.#hills.renderOrder = Order.hills;
    this.#around.add(this.#sky, this.#hills);

    const size = 256;
    const values = noiseTile(size, 0.16, [5, 13, 41, 128], 11);
    for (let i = 0; i < size; ++i) {
      for (const at of [i, i * size]) values[at] = (values[at] ?? 1) * 0.88; // the grid lines
    }
    this.#picture = greyTexture(values, size, anisotropy);
    this.#picture.repeat.set(GROUND_M / TILE_M, GROUND_M / TILE_M);
    this.#ground = new Mesh(
      new PlaneGeometry(GROUND_M, GROUND_M),
      new MeshBasicMaterial({ map: this.#picture, depthWrite: false }),
    );
    this.#ground.renderOrder = Order.ground;
    for (const each of [this.#sky, this.#hills, this.#ground]) each.frustumCulled = false;
    scene.add(this.#around, this.#ground, this.#forest);
  }

  paint(colours: Palette): void {
    this.#scene.fog = new Fog(new Color().setRGB(...colours.horizon), 120, FAR_M);
    const sky = this.#sky.geometry.getAttribute('position');
    const shades = new Float32Array(sky.count * 3);
    for (let i = 0; i < sky.count; ++i) {
      const height = Math.max(0, sky.getZ(i) / 1000);
      shades.set(mixed(colours.horizon, colours.zenith, 1 - (1 - height) ** 3), 3 * i);
    }
    this.#sky.geometry.setAttribute('color', new Float32BufferAttribute(shades, 3));
    const hills = this.#hills.geometry.getAttribute('position');
    const tints = new Float32Array(hills.count * 3);
    for (let i = 0; i < hills.count; ++i) {
      const isFar = i < hills.count / 2;
      const foot = hills.getZ(i) <= 0 ? 0.75 : 0.15;
      tints.set(mixed(isFar ? colours.farHills : colours.hills, colours.horizon, foot), 3 * i);
    }
    this.#hills.geometry.setAttribute('color', new Float32BufferAttribute(tints, 3));
    this.#ground.material.color = underTexture(colours.ground);
  }

  /** Moves with the camera; the ground moves by whole cells, so that its grid stays in place. */
  follow(x: number, y: number): void {
    this.#around.position.set(x, y, 0);
    this.#ground.position.set(Math.round(x / TILE_M) * TILE_M, Math.round(y / TILE_M) * TILE_M, 0);
  }

  /** Trees in tiles, so that those out of view are not drawn. */
  plant(trees: readonly Tree[], colours: Palette): void {
    this.#fell();
    const tiles = new Map<string, MeshBuilder>();
    for (const tree of trees) {
      const key = `${Math.floor(tree.x / FOREST_TILE_M)},${Math.floor(tree.y / FOREST_TILE_M)}`;
      const tile = tiles.get(key) ?? new MeshBuilder();
      tiles.set(key, tile);
      addTree(tile, tree, colours);
    }
    for (const tile of tiles.values()) this.#forest.add(new Mesh(geometryOf(tile.data()), this.#bark));
  }

  /** Removes all trees. */
  #fell(): void {
    for (const mesh of this.#forest.children as Mesh[]) mesh.geometry.dispose();
    this.#forest.clear();
  }

  dispose(): void {
    this.#fell();
    this.#scene.remove(this.#around, this.#ground, this.#forest);
    for (const mesh of [this.#sky, this.#hills, this.#ground]) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    this.#bark.dispose();
    this.#picture.dispose();
  }
}

/** Adds a tree: a trunk and two cones, without hidden faces. */
function addTree(mesh: MeshBuilder, { x, y, height, width, kind }: Tree, colours: Palette): void {
  const cone = (sides: number, low: number, high: number, radius: number, top: number, colour: Colour): void => {
    const point = (k: number, r: number, z: number): Vector => {
      const angle = (2 * Math.PI * k) / sides + x;
      return [x + r * Math.cos(angle), y + r * Math.sin(angle), z];
    };
    for (let k = 0; k < sides; ++k)
      mesh.quad(point(k, radius, low), point(k + 1, radius, low), point(k + 1, top, high), point(k, top, high), colour);
  };
  const leaves = colours.leaves[kind] ?? colours.ground;
  cone(4, 0, 0.25 * height, 0.08 * width, 0.08 * width, colours.trunk);
  cone(7, 0.18 * height, 0.78 * height, 0.5 * width, 0, leaves);
  cone(7, 0.48 * height, height, 0.37 * width, 0, leaves);
}

/** Two rings of hills, the farther and higher one first. */
function hillsGeometry(): BufferGeometry {
  const SIDES = 96;
  const positions: number[] = [];
  for (const [radius, height, shift] of [
    [880, 62, 0.7],
    [760, 34, 2.9],
  ] as const) {
    const crest = (k: number): number => {
      const angle = (2 * Math.PI * k) / SIDES;
      const wave =
        0.5 +
        0.22 * Math.sin(3 * angle + shift) +
        0.16 * Math.sin(7 * angle + 2 * shift) +
        0.12 * Math.sin(17 * angle + 3 * shift);
      return height * Math.max(0.12, wave);
    };
    const corner = (k: number, z: number): [number, number, number] => {
      const angle = (2 * Math.PI * k) / SIDES;
      return [radius * Math.cos(angle), radius * Math.sin(angle), z];
    };
    for (let k = 0; k < SIDES; ++k) {
      const [a, b, c, d] = [corner(k, 0), corner(k + 1, 0), corner(k + 1, crest((k + 1) % SIDES)), corner(k, crest(k))];
      positions.push(...a, ...c, ...b, ...a, ...d, ...c); // seen from inside
    }
  }
  return new BufferGeometry().setAttribute('position', new Float32BufferAttribute(positions, 3));
}
