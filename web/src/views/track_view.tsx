import { signal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import { above, behind, fitting, scaleBar, zoomed, type Camera } from '../draw/camera';
import { carShape } from '../draw/car';
import { drawInset, drawScene, roadShape, type RoadShape, type Scene } from '../draw/scene';
import { speedGradient, topOfScale } from '../draw/speed_colour';
import { onThemeChange, theme } from '../draw/theme';
import { fixed, MPH } from '../lib/format';
import { boundsOf, extrapolate, wrapAngle, type Box, type Point } from '../lib/math';
import { isPaused, link, live, run, shown } from '../state/app_state';
import { everyFrame } from '../state/ticker';

export type View = 'behind' | 'above' | 'whole';

const VIEWS: readonly { view: View; label: string; title: string }[] = [
  { view: 'behind', label: 'Chase', title: 'Follow the car, looking ahead (C)' },
  { view: 'above', label: 'North up', title: 'Follow the car, north up (C)' },
  { view: 'whole', label: 'Whole track', title: 'See the whole track (C)' },
];

export const view = signal<View>('behind');
const metresAcross = signal(100);
const bar = signal({ metres: 10, pixels: 80 });
const scaleTop = signal(20 / MPH);

export function nextView(): void {
  const at = VIEWS.findIndex((each) => each.view === view.value);
  view.value = VIEWS[(at + 1) % VIEWS.length]?.view ?? 'behind';
}

export function zoom(factor: number): void {
  metresAcross.value = zoomed(metresAcross.value, factor);
}

/** Keeps what has to be kept from one picture to the next. */
class Painter {
  readonly #canvas: HTMLCanvasElement;
  readonly #context: CanvasRenderingContext2D | null;
  #road: RoadShape | null = null;
  #roadBox: Box | null = null;
  #roadVersion = -1;
  #heading = NaN; // smoothed yaw of the car [rad]
  #lastPaint = 0;

  constructor(canvas: HTMLCanvasElement) {
    this.#canvas = canvas;
    this.#context = canvas.getContext('2d', { alpha: false });
  }

  paint(now: number): void {
    const ratio = Math.min(devicePixelRatio, 2);
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (!this.#context || width === 0 || height === 0) return;
    this.#resize(Math.round(width * ratio), Math.round(height * ratio));
    if (this.#roadVersion !== live.roadVersion) this.#renewRoad();

    const car = this.#carNow(now);
    const camera = this.#camera(car, now, width, height);
    const top = topOfScale(live.topSpeed);
    if (scaleTop.value !== top) scaleTop.value = top;
    const length = scaleBar(camera.scale, Math.min(120, width / 4));
    if (bar.value.metres !== length.metres || Math.abs(bar.value.pixels - length.pixels) > 0.5) bar.value = length;

    const scene: Scene = {
      road: this.#road,
      reference: live.reference,
      traceX: live.trace.column(0),
      traceY: live.trace.column(1),
      plan: live.plan,
      speedScale: top,
      car,
    };
    drawScene(this.#context, scene, camera, theme(), ratio);
    if (view.value !== 'whole' && this.#road && this.#roadBox) this.#inset(car, width, ratio);
  }

  #inset(car: Point | null, width: number, ratio: number): void {
    const side = Math.min(170, width * 0.3);
    const fit = fitting(this.#roadBox as Box, side, side, 8);
    const top = width < 560 ? 48 : 8; // below the buttons where both do not fit side by side
    const camera: Camera = { ...fit, at: { x: width - 8 - side / 2, y: top + side / 2 } };
    drawInset(this.#context as CanvasRenderingContext2D, this.#road as RoadShape, car, camera, theme(), ratio);
  }

  #resize(width: number, height: number): void {
    if (this.#canvas.width === width && this.#canvas.height === height) return;
    this.#canvas.width = width;
    this.#canvas.height = height;
  }

  #renewRoad(): void {
    this.#roadVersion = live.roadVersion;
    this.#road = roadShape(live.road);
    this.#roadBox = boundsOf([...live.road.left, ...live.road.right]);
  }

  /** Where the car is at this very moment: frames come less often than repaints. */
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

  #camera(car: Scene['car'], now: number, width: number, height: number): Camera {
    const box = this.#roadBox;
    if (view.value === 'whole' || !car) {
      const all = box ?? boundsOf(car ? [car, ...live.reference] : [{ x: 0, y: 0 }, { x: 100, y: 60 }]);
      return fitting(all as Box, width, height, 52);
    }
    if (view.value === 'above') return above(car, width, height, metresAcross.value);
    // A quarter of a second of smoothing: corners turn the world, wheel movements do not.
    const share = Number.isNaN(this.#heading) ? 1 : 1 - Math.exp(-(now - this.#lastPaint) / 250);
    const from = Number.isNaN(this.#heading) ? car.yaw : this.#heading;
    this.#heading = from + wrapAngle(car.yaw - from) * share;
    this.#lastPaint = now;
    return behind(car, this.#heading, width, height, metresAcross.value);
  }
}

function Legend() {
  const top = scaleTop.value * MPH;
  return (
    <div class="legend">
      <div class="legend-item">
        <span class="scale-bar" style={{ width: `${bar.value.pixels}px` }} />
        <span>{bar.value.metres} m</span>
      </div>
      <div class="legend-item">
        <span class="swatch reference" />
        <span>reference</span>
      </div>
      <div class="legend-item">
        <span class="swatch trace" />
        <span>driven</span>
      </div>
      <div class="legend-item">
        <span>plan 0</span>
        <span class="gradient" style={{ background: speedGradient() }} />
        <span>{fixed(top, 0)} mph</span>
      </div>
    </div>
  );
}

function describeMap(): string {
  const frame = shown.value;
  if (!frame) return 'Map of the track, no car yet';
  const place = frame.is_off_track ? 'off the road' : 'on the road';
  return `Map of the track: the car is ${place} at ${fixed(frame.speed_mps * MPH, 0)} miles per hour`;
}

export function TrackView() {
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
    element.addEventListener('wheel', onWheel, { passive: false });
    const stop = everyFrame((now) => painter.paint(now));
    const unwatch = onThemeChange(() => painter.paint(performance.now()));
    return () => {
      stop();
      unwatch();
      element.removeEventListener('wheel', onWheel);
    };
  }, []);

  return (
    <section class="panel map" aria-label="Track">
      <canvas ref={canvas} role="img" aria-label={describeMap()} />
      <div class="map-controls">
        <div class="segments" role="group" aria-label="View">
          {VIEWS.map((each) => (
            <button
              key={each.view}
              type="button"
              title={each.title}
              aria-pressed={view.value === each.view}
              onClick={() => (view.value = each.view)}
            >
              {each.label}
            </button>
          ))}
        </div>
        {view.value !== 'whole' && (
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
      <Legend />
    </section>
  );
}
