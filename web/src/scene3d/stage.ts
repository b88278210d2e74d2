// The 3D picture: scene, lights, camera and drawing, in the quality that the machine manages.
import {
  Color,
  DirectionalLight,
  HemisphereLight,
  PerspectiveCamera,
  PMREMGenerator,
  Scene,
  SRGBColorSpace,
  Vector3,
  WebGLRenderer,
  type WebGLRenderTarget,
} from 'three';
import { aheadOf, type Line } from '../draw/line';
import { paintSize } from '../lib/paint_size';
import type { Pose } from '../lib/poses';
import type { Limit, Plan, Run } from '../protocol/topics';
import type { CursorMark } from '../state/cursor';
import { BodyMotion } from './body_motion';
import { CameraMan, type CameraName, type Shot } from './cameras';
import { CarView, GhostView } from './car_view';
import type { GhostSource } from './ghost';
import { Landscape } from './landscape';
import type { Motion } from './motion';
import { type Palette, palette } from './palette';
import { QualityGovernor } from './quality';
import { BandView, RingView } from './ribbon_view';
import { tidyLines } from './road_mesh';
import { RoadView } from './road_view';
import type { Session } from './session';
import { SlowPicture } from './slow_picture';
import { plantTrees } from './trees';
import type { View } from './view';

const NO_LINE: Line = { x: [], y: [] };

/** Where things are in the last picture [CSS pixels]. */
export interface Geometry {
  readonly picture: { readonly camera: CameraName | null; readonly aspect: number };
  readonly corners: readonly (readonly [number, number])[]; // of the car's box
  readonly plan: readonly (readonly [number, number])[];
  readonly horizon: number;
}

/** Distance below which nothing is drawn, for a full-size car; chosen: the steering wheel is farther from the eyes. */
const NEAR_M = 0.12;
/** Time after the last change for which drawing goes on, until the camera has settled [ms]; chosen. */
const SETTLE_MS = 1200;
/** Length of the car for which widths of lines are meant [m]. */
const FULL_LENGTH_M = 4.5;

/** The three-dimensional picture on one canvas. */
export class Stage {
  readonly #canvas: HTMLCanvasElement;
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(55, 1, NEAR_M, 2400);
  readonly #sun = new DirectionalLight();
  readonly #skyLight = new HemisphereLight();
  readonly #landscape: Landscape;
  readonly #road: RoadView;
  readonly #rings: Readonly<Record<'trace' | 'rubber' | 'lost', RingView>>; // by their colours
  readonly #bands: Readonly<Record<'ghost' | 'racingLine' | 'predicted' | 'outcome' | 'plan' | 'act', BandView>>;
  readonly #governor: QualityGovernor;
  readonly #slow: SlowPicture | null; // with software rendering
  readonly #cameraMan = new CameraMan();
  readonly #body = new BodyMotion();
  #environment: WebGLRenderTarget | null = null;
  #palette: Palette = palette();
  #car: CarView | null = null;
  #ghost: GhostView | null = null;
  #carKey = '';
  #roadKey = '';
  #lineShown: Float32Array | null = null;
  #planShown: Plan | null = null;
  #ahead: Line = NO_LINE; // the plan that is drawn
  #limitShown: Limit | null = null;
  #jumps = -1;
  #runTime = NaN;
  #wheelAngle = 0;
  #lastPicture = -Infinity;
  #lastChange = 0;
  #changeKey = '';
  #wasCamera: CameraName | null = null;
  #shaders: 'none' | 'asked for' | 'there' = 'none';
  #hasPicture = false;

  /** `isSoftware`: rendered by the processor, with cheaper settings. Throws where the browser offers no WebGL 2. */
  constructor(canvas: HTMLCanvasElement, session: Session, isSoftware: boolean) {
    this.#canvas = canvas;
    this.#renderer = new WebGLRenderer({ canvas, antialias: !isSoftware, preserveDrawingBuffer: isSoftware });
    this.#renderer.outputColorSpace = SRGBColorSpace;
    // The shaders are the library's own, and asking for errors waits until they are compiled.
    this.#renderer.debug.checkShaderErrors = false;
    this.#governor = new QualityGovernor(isSoftware);
    this.#slow = isSoftware ? new SlowPicture(this.#renderer) : null;
    const anisotropy = Math.min(isSoftware ? 1 : 8, this.#renderer.capabilities.getMaxAnisotropy());
    this.#camera.up.set(0, 0, 1);
    this.#landscape = new Landscape(this.#scene, anisotropy);
    this.#road = new RoadView(this.#scene, anisotropy);
    this.#rings = {
      trace: new RingView(this.#scene, session.trace, 2, 0.65),
      rubber: new RingView(this.#scene, session.marks.ring, 3, 0.75),
      lost: new RingView(this.#scene, session.brakes, 4, 0.8),
    };
    this.#bands = {
      ghost: new BandView(this.#scene, 20_000, 1),
      racingLine: new BandView(this.#scene, 8192, 1.5),
      predicted: new BandView(this.#scene, 512, 6),
      outcome: new BandView(this.#scene, 512, 7),
      plan: new BandView(this.#scene, 512, 8),
      act: new BandView(this.#scene, 2, 9), // the cursor
    };
    this.#sun.shadow.mapSize.set(1024, 1024);
    this.#scene.add(this.#sun, this.#sun.target, this.#skyLight);
    this.repaint();
  }

  /** Whether there is something to see on the canvas. */
  get hasPicture(): boolean {
    return this.#hasPicture;
  }

  /** Applies the palette after a change of the colour scheme. */
  repaint(): void {
    this.#palette = palette();
    const { zenith, ground, sun, sky, isDark } = this.#palette;
    this.#landscape.paint(this.#palette);
    this.#sun.intensity = sun;
    this.#sun.color = new Color(isDark ? '#b9cdf5' : '#fff3df');
    this.#skyLight.color = new Color().setRGB(...zenith).lerp(new Color('#ffffff'), isDark ? 0.25 : 0.6);
    this.#skyLight.groundColor = new Color().setRGB(...ground);
    this.#skyLight.intensity = this.#slow ? 1.25 * sky : sky; // replaces the reflections
    const lines = { ...this.#rings, ...this.#bands };
    for (const name of Object.keys(lines) as (keyof typeof lines)[]) lines[name].paint(this.#palette[name]);
    this.#car?.paint(this.#palette);
    this.#ghost?.paint(this.#palette);
    this.#roadKey = '';
    this.#reflectSky();
    this.#lastChange = performance.now();
  }

  /**
   * The car's paint reflects this sky; not with software rendering, where blurring the sky took five to eight seconds.
   */
  #reflectSky(): void {
    if (this.#slow) return;
    this.#environment?.dispose();
    const generator = new PMREMGenerator(this.#renderer);
    const empty = new Scene();
    const sky = new Landscape(empty, 1);
    sky.paint(this.#palette);
    this.#environment = generator.fromScene(empty, 0.02, 0.1, 2000);
    sky.dispose();
    generator.dispose();
    this.#scene.environment = this.#environment.texture;
    this.#scene.environmentIntensity = this.#palette.isDark ? 0.9 : 0.5;
  }

  /** Draws when the picture has changed. */
  paint(now: number, view: View): void {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (width === 0 || height === 0 || this.#renderer.getContext().isContextLost()) return;
    if (this.#shaders !== 'there') {
      this.#compile(now, view);
      return;
    }
    if (this.#slow?.show(now)) this.#hasPicture = true;
    const gap = now - this.#lastPicture;
    if (gap < this.#governor.quality.interval - 4 || this.#slow?.isFree(now) === false) return;
    const motion = view.session.playout.advance(now, view.isHeld);
    if (!this.#isWorth(now, view, motion, width, height)) return;

    const begin = performance.now();
    this.#lastPicture = now;
    this.#renew(view);
    const passed = this.#move(view, motion);
    this.#layPlan(view.plan, motion);
    // In fast motion and after a pause of the page the camera follows the run's time.
    this.#film(view, motion, width / height, Math.max(Math.min(gap, 1000) / 1000, passed));
    this.#draw(width, height, now);
    if (this.#governor.picture(gap, performance.now() - begin)) this.#lastChange = now;
  }

  /** Compiles the shaders in the background; drawing before would block the page until they are compiled. */
  #compile(now: number, view: View): void {
    if (this.#shaders === 'asked for') {
      if (this.#slow?.isCompiled(now)) this.#begin();
      return;
    }
    if (!view.run) return; // the shaders of the car are not known yet
    this.#shaders = 'asked for';
    this.#renew(view);
    this.#setShadow();
    if (this.#slow) this.#slow.compile(this.#scene, this.#camera, now);
    else if (this.#renderer.extensions.has('KHR_parallel_shader_compile'))
      void this.#renderer.compileAsync(this.#scene, this.#camera).then(() => this.#begin());
    else this.#begin();
  }

  /** Begins to draw: the shaders are compiled. */
  #begin(): void {
    this.#shaders = 'there';
    this.#lastChange = performance.now();
  }

  /** Whether the picture has changed, or changed a moment ago. */
  #isWorth(now: number, view: View, motion: Motion | null, width: number, height: number): boolean {
    const key = [
      motion?.time,
      motion?.x,
      motion?.yaw,
      view.camera,
      ...Object.values(view.orbit),
      width,
      height,
      view.roadVersion,
      view.hindsight === null,
      view.racingLine === null,
      view.cursor?.x,
      view.cursor?.y,
    ].join();
    if (key !== this.#changeKey || view.plan !== this.#planShown) {
      this.#changeKey = key;
      this.#lastChange = now;
    }
    return now - this.#lastChange < SETTLE_MS;
  }

  /** Draws the scene at the resolution of the present quality. */
  #draw(width: number, height: number, now: number): void {
    const { pixelRatio } = this.#governor.quality;
    const ratio = Math.min(devicePixelRatio, pixelRatio);
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    this.#setShadow();
    if (this.#slow) {
      this.#slow.draw(this.#scene, this.#camera, w, h, now);
      return;
    }
    if (this.#canvas.width !== w || this.#canvas.height !== h) this.#renderer.setSize(w, h, false);
    this.#renderer.render(this.#scene, this.#camera);
    this.#hasPicture = true;
  }

  #setShadow(): void {
    this.#sun.castShadow = this.#renderer.shadowMap.enabled = this.#governor.quality.hasShadow;
  }

  /** Rebuilds what changes rarely: car, road, lines. */
  #renew(view: View): void {
    const { run } = view;
    if (run) {
      const { car, front_axle_m, rear_axle_m, track_width_m, tire_width_m, body_length_m, body_width_m } = run;
      const carKey = [car, front_axle_m, rear_axle_m, track_width_m, tire_width_m, body_length_m, body_width_m].join();
      if (carKey !== this.#carKey) this.#renewCar(run, carKey);
      const size = paintSize(run);
      const roadKey = [view.roadVersion, run.is_closed, run.kerb_width_m, size].join();
      if (roadKey !== this.#roadKey) {
        this.#roadKey = roadKey;
        const lines = tidyLines(view.road, run.is_closed);
        this.#road.show(lines, run.is_closed, run.kerb_width_m, this.#palette, size);
        this.#landscape.plant(lines ? plantTrees(lines) : [], this.#palette);
      }
    }
    const width = run ? paintSize(run) : 1;
    const line = view.ghost?.line ?? null;
    if (line !== this.#lineShown) {
      this.#lineShown = line;
      const every = (axis: number): Float32Array => (line ?? new Float32Array()).filter((_, i) => i % 2 === axis);
      this.#bands.ghost.show({ x: every(0), y: every(1) }, 0.3 * width, 0.55);
    }
    if (view.racingLine !== this.#limitShown) {
      this.#limitShown = view.racingLine;
      const { x_m: x, y_m: y } = view.racingLine ?? { x_m: [], y_m: [] };
      this.#bands.racingLine.show({ x, y }, 0.22 * width, 0.75);
    }
    const size = this.#size;
    const { plan, drivenX, drivenY } = view.hindsight ?? { plan: { x_m: [], y_m: [] }, drivenX: [], drivenY: [] };
    this.#bands.predicted.show({ x: plan.x_m, y: plan.y_m }, 1.2 * size, 0.6);
    this.#bands.outcome.show({ x: drivenX, y: drivenY }, 0.2 * size, 1);
    this.#showCursor(view.cursor, size);
    for (const ring of Object.values(this.#rings)) ring.update();
  }

  /** The plan from where the car is now. */
  #layPlan(plan: Plan | null, motion: Motion | null): void {
    this.#planShown = plan;
    this.#ahead = plan && motion ? aheadOf({ x: plan.x_m, y: plan.y_m }, motion) : NO_LINE;
    this.#bands.plan.show(this.#ahead, 0.5 * this.#size, 0.9);
  }

  /** Scale of lines: 1 for a full-size car. */
  get #size(): number {
    return (this.#car?.model.length ?? FULL_LENGTH_M) / FULL_LENGTH_M;
  }

  /** Shows the cursor of the plots as a bar across the road. */
  #showCursor(mark: CursorMark | null, size: number): void {
    const [dx, dy] = mark ? [-Math.sin(mark.yaw) * 5 * size, Math.cos(mark.yaw) * 5 * size] : [0, 0];
    const ends = mark ? [1, -1] : [];
    const line = {
      x: ends.map((side) => (mark?.x ?? 0) + side * dx),
      y: ends.map((side) => (mark?.y ?? 0) + side * dy),
    };
    this.#bands.act.show(line, 0.5 * size, 1);
  }

  /** Builds another car with its ghost. */
  #renewCar(run: Run, key: string): void {
    this.#carKey = key;
    this.#lineShown = this.#limitShown = null; // their width is the car's
    this.#camera.near = NEAR_M * paintSize(run);
    this.#car?.dispose();
    this.#ghost?.dispose();
    this.#car = new CarView(this.#scene, run);
    this.#ghost = new GhostView(this.#scene, run, this.#car.model);
    this.#car.paint(this.#palette);
    this.#ghost.paint(this.#palette);
    const reach = this.#car.model.length;
    const shadow = this.#sun.shadow.camera;
    Object.assign(shadow, { left: -reach, right: reach, bottom: -reach, top: reach, near: 1, far: 10 * reach });
    shadow.updateProjectionMatrix();
    this.#sun.shadow.bias = -0.002;
  }

  /** Moves car, sun and ghost to their poses; returns the run time since the last picture [s]. */
  #move(view: View, motion: Motion | null): number {
    const car = this.#car;
    if (car) car.group.visible = motion !== null;
    if (!car || !motion) return 0;
    if (view.session.playout.jumps !== this.#jumps || motion.time < this.#runTime) {
      this.#jumps = view.session.playout.jumps;
      this.#runTime = motion.time;
      this.#cameraMan.cut();
      this.#body.rest();
    }
    const passed = Math.max(0, motion.time - this.#runTime);
    this.#runTime = motion.time;
    this.#wheelAngle = (this.#wheelAngle + (motion.vx * passed) / car.model.wheelRadius || 0) % (2 * Math.PI);
    if (view.hasReducedMotion) this.#body.rest();
    else this.#body.advance(passed, motion.ax, motion.ay);
    const { roll, pitch } = this.#body;
    const pose = {
      x: motion.x,
      y: motion.y,
      yaw: motion.yaw,
      steer: motion.steer,
      roll,
      pitch,
      wheelAngle: this.#wheelAngle,
      isBraking: motion.throttle < -0.02,
    };
    car.pose(pose, view.camera !== 'cockpit');
    const away = 6 * car.model.length;
    this.#sun.target.position.set(motion.x, motion.y, 0);
    this.#sun.position.set(motion.x - 0.45 * away, motion.y + 0.35 * away, 0.8 * away);
    this.#moveGhost(view.ghost, motion, car.model.length);
    return passed;
  }

  readonly #ghostPose: Pose = { x: 0, y: 0, yaw: 0, steer: 0 };

  /** Moves the ghost to its pose, or hides it. */
  #moveGhost(source: GhostSource | null, motion: Motion, length: number): void {
    const pose = this.#ghostPose;
    if (!source?.poseAt(motion.lapTime, pose)) this.#ghost?.hide();
    else this.#ghost?.pose(pose, this.#wheelAngle, Math.hypot(pose.x - motion.x, pose.y - motion.y), length);
  }

  /** Places the camera. */
  #film(view: View, motion: Motion | null, aspect: number, seconds: number): void {
    if (view.camera !== this.#wasCamera) this.#cameraMan.cut();
    this.#wasCamera = view.camera;
    const model = this.#car?.model;
    const start = view.road.centre[0];
    const subject = {
      x: motion?.x ?? start?.x ?? 0,
      y: motion?.y ?? start?.y ?? 0,
      yaw: motion?.yaw ?? 0,
      speed: motion?.speed ?? 0,
      length: model?.length ?? FULL_LENGTH_M,
      eye: model?.eye ?? ([0, 0, 1] as const),
    };
    const lens = { aspect, plan: this.#ahead, orbit: view.orbit, isCut: view.hasReducedMotion };
    const shot: Shot = this.#cameraMan.shoot(view.camera, subject, lens, seconds);
    const camera = this.#camera;
    camera.position.set(...shot.position);
    camera.up.set(...shot.up);
    camera.lookAt(...shot.target);
    camera.fov = (shot.fieldOfView * 180) / Math.PI;
    camera.aspect = aspect;
    camera.updateProjectionMatrix();
    this.#landscape.follow(shot.position[0], shot.position[1]);
  }

  /** Where the car's box and the plan are in the last picture, and the horizon; null without a car. */
  geometry(): Geometry | null {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (!this.#car || width === 0) return null;
    const point = new Vector3();
    const at = (x: number, y: number, z: number): [number, number] => {
      point.set(x, y, z).project(this.#camera);
      return [((point.x + 1) / 2) * width, ((1 - point.y) / 2) * height];
    };
    const corners = this.#car.corners().map(([x, y, z]) => at(x, y, z));
    const points = Array.from(this.#ahead.x, (x, i) => at(x, this.#ahead.y[i] ?? NaN, 0));
    const { position } = this.#camera;
    this.#camera.getWorldDirection(point);
    const horizon = at(position.x + 1e6 * point.x, position.y + 1e6 * point.y, 0)[1];
    const picture = { camera: this.#wasCamera, aspect: this.#camera.aspect };
    return { picture, corners, plan: points, horizon };
  }

  dispose(): void {
    this.#car?.dispose();
    this.#ghost?.dispose();
    this.#landscape.plant([], this.#palette);
    for (const part of [this.#landscape, this.#road, ...Object.values(this.#rings), ...Object.values(this.#bands)])
      part.dispose();
    this.#environment?.dispose();
    this.#sun.dispose();
    this.#slow?.dispose();
    this.#renderer.dispose();
  }
}
