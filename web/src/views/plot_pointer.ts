// Pointer on a plot over time: cursor, mark and zoom.
import type { Chart } from '../draw/chart';
import { clamp, firstSince } from '../lib/math';
import { Column } from '../state/columns';
import { cursorTime, markTime, plotted, timeRange, zoomTo } from '../state/plot_view';

const LEAST_DRAG_PX = 5; // shorter drags are clicks; chosen

/** The sample that is nearest to a time [s]; null without any. */
function sampleAt(time: number): number | null {
  if (!Number.isFinite(time)) return null;
  const times = plotted().column(Column.time_s);
  const after = firstSince(times, time);
  const [before, behind] = [times[after - 1] ?? NaN, times[after] ?? NaN];
  const nearest = time - before < behind - time || Number.isNaN(behind) ? before : behind;
  return Number.isNaN(nearest) ? null : nearest;
}

/**
 * A pointer on the plotted area: it moves the cursor, a click sets the mark, dragging zooms. Places are pixels from
 * the area's left edge.
 */
export class PlotPointer {
  /** The chart under the pointer; null: not drawn yet. */
  chart: Chart | null = null;
  readonly #width: () => number;
  readonly #select: (range: readonly [number, number] | null) => void;
  #place: number | null = null; // of the pointer; null: outside
  #pressed: number | null = null; // where the button was pressed; null: it is not

  /** `width`: of the area; `select`: shows the stretch that is dragged over; null: none. */
  constructor(width: () => number, select: (range: readonly [number, number] | null) => void) {
    [this.#width, this.#select] = [width, select];
  }

  move(place: number): void {
    this.#place = this.#inside(place);
    this.follow();
    const range = this.#dragged();
    if (range) this.#select(range);
  }

  /** Puts the cursor under a pointer that rests while the plot moves on. */
  follow(): void {
    if (this.#place !== null) cursorTime.value = sampleAt(this.#timeAt(this.#place));
  }

  /** Begins a click or a drag, by the first button alone. */
  press(place: number, button: number): void {
    if (button !== 0) return;
    this.#pressed = this.#inside(place);
    this.move(place);
  }

  release(place: number): void {
    if (this.#pressed === null) return;
    this.move(place);
    const range = this.#dragged();
    if (range) zoomTo(this.#timeAt(range[0]), this.#timeAt(range[1]));
    else markTime.value = cursorTime.value;
    this.cancel();
  }

  cancel(): void {
    this.#pressed = null;
    this.#select(null);
  }

  leave(): void {
    this.#place = null;
    cursorTime.value = null;
  }

  /** The stretch from where the button was pressed; null: too short for a drag. */
  #dragged(): readonly [number, number] | null {
    const [from, to] = [this.#pressed ?? NaN, this.#place ?? NaN];
    return Math.abs(to - from) >= LEAST_DRAG_PX ? [Math.min(from, to), Math.max(from, to)] : null;
  }

  /** Time range and width of the plotted area, drawn or about to be. */
  #area(): { readonly from: number; readonly to: number; readonly width: number } {
    if (this.chart) return { ...this.chart, width: this.chart.right - this.chart.left };
    const [from, to] = timeRange();
    return { from, to, width: this.#width() };
  }

  #inside(place: number): number {
    return clamp(place, 0, this.#area().width);
  }

  #timeAt(place: number): number {
    const { from, to, width } = this.#area();
    return from + (place / width) * (to - from);
  }
}
