// The driven car and the ghost car in the scene: materials, wheels, lamps and shadow.
import {
  AdditiveBlending,
  Box3,
  type BufferGeometry,
  Color,
  DataTexture,
  Group,
  LinearFilter,
  type Material,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  MeshStandardMaterial,
  PlaneGeometry,
  RGBAFormat,
  type Scene,
  ShadowMaterial,
  Vector3,
} from 'three';
import { type CarSize, carShape } from '../draw/car';
import { type CarLooks, type CarModel, carModel } from './car_mesh';
import { geometryOf } from './geometry';
import type { MeshData } from './mesh';
import type { Palette } from './palette';

/** Four wheels that steer and roll; the parts are shared. */
class Wheels {
  readonly group = new Group();
  readonly #turns: Group[] = [];
  readonly #rolls: { part: Group; sign: number }[] = [];
  readonly #size: CarSize;

  constructor(model: CarModel, size: CarSize, makeMesh: () => Mesh[]) {
    this.#size = size;
    for (const { x, y } of carShape(size, 0).wheels) {
      const turn = new Group();
      turn.position.set(x, y, model.wheelRadius);
      const side = new Group();
      if (y < 0) side.rotation.z = Math.PI; // outer side outwards
      const roll = new Group();
      roll.add(...makeMesh());
      this.group.add(turn.add(side.add(roll)));
      this.#turns.push(turn);
      this.#rolls.push({ part: roll, sign: y < 0 ? -1 : 1 });
    }
  }

  pose(steer: number, angle: number): void {
    carShape(this.#size, steer).wheels.forEach((wheel, i) => {
      const turn = this.#turns[i];
      if (turn) turn.rotation.z = wheel.angle;
    });
    for (const { part, sign } of this.#rolls) part.rotation.y = sign * angle;
  }
}

/** Pose of the car, its wheels and its body. */
export interface CarPose {
  readonly x: number;
  readonly y: number;
  readonly yaw: number;
  readonly steer: number;
  readonly roll: number; // of the body
  readonly pitch: number;
  readonly wheelAngle: number; // rolled so far [rad]
  readonly isBraking: boolean;
}

/** A texture of one grey with opacity `strength` at u forward and v to the left, both in (−1, 1). */
function softTexture(grey: number, strength: (u: number, v: number) => number): DataTexture {
  const size = 64;
  const bytes = new Uint8Array(size * size * 4);
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const share = strength((2 * (x + 0.5)) / size - 1, (2 * (y + 0.5)) / size - 1);
      bytes.set([grey, grey, grey, Math.round(255 * Math.max(0, Math.min(1, share)))], 4 * (y * size + x));
    }
  }
  const texture = new DataTexture(bytes, size, size, RGBAFormat);
  texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Smooth step from 0 to 1. */
const soft = (edge: number): number => Math.max(0, Math.min(1, edge)) ** 2 * (3 - 2 * Math.max(0, Math.min(1, edge)));

/** The ambient shadow under the car. */
const spotTexture = (): DataTexture =>
  softTexture(0, (u, v) => 0.75 * soft((1 - Math.abs(u)) / 0.45) * soft((1 - Math.abs(v)) / 0.45));

/** The light of the headlamps on the road: a cone that widens and fades. */
const beamTexture = (): DataTexture =>
  softTexture(255, (u, v) => {
    const ahead = (u + 1) / 2;
    const wide = 0.12 + 0.8 * ahead;
    return 0.2 * soft(ahead / 0.25) * soft(1 - ahead) * soft((wide - Math.abs(v)) / (0.9 * wide));
  });

const STEERING_RATIO = 4.5; // of the steering wheel; chosen for the picture

/** The driven car. */
export class CarView {
  readonly model: CarModel;
  readonly group = new Group();
  readonly #scene: Scene;
  readonly #size: CarSize;
  readonly #body = new Group();
  readonly #helmet: Mesh;
  readonly #hand: Mesh;
  readonly #wheels: Wheels;
  readonly #lamps: MeshBasicMaterial;
  readonly #headlamps: MeshBasicMaterial;
  readonly #beam: Mesh;
  readonly #shadow: ShadowMaterial;
  readonly #garbage: { dispose(): void }[] = [];

  constructor(scene: Scene, size: CarLooks) {
    [this.#scene, this.#size] = [scene, size];
    this.model = carModel(size);
    const paint = this.#keep(new MeshStandardMaterial({ vertexColors: true, metalness: 0.15, roughness: 0.38 }));
    const dark = this.#keep(new MeshLambertMaterial({ vertexColors: true }));
    this.#lamps = this.#keep(new MeshBasicMaterial());
    this.#headlamps = this.#keep(new MeshBasicMaterial());
    this.#shadow = this.#keep(new ShadowMaterial({ depthWrite: false }));

    const { model } = this;
    this.#helmet = this.#mesh(model.helmet, paint);
    this.#hand = this.#mesh(model.hand, dark);
    this.#hand.position.set(...model.steeringWheel);
    this.#body.add(
      this.#mesh(model.paint, paint),
      this.#mesh(model.dark, dark),
      this.#mesh(model.lamps, this.#lamps, false),
    );
    this.#body.add(this.#mesh(model.headlamps, this.#headlamps, false), this.#helmet, this.#hand);
    const wheel = this.#keep(geometryOf(model.wheel));
    this.#wheels = new Wheels(model, size, () => {
      const mesh = new Mesh(wheel, dark);
      mesh.castShadow = true;
      return [mesh];
    });
    this.#beam = this.#headlight();
    this.group.add(this.#body, this.#wheels.group, this.#beam, this.#spot(), this.#shadowCatcher());
    scene.add(this.group);
  }

  /** Corners of a box round the car along its own axes, in W [m]. */
  corners(): (readonly [number, number, number])[] {
    const box = new Box3();
    for (const part of this.#body.children) {
      if (!(part instanceof Mesh)) continue;
      const { geometry, matrix } = part as Mesh<BufferGeometry>;
      if (geometry.boundingBox === null) geometry.computeBoundingBox();
      if (geometry.boundingBox) box.union(geometry.boundingBox.clone().applyMatrix4(matrix));
    }
    const { min, max } = box;
    const places = [min.x, max.x].flatMap((x) =>
      [min.y, max.y].flatMap((y) => [0, max.z].map((z) => [x, y, z] as const)),
    );
    return places.map((place) => this.group.localToWorld(new Vector3(...place)).toArray());
  }

  /** Notes a thing to be disposed of with the car. */
  #keep<T extends { dispose(): void }>(thing: T): T {
    this.#garbage.push(thing);
    return thing;
  }

  /** The light of the headlamps on the road, seen at dusk. */
  #headlight(): Mesh {
    const [ahead, wide] = [8 * this.model.length, 3.2 * this.model.length];
    const material = this.#keep(
      new MeshBasicMaterial({
        color: 0xfff0d0,
        map: this.#keep(beamTexture()),
        transparent: true,
        depthWrite: false,
        blending: AdditiveBlending,
      }),
    );
    const beam = new Mesh(this.#keep(new PlaneGeometry(ahead, wide)), material);
    beam.position.x = this.#size.front_axle_m + ahead / 2;
    beam.renderOrder = 0;
    return beam;
  }

  #mesh(data: MeshData, material: Material, hasShadow = true): Mesh {
    const mesh = new Mesh(this.#keep(geometryOf(data)), material);
    mesh.castShadow = hasShadow;
    return mesh;
  }

  /** The soft shadow under the car, which is there without a sun. */
  #spot(): Mesh {
    const { length, width } = this.model;
    const material = this.#keep(
      new MeshBasicMaterial({ color: 0x000000, map: this.#keep(spotTexture()), transparent: true, depthWrite: false }),
    );
    const spot = new Mesh(this.#keep(new PlaneGeometry(length * 1.16, width * 1.2)), material);
    spot.position.x = (this.#size.front_axle_m - this.#size.rear_axle_m) / 2;
    spot.renderOrder = 8;
    return spot;
  }

  /** A plane on the ground that shows the shadow of the sun. */
  #shadowCatcher(): Mesh {
    const catcher = new Mesh(this.#keep(new PlaneGeometry(this.model.length * 3, this.model.length * 3)), this.#shadow);
    catcher.receiveShadow = true;
    catcher.renderOrder = 9;
    return catcher;
  }

  paint(colours: Palette): void {
    this.#headlamps.color = colours.isDark ? new Color().setRGB(1, 0.92, 0.75) : new Color().setRGB(0.75, 0.75, 0.72);
    this.#beam.visible = colours.isDark;
    this.#shadow.opacity = colours.isDark ? 0.3 : 0.34;
  }

  pose(pose: CarPose, seesDriver: boolean): void {
    this.group.position.set(pose.x, pose.y, 0);
    this.group.rotation.z = pose.yaw;
    this.#body.rotation.set(pose.roll, pose.pitch, 0);
    this.#wheels.pose(pose.steer, pose.wheelAngle);
    this.#hand.rotation.x = -STEERING_RATIO * (Number.isFinite(pose.steer) ? pose.steer : 0);
    this.#helmet.visible = seesDriver;
    if (pose.isBraking) this.#lamps.color.setRGB(1, 0.06, 0.03);
    else this.#lamps.color.setRGB(0.13, 0.008, 0.008);
  }

  dispose(): void {
    this.#scene.remove(this.group);
    for (const each of this.#garbage) each.dispose();
  }
}

/** The ghost car: a transparent shape of one colour, fainter close to the driven car. */
export class GhostView {
  readonly #scene: Scene;
  readonly #group = new Group();
  readonly #wheels: Wheels;
  readonly #tint = new MeshLambertMaterial({ transparent: true, fog: true });
  /** Writes depth only, so that the shape does not show through itself. */
  readonly #depthOnly = new MeshBasicMaterial({ colorWrite: false, transparent: true });
  readonly #geometries: BufferGeometry[];

  constructor(scene: Scene, size: CarSize, model: CarModel) {
    this.#scene = scene;
    this.#geometries = [model.paint, model.dark, model.helmet, model.wheel].map(geometryOf);
    const pair = (geometry: BufferGeometry | undefined): Mesh[] => {
      const [depthOnly, tint] = [new Mesh(geometry, this.#depthOnly), new Mesh(geometry, this.#tint)];
      depthOnly.renderOrder = 19;
      tint.renderOrder = 20;
      return [depthOnly, tint];
    };
    this.#wheels = new Wheels(model, size, () => pair(this.#geometries[3]));
    this.#group.add(this.#wheels.group, ...this.#geometries.slice(0, 3).flatMap(pair));
    this.#group.visible = false;
    scene.add(this.#group);
  }

  paint(colours: Palette): void {
    this.#tint.color = new Color().setRGB(...colours.ghost);
    this.#tint.emissive = new Color().setRGB(...colours.ghost).multiplyScalar(0.35);
  }

  hide(): void {
    this.#group.visible = false;
  }

  /** `away`: distance from the driven car [m]. */
  pose(
    pose: { x: number; y: number; yaw: number; steer: number },
    wheelAngle: number,
    away: number,
    carLength: number,
  ): void {
    const share = Math.min(1, Math.max(0, (away / carLength - 0.25) / 1.2));
    this.#tint.opacity = 0.5 * share;
    this.#group.visible = share > 0;
    this.#group.position.set(pose.x, pose.y, 0);
    this.#group.rotation.z = pose.yaw;
    this.#wheels.pose(pose.steer, wheelAngle);
  }

  dispose(): void {
    this.#scene.remove(this.#group);
    for (const geometry of this.#geometries) geometry.dispose();
    this.#tint.dispose();
    this.#depthOnly.dispose();
  }
}
