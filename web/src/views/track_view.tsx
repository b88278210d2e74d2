// The picture of the car on its road: from above on a canvas, or in 3D by scene3d, with the camera's name, the key of
// its lines and the small map over it.
import { useEffect, useRef } from 'preact/hooks';
import { CachedPicture, isSame } from '../draw/cached_picture';
import { allRound, behind, type Camera, fitting, project, unproject, zoomed } from '../draw/camera';
import { carShape } from '../draw/car';
import { aheadOf, type Line as RoadLine } from '../draw/line';
import { Paper } from '../draw/paper';
import {
  drawCursor,
  drawDot,
  drawMoving,
  drawOutline,
  drawWorld,
  type RoadShape,
  roadShape,
  type Scene,
} from '../draw/scene';
import { onThemeChange, theme } from '../draw/theme';
import { fixed } from '../lib/format';
import { type Box, boundsOf, extrapolate, type Point, wrapAngle } from '../lib/math';
import { paintSize } from '../lib/paint_size';
import type { Pose } from '../lib/poses';
import { store } from '../lib/store';
import { inSpeedUnit, speedUnit } from '../lib/units';
import { Select } from '../parts/controls';
import { Scene3dView } from '../scene3d/scene3d_view';
import { session } from '../scene3d/session';
import { ALL_CAMERAS, camera, camera3d, choose, obstacle, shows3d, zoomCamera } from '../scene3d/view_state';
import { lossesToLimit, markedCorners } from '../state/compared';
import { cursorMark, pointAt, timeNear } from '../state/cursor';
import { faultMarks } from '../state/faults';
import { hindsight } from '../state/hindsight';
import { lapSamples } from '../state/laps';
import { layers } from '../state/layers';
import { limit } from '../state/limit';
import { link } from '../state/link';
import { live } from '../state/live';
import { road } from '../state/road';
import { isPaused, run } from '../state/run';
import { seekTo } from '../state/seek';
import { shown } from '../state/shown';
import { everyFrame } from '../state/ticker';

/** Least time between two paints of the small map; chosen. */
const SMALL_MAP_INTERVAL_MS = 80;
/** Space round the whole track for the camera's name and the numbers of corners [px]. */
const ROUND_TRACK = { top: 64, right: 56, bottom: 40, left: 56 };
/** View without road and car [m]. */
const EMPTY_VIEW: Box = { minX: 0, minY: 0, maxX: 100, maxY: 60 };
/** Longest extrapolation of the car's pose, if frames stop to arrive [s]; chosen. */
const LONGEST_EXTRAPOLATION_S = 0.1;
/** Time in which the view turns to the car's heading: it does not follow every movement of the wheel; chosen. */
const TURNING_TIME_MS = 250;
/** Logarithm of the zoom for each step of the mouse wheel [1/px]: 100 px are 16 %; chosen. */
const ZOOM_PER_PIXEL = 0.0015;

/** Width of the road that the camera behind the car shows [m], for a full-size car. */
const metresAcross = store.signal('page', 100);
/** Name of the ghost car in the key; null: none is shown. */
const ghostLabel = store.signal<string | null>('page', null);

/** Multiplies the width of the view. */
export function zoom(factor: number): void {
  if (shows3d.value) zoomCamera(factor);
  else metresAcross.value = zoomed(metresAcross.value, factor);
}

/** Lines of the road in the form that is drawn; renew() updates them if the road has changed. */
class Road {
  shape: RoadShape | null = null;
  box: Box | null = null;
  #version = -1;

  renew(): void {
    if (this.#version === road.version) return;
    this.#version = road.version;
    this.shape = roadShape(road.lines);
    this.box = boundsOf([...road.lines.left, ...road.lines.right]);
  }
}

/** Car with its pose extrapolated to `now` [ms], because frames arrive less often than repaints. */
function carNow(now: number): Scene['car'] {
  const { frame } = live;
  const size = run.value;
  if (!frame || !size) return null;
  const isMoving = link.value === 'live' && !isPaused.value;
  const age = isMoving ? Math.min(Math.max(0, now - live.receivedAt) / 1000, LONGEST_EXTRAPOLATION_S) : 0;
  const motion = { vx: frame.vx_mps, vy: frame.vy_mps, yawRate: frame.yaw_rate_radps };
  const pose = extrapolate({ x: frame.x_m, y: frame.y_m, yaw: frame.yaw_rad }, motion, age);
  return { ...pose, isBraking: frame.throttle_applied < 0, shape: carShape(size, frame.steer_applied_rad) };
}

/** The part of the plan that lies ahead of the car. */
const planAhead = (car: Scene['car']): RoadLine =>
  live.plan && car ? aheadOf({ x: live.plan.x_m, y: live.plan.y_m }, car) : { x: [], y: [] };

const pointsOf = ({ x, y }: RoadLine): Point[] => Array.from(x, (each, i) => ({ x: each, y: y[i] ?? NaN }));

/** Part of the scene that rarely changes. */
function worldOf(shape: RoadShape | null) {
  const isWhole = camera.value !== 'ahead';
  return {
    road: shape,
    racingLine: layers.racingLine.value ? limit.value : null,
    corners: markedCorners(),
    kerb: run.value?.kerb_width_m ?? 0,
    isWhole,
    start: lapSamples.line,
    losses: isWhole ? lossesToLimit.value : null,
    size: run.value ? paintSize(run.value) : 1,
  };
}

/** The whole scene of this moment. */
function sceneOf(world: ReturnType<typeof worldOf>, car: Scene['car'], plan: RoadLine, ghost: Pose | null): Scene {
  return {
    ...world,
    reference: road.reference,
    // The driven path is left out where it would cover the coloured lap.
    trace: world.losses ? { x: [], y: [] } : { x: live.trace.column(0), y: live.trace.column(1) },
    plan,
    hindsight: layers.hindsight.value ? hindsight(live.pastPlans, live.plots, live.frame?.time_s ?? NaN) : null,
    faults: faultMarks.value,
    ghost,
    car,
  };
}

/** Camera and moving objects of a picture, from which the mouse and tests ask where things are. */
interface Painted {
  readonly seen: Camera;
  readonly picture: { readonly camera: string; readonly aspect: number };
  readonly car: Scene['car'];
  readonly plan: readonly Point[];
}

/** Paints the track from above; keeps state from one picture to the next. */
class Painter {
  readonly #paper: Paper;
  readonly #road = new Road();
  #heading = NaN; // smoothed yaw of the car [rad]
  #lastPaint = 0; // [ms]
  #last: Painted | null = null;
  #lastKey: readonly unknown[] = []; // all values that the last picture shows
  #worldKey: readonly unknown[] = []; // the part of them that drawWorld() shows
  readonly #world = new CachedPicture(); // what worldOf() describes
  readonly #ghost: Pose = { x: 0, y: 0, yaw: 0, steer: 0 };

  constructor(canvas: HTMLCanvasElement) {
    this.#paper = new Paper(canvas);
  }

  paint(now: number): void {
    if (shows3d.value) return;
    const { canvas, box } = this.#paper;
    const paper = this.#paper.prepare();
    if (!paper) return;
    const { context, ratio } = paper;
    this.#road.renew();
    const car = carNow(now);
    const planned = planAhead(car);
    const plan = pointsOf(planned);
    const seen = this.#camera(car, plan, now, box.width, box.height);
    this.#lastPaint = now;
    const ghost = session.ghost?.poseAt(live.frame?.lap_time_s ?? NaN, this.#ghost) ? this.#ghost : null;
    const world = worldOf(this.#road.shape);
    const scene = sceneOf(world, car, planned, ghost);
    const mark = cursorMark();
    const { centre, scale, rotation } = seen;
    const still = [centre.x, centre.y, scale, rotation, canvas.width, canvas.height, theme(), ...Object.values(world)];
    const moving = [live.frame, live.plan, road.reference, live.trace.newest(0), scene.hindsight?.plan, scene.faults];
    const places = [car, ghost, mark].flatMap((each) => [each?.x, each?.y]).concat(car?.yaw);
    const key = [...still, ...moving, ...places];
    if (isSame(key, this.#lastKey)) return; // as in a paused run
    this.#lastKey = key;
    this.#last = { seen, picture: { camera: camera.value, aspect: box.width / box.height }, car, plan };
    this.#drawWorld(context, scene, seen, still, ratio);
    drawMoving(context, scene, seen, ratio);
    if (mark) drawCursor(context, mark, seen, ratio);
  }

  /** Draws the static part, or copies it from #world while `key`, which has the camera, stays the same. */
  #drawWorld(
    context: CanvasRenderingContext2D,
    scene: Scene,
    seen: Camera,
    key: readonly unknown[],
    ratio: number,
  ): void {
    const isStill = isSame(key, this.#worldKey);
    this.#worldKey = key;
    if (!isStill) {
      drawWorld(context, scene, seen, ratio);
      return;
    }
    const { width, height } = this.#paper.canvas;
    context.setTransform(1, 0, 0, 1, 0, 0);
    const picture = this.#world.picture(key, width, height, (own) => drawWorld(own, scene, seen, ratio));
    context.drawImage(picture, 0, 0);
  }

  end(): void {
    this.#paper.box.end();
  }

  /** Point of the world at a place of the canvas [CSS pixels]; null before the first picture. */
  worldAt(at: Point): Point | null {
    return this.#last && unproject(this.#last.seen, at);
  }

  /** Corners of the car and points of the plan in the last picture [CSS pixels]; null without a car. */
  geometry() {
    if (!this.#last?.car) return null;
    const { seen, picture, car, plan } = this.#last;
    const at = (point: Point): number[] => {
      const { x, y } = project(seen, point);
      return [x, y];
    };
    const [cos, sin] = [Math.cos(car.yaw), Math.sin(car.yaw)];
    const { front, rear, halfWidth } = car.shape;
    const corners = [front, rear].flatMap((x) =>
      [-halfWidth, halfWidth].map((y) => at({ x: car.x + x * cos - y * sin, y: car.y + x * sin + y * cos })),
    );
    return { picture, corners, plan: plan.map(at) };
  }

  /** The camera behind the car, turned with it smoothly; or one that shows the whole track. */
  #camera(car: Scene['car'], plan: readonly Point[], now: number, width: number, height: number): Camera {
    if (camera.value !== 'ahead' || !car) {
      const all = this.#road.box ?? boundsOf(car ? [car, ...road.reference] : []) ?? EMPTY_VIEW;
      return fitting(all, width, height, ROUND_TRACK);
    }
    const across = metresAcross.value * (run.value ? paintSize(run.value) : 1);
    const elapsed = (now - this.#lastPaint) * Math.max(1, live.frame?.pace || 1); // [ms] of the run, if it is faster
    const share = Number.isNaN(this.#heading) ? 1 : 1 - Math.exp(-elapsed / TURNING_TIME_MS);
    const from = Number.isNaN(this.#heading) ? car.yaw : this.#heading;
    this.#heading = from + wrapAngle(car.yaw - from) * share;
    return behind(car, this.#heading, width, height, across, plan, ROUND_TRACK.top);
  }
}

/** Small map over the sky of the 3D picture: the track, coloured by the time lost to the limit, and the car. */
function SmallMap() {
  const element = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    if (!element.current) return undefined;
    const paper = new Paper(element.current);
    const lines = new Road();
    const still = new CachedPicture();
    let last = 0;
    const stop = everyFrame((now) => {
      if (now - last < SMALL_MAP_INTERVAL_MS) return;
      last = now;
      lines.renew();
      const { shape, box } = lines;
      const ready = shape && box && paper.prepare();
      if (!ready) return;
      const { context, ratio } = ready;
      const losses = lossesToLimit.value;
      const { width, height } = paper.canvas;
      const seen = fitting(box, paper.box.width, paper.box.height, allRound(10));
      const picture = still.picture([shape, losses, theme(), width, height], width, height, (own) => {
        drawOutline(own, shape, losses, seen, ratio);
      });
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.clearRect(0, 0, width, height);
      context.drawImage(picture, 0, 0);
      const car = carNow(now);
      if (car) drawDot(context, car, seen, ratio);
    });
    return () => {
      stop();
      paper.box.end();
    };
  }, []);
  return <canvas ref={element} class="small-map" role="img" aria-label="Map: where time is lost to the limit" />;
}

/** Description of the picture for people who do not see it. */
function describePicture(): string {
  const frame = shown.value;
  const what = shows3d.value ? 'Picture' : 'Map';
  if (!frame) return `${what} of the track, no car yet`;
  const place = frame.is_off_track ? 'off the road' : 'on the road';
  return `${what} of the track: the car is ${place} at ${fixed(inSpeedUnit(frame.speed_mps), 0)} ${speedUnit().spoken}`;
}

/** Entry of the key: a line's name in its colour. */
const Line = ({ name, token, kind = '' }: { name: string; token: string; kind?: string }) => (
  <span class={`key line-key ${kind}`} style={{ '--tone': `var(--${token})` }}>
    {name}
  </span>
);

/** Selection of the camera, and the key of the lines on the road. */
function Corner() {
  void shown.value; // renders again with each frame: live.plan is no signal
  const ghost = ghostLabel.value;
  return (
    <div class="corner row">
      <Select
        class="camera"
        label="Camera"
        keys="C"
        title="Camera (C)"
        value={camera.value}
        choices={ALL_CAMERAS}
        choose={choose}
      />
      {live.plan !== null && <Line name="plan" token="road-plan" />}
      {layers.racingLine.value && limit.value && <Line name="the limit's line" token="other" />}
      {layers.hindsight.value && <Line name="plan 1 s ago" token="road-past" kind="past" />}
      {ghost !== null && <Line name={ghost} token="other" kind="ghost" />}
      {obstacle.value !== null && <span role="status">{obstacle.value}</span>}
    </div>
  );
}

/** A canvas that is painted with every frame of the browser; wheel and click zoom and point at the road. */
function usePainter() {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    if (!canvas.current) return undefined;
    const element = canvas.current;
    const painter = new Painter(element);
    const onWheel = (event: WheelEvent): void => {
      if (event.ctrlKey) return;
      event.preventDefault();
      zoom(Math.exp(event.deltaY * ZOOM_PER_PIXEL));
    };
    const onClick = (event: MouseEvent): void => {
      const point = painter.worldAt({ x: event.offsetX, y: event.offsetY });
      if (!point) return;
      const seek = seekTo.value;
      const time = seek && timeNear(point.x, point.y);
      if (!seek) pointAt(point.x, point.y);
      else if (time !== null) seek(time);
    };
    // Tests ask by an event where car and plan are, to see whether anything covers them.
    const answer = (event: Event): void => void Object.assign(event, { geometry: painter.geometry() });
    const over = new AbortController();
    const { signal } = over;
    element.addEventListener('click', onClick, { signal });
    element.addEventListener('wheel', onWheel, { passive: false, signal });
    element.addEventListener('geometry', answer, { signal });
    const stop = everyFrame((now) => {
      painter.paint(now);
      const label = session.ghost?.label ?? null;
      if (ghostLabel.value !== label) ghostLabel.value = label;
    });
    const unwatch = onThemeChange(() => painter.paint(performance.now()));
    return () => {
      stop();
      painter.end();
      unwatch();
      over.abort();
    };
  }, []);
  return canvas;
}

/** The car on the road, over the whole view. */
export function TrackView() {
  const canvas = usePainter();
  const label = describePicture();
  const isInSky = shows3d.value && (camera3d.value === 'chase' || camera3d.value === 'cockpit');
  return (
    <section class={shows3d.value ? 'map has-3d' : 'map'} aria-label="Picture">
      {camera3d.value !== null && <Scene3dView label={label} />}
      <canvas ref={canvas} class="map-2d cover" role="img" aria-label={label} hidden={shows3d.value} />
      {isInSky && <SmallMap />}
      <Corner />
    </section>
  );
}
