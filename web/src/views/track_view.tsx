import { useEffect, useRef } from 'preact/hooks';
import { CachedPicture, isSame } from '../draw/cached_picture';
import {
  above,
  behind,
  type Camera,
  fitting,
  LEGEND_PX,
  NUMBERS_PX,
  scaleBar,
  unproject,
  zoomed,
} from '../draw/camera';
import { carShape } from '../draw/car';
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
import { topOfScale } from '../draw/speed_colour';
import { onThemeChange, theme } from '../draw/theme';
import { fixed } from '../lib/format';
import { type Box, boundsOf, extrapolate, type Point, wrapAngle } from '../lib/math';
import { type OnScreen, onScreen } from '../lib/on_screen';
import { paintSize } from '../lib/paint_size';
import { store } from '../lib/store';
import { inSpeedUnit, speedUnit } from '../lib/units';
import { CAMERAS } from '../scene3d/cameras';
import type { GhostPose } from '../scene3d/ghost';
import { Scene3dView } from '../scene3d/scene3d_view';
import { session } from '../scene3d/session';
import { camera, choose, type Dimension, nextCamera, shows3d, wants3d, zoomCamera } from '../scene3d/view_state';
import { lossesNow, markedCorners, startLine } from '../state/compared';
import { cursorMark, pointAt, timeNear } from '../state/cursor';
import { faultMarks } from '../state/faults';
import { hindsight } from '../state/hindsight';
import { layers } from '../state/layers';
import { isRoomy } from '../state/layout';
import { limit } from '../state/limit';
import { link } from '../state/link';
import { live } from '../state/live';
import { isStageAlone, togglePresentation } from '../state/presentation';
import { road } from '../state/road';
import { isPaused, run } from '../state/run';
import { seekTo } from '../state/seek';
import { shown } from '../state/shown';
import { tab } from '../state/tab';
import { everyFrame } from '../state/ticker';
import { AlertsView, dangerNow, HudView } from './hud_view';
import { InstrumentsView } from './instruments_view';
import { LegendView } from './legend_view';

export type View = 'behind' | 'above' | 'whole';

const VIEWS: readonly { view: View; label: string; title: string }[] = [
  { view: 'behind', label: 'Chase', title: 'Follow the car, looking ahead (C)' },
  { view: 'above', label: 'North up', title: 'Follow the car, north up (C)' },
  { view: 'whole', label: 'Whole track', title: 'See the whole track (C)' },
];

export const view = store.signal<View>('page', 'behind');
const INSET_INTERVAL_MS = 80; // the small map beside the 3D picture

const metresAcross = store.signal('page', 100); // for a full-size car
const bar = store.signal('page', { metres: 10, pixels: 80 });
const scaleTop = store.signal('page', 10); // [m/s]
const ghostLabel = store.signal<string | null>('page', null);

/** The next camera in 3D, or the next view of the map. */
export function nextView(): void {
  if (shows3d.value) {
    nextCamera();
    return;
  }
  const at = VIEWS.findIndex((each) => each.view === view.value);
  view.value = VIEWS[(at + 1) % VIEWS.length]?.view ?? 'behind';
}

/** Switches between 3D view and map. */
export function toggleDimension(): void {
  choose(wants3d.value ? '2d' : '3d');
}

export function zoom(factor: number): void {
  if (shows3d.value) zoomCamera(factor);
  else metresAcross.value = zoomed(metresAcross.value, factor);
}

const NO_LINE = { x: [], y: [] };

/** Paints the map; holds what is kept from one picture to the next. */
class Painter {
  readonly #canvas: HTMLCanvasElement;
  readonly #context: CanvasRenderingContext2D | null;
  readonly #box: OnScreen;
  #road: RoadShape | null = null;
  #roadBox: Box | null = null;
  #roadVersion = -1;
  #heading = NaN; // smoothed yaw of the car [rad]
  #lastPaint = 0;
  #shown: readonly unknown[] = [];
  #seen: Camera | null = null; // of the last picture
  #worldKey: readonly unknown[] = [];
  readonly #world = new CachedPicture();
  readonly #outline = new CachedPicture();
  readonly #ghost: GhostPose = { x: 0, y: 0, yaw: 0, steer: 0 };

  constructor(canvas: HTMLCanvasElement) {
    this.#canvas = canvas;
    this.#context = canvas.getContext('2d', { alpha: false });
    this.#box = onScreen(canvas);
  }

  paint(now: number): void {
    const isInset = shows3d.value;
    if (isInset && now - this.#lastPaint < INSET_INTERVAL_MS) return;
    const ratio = Math.min(devicePixelRatio, 2);
    const { width, height } = this.#box;
    if (!this.#context || width === 0 || height === 0) return;
    this.#resize(Math.round(width * ratio), Math.round(height * ratio));
    if (this.#roadVersion !== road.version) this.#renewRoad();

    const car = this.#carNow(now);
    const camera = this.#camera(car, now, width, height, isInset);
    this.#lastPaint = now;
    const top = topOfScale(run.value?.body_length_m ?? NaN, speedUnit());
    if (scaleTop.value !== top) scaleTop.value = top;
    const length = scaleBar(camera.scale, Math.min(120, width / 4));
    if (bar.value.metres !== length.metres || Math.abs(bar.value.pixels - length.pixels) > 0.5) bar.value = length;

    // The way driven would lie on the line of the lap that is coloured.
    const losses = layers.timeLost.value && tab.value === 'laps' && !isInset ? lossesNow.value : null;
    const scene: Scene = {
      road: this.#road,
      racingLine: layers.racingLine.value ? limit.value : null,
      corners: isInset ? [] : markedCorners(),
      kerb: run.value?.kerb_width_m ?? 0,
      start: startLine(),
      losses,
      reference: road.reference,
      trace: losses ? NO_LINE : { x: live.trace.column(0), y: live.trace.column(1) },
      plan: live.plan,
      size: run.value ? paintSize(run.value) : 1,
      speedScale: top,
      hindsight: layers.hindsight.value ? hindsight(live.pastPlans, live.plots, live.frame?.time_s ?? NaN) : null,
      faults: faultMarks.value,
      ghost: this.#ghostNow(),
      car,
    };
    const still = [
      camera.centre.x,
      camera.centre.y,
      camera.scale,
      camera.rotation,
      this.#canvas.width,
      this.#canvas.height,
      this.#road,
      scene.racingLine,
      scene.corners,
      scene.start,
      scene.size,
      scene.losses,
      theme(),
    ];
    const mark = cursorMark();
    this.#seen = camera;
    // In a paused run the picture does not change.
    const shown = [
      ...still,
      live.frame,
      live.plan,
      road.reference,
      live.trace.newest(0),
      car?.x,
      car?.y,
      car?.yaw,
      scene.hindsight?.plan,
      scene.ghost?.x,
      scene.ghost?.y,
      top,
      faultMarks.value,
      mark?.x,
      mark?.y,
    ];
    if (isSame(shown, this.#shown)) return;
    this.#shown = shown;
    this.#drawWorld(scene, camera, still, ratio);
    drawMoving(this.#context, scene, camera, theme(), ratio);
    if (mark) drawCursor(this.#context, mark, camera, theme(), ratio);
    if (!isInset && view.value !== 'whole' && this.#road && this.#roadBox)
      this.#inset({ car, mark, ghost: scene.ghost }, width, ratio);
  }

  /** Draws the static part; copies it while the camera does not move. */
  #drawWorld(scene: Scene, camera: Camera, key: readonly unknown[], ratio: number): void {
    const context = this.#context as CanvasRenderingContext2D;
    const isStill = isSame(key, this.#worldKey);
    this.#worldKey = key;
    if (!isStill) {
      drawWorld(context, scene, camera, theme(), ratio);
      return;
    }
    const { width, height } = this.#canvas;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(
      this.#world.picture(key, width, height, (own) => drawWorld(own, scene, camera, theme(), ratio)),
      0,
      0,
    );
  }

  #inset(
    { car, mark, ghost }: { car: Point | null; mark: Point | null; ghost: Point | null },
    width: number,
    ratio: number,
  ): void {
    const [context, road] = [this.#context as CanvasRenderingContext2D, this.#road as RoadShape];
    if (width < 330) return; // it would lie under the buttons
    const side = Math.min(170, width * 0.3);
    const top = width < 560 ? 48 : 8; // below the buttons where they do not fit side by side
    const fit = fitting(this.#roadBox as Box, side, side, 8);
    const pixels = Math.round(side * ratio);
    const picture = this.#outline.picture([road, ratio, theme()], pixels, pixels, (own) =>
      drawOutline(own, road, fit, theme(), ratio),
    );
    context.setTransform(1, 0, 0, 1, 0, 0);
    const [left, above] = [Math.round((width - 8 - side) * ratio), Math.round(top * ratio)];
    context.drawImage(picture, left, above);
    const there = { ...fit, at: { x: left / ratio + side / 2, y: above / ratio + side / 2 } };
    if (ghost) drawDot(context, ghost, there, theme(), ratio, theme().trace);
    if (car) drawDot(context, car, there, theme(), ratio);
    if (mark) drawDot(context, mark, there, theme(), ratio, theme().predicted);
  }

  end(): void {
    this.#box.end();
  }

  /** The point of the world at a place of the canvas. */
  worldAt(at: Point): Point | null {
    return this.#seen && unproject(this.#seen, at);
  }

  #resize(width: number, height: number): void {
    if (this.#canvas.width === width && this.#canvas.height === height) return;
    this.#canvas.width = width;
    this.#canvas.height = height;
  }

  #renewRoad(): void {
    this.#roadVersion = road.version;
    this.#road = roadShape(road.lines);
    this.#roadBox = boundsOf([...road.lines.left, ...road.lines.right]);
  }

  /** The car's pose extrapolated to now: frames arrive less often than repaints. */
  #carNow(now: number): Scene['car'] {
    const { frame } = live;
    const size = run.value;
    if (!frame || !size) return null;
    const isMoving = link.value === 'live' && !isPaused.value;
    const age = isMoving ? Math.min(Math.max(0, now - live.receivedAt) / 1000, 0.1) : 0;
    const motion = { vx: frame.vx_mps, vy: frame.vy_mps, yawRate: frame.yaw_rate_radps };
    const pose = extrapolate({ x: frame.x_m, y: frame.y_m, yaw: frame.yaw_rad }, motion, age);
    return { ...pose, isBraking: frame.throttle_applied < 0, shape: carShape(size, frame.steer_applied_rad) };
  }

  #ghostNow(): GhostPose | null {
    return session.ghost?.poseAt(live.frame?.lap_time_s ?? NaN, this.#ghost) ? this.#ghost : null;
  }

  #camera(car: Scene['car'], now: number, width: number, height: number, isInset: boolean): Camera {
    const box = this.#roadBox;
    if (isInset || view.value === 'whole' || !car) {
      const all =
        box ??
        boundsOf(
          car
            ? [car, ...road.reference]
            : [
                { x: 0, y: 0 },
                { x: 100, y: 60 },
              ],
        );
      return fitting(all as Box, width, height, isInset ? 10 : 52);
    }
    const across = metresAcross.value * (run.value ? paintSize(run.value) : 1);
    if (view.value === 'above') return above(car, width, height, across);
    // Smoothed over a quarter of a second, so that the view does not follow every steering movement.
    const elapsed = (now - this.#lastPaint) * Math.max(1, live.frame?.pace || 1); // a fast run turns as fast
    const share = Number.isNaN(this.#heading) ? 1 : 1 - Math.exp(-elapsed / 250);
    const from = Number.isNaN(this.#heading) ? car.yaw : this.#heading;
    this.#heading = from + wrapAngle(car.yaw - from) * share;
    const foot = isRoomy.value ? NUMBERS_PX : LEGEND_PX;
    return behind(car, this.#heading, width, height, across, foot);
  }
}

function describeMap(): string {
  const frame = shown.value;
  if (!frame) return 'Map of the track, no car yet';
  const place = frame.is_off_track ? 'off the road' : 'on the road';
  return `Map of the track: the car is ${place} at ${fixed(inSpeedUnit(frame.speed_mps), 0)} ${speedUnit().spoken}`;
}

interface Choice<T> {
  readonly view: T;
  readonly label: string;
  readonly title: string;
}

function Segments<T extends string>({
  name,
  choices,
  chosen,
  choose: pick,
}: {
  name: string;
  choices: readonly Choice<T>[];
  chosen: T;
  choose: (view: T) => void;
}) {
  return (
    <div class="segments" role="group" aria-label={name}>
      {choices.map((each) => (
        <button
          key={each.view}
          type="button"
          title={each.title}
          aria-pressed={chosen === each.view}
          onClick={() => pick(each.view)}
        >
          {each.label}
        </button>
      ))}
    </div>
  );
}

const DIMENSIONS: readonly Choice<Dimension>[] = [
  { view: '3d', label: '3D', title: 'Three-dimensional view (V)' },
  { view: '2d', label: '2D', title: 'Map (V)' },
];

function MapControls() {
  const is3d = shows3d.value;
  const canZoom = is3d || view.value !== 'whole';
  return (
    <div class="map-controls">
      <Segments name="Dimensions" choices={DIMENSIONS} chosen={is3d ? '3d' : '2d'} choose={choose} />
      {is3d ? (
        <Segments name="View" choices={CAMERAS} chosen={camera.value} choose={(next) => (camera.value = next)} />
      ) : (
        <Segments name="View" choices={VIEWS} chosen={view.value} choose={(next) => (view.value = next)} />
      )}
      <div class="segments" role="group" aria-label="Presentation">
        <button
          type="button"
          aria-pressed={isStageAlone.value}
          aria-keyshortcuts="G"
          title="The picture alone, on the whole screen (G)"
          onClick={togglePresentation}
        >
          Present
        </button>
      </div>
      {canZoom && (
        <div class="segments" role="group" aria-label="Zoom">
          <button type="button" title="Zoom out (−)" aria-label="Zoom out" onClick={() => zoom(1.25)}>
            −
          </button>
          <button type="button" title="Zoom in (+)" aria-label="Zoom in" onClick={() => zoom(0.8)}>
            +
          </button>
        </div>
      )}
    </div>
  );
}

function usePainter() {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    if (!canvas.current) return undefined;
    const element = canvas.current;
    const painter = new Painter(element);
    const onWheel = (event: WheelEvent): void => {
      if (event.ctrlKey) return;
      event.preventDefault();
      zoom(Math.exp(event.deltaY * 0.0015));
    };
    const onClick = (event: MouseEvent): void => {
      const point = painter.worldAt({ x: event.offsetX, y: event.offsetY });
      if (!point) return;
      const seek = seekTo.value;
      const time = seek && timeNear(point.x, point.y);
      if (!seek) pointAt(point.x, point.y);
      else if (time !== null) seek(time);
    };
    element.addEventListener('click', onClick);
    element.addEventListener('wheel', onWheel, { passive: false });
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
      element.removeEventListener('wheel', onWheel);
      element.removeEventListener('click', onClick);
    };
  }, []);
  return canvas;
}

export function TrackView() {
  const canvas = usePainter();
  const label = describeMap();
  const classes = ['panel map', shows3d.value ? 'has-3d' : '', dangerNow()];
  return (
    <section class={classes.filter(Boolean).join(' ')} aria-label="Track">
      {wants3d.value && <Scene3dView label={label.replace('Map', 'Picture')} />}
      {/* Always present: full size, or as the small map beside the 3D picture. */}
      <canvas ref={canvas} class="map-2d" role="img" aria-label={label} />
      <MapControls />
      <AlertsView />
      <div class="map-foot">
        <HudView />
        {isRoomy.value && <InstrumentsView />}
        <LegendView bar={bar} scaleTop={scaleTop} ghostLabel={ghostLabel} />
      </div>
    </section>
  );
}
