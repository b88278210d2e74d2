import type uPlot from 'uplot';
import { firstSince } from '../draw/axis';
import { RUNG_WORDS } from '../protocol/messages';
import { Column } from '../state/columns';
import { plotted } from '../state/plot_view';
import type { ChartColours } from './plot_colours';

const STRIP_HEIGHT = 5; // CSS pixels
const GROUND_OPACITY = 0.13;

/** Severity of a control step: 0 usable and sent unchanged, 1 changed or replaced, 2 not the controller's. */
export function stepSeverity(status: number, rung: number, isGated: number): 0 | 1 | 2 {
  const who = RUNG_WORDS[rung]?.severity ?? 'bad';
  if (status < 0 || who === 'bad') return 2;
  return who === 'warning' || isGated > 0 ? 1 : 0;
}

/** Fills the lowest `tall` device pixels of a plot, from stretch to stretch in the colour of its state. */
function fillStates(plot: uPlot, stateAt: (row: number) => number, colours: readonly string[], tall: number): void {
  const times = plotted().column(Column.time_s);
  const { left, top, width, height } = plot.bbox;
  const pixel = (i: number): number => Math.min(left + width, Math.max(left, plot.valToPos(times[i] ?? 0, 'x', true)));
  const end = firstSince(times, plot.scales.x?.max ?? Infinity);
  for (let i = Math.max(0, firstSince(times, plot.scales.x?.min ?? 0) - 1); i < end; ) {
    const state = stateAt(i);
    let next = i + 1;
    while (next < end && stateAt(next) === state) ++next;
    plot.ctx.fillStyle = colours[state] ?? 'transparent';
    const [from, to] = [pixel(i), pixel(Math.min(next, times.length - 1))];
    plot.ctx.fillRect(from, top + height - tall, Math.max(devicePixelRatio, to - from), tall);
    i = next;
  }
}

/** A band at the bottom of a plot: green while the controller's answer was usable and sent unchanged. */
export function drawStatusStrip(plot: uPlot, { good, warning, bad }: ChartColours): void {
  const [status, rung, gated] = [Column.solve_status, Column.rung, Column.is_gated].map((each) =>
    plotted().column(each),
  );
  const stateAt = (i: number): number => stepSeverity(status?.[i] ?? 0, rung?.[i] ?? 0, gated?.[i] ?? 0);
  fillStates(plot, stateAt, [good, warning, bad], STRIP_HEIGHT * devicePixelRatio);
}

/** Behind the lines of a plot: a red ground while a fault acts, amber while another than the controller drives. */
export function drawFaultBands(plot: uPlot, { warning, bad }: ChartColours): void {
  const [faults, rungs] = [plotted().column(Column.active_faults), plotted().column(Column.rung)];
  const stateAt = (i: number): number => ((faults[i] ?? 0) > 0 ? 2 : (rungs[i] ?? 0) > 0 ? 1 : 0);
  plot.ctx.globalAlpha = GROUND_OPACITY;
  fillStates(plot, stateAt, ['transparent', warning, bad], plot.bbox.height);
  plot.ctx.globalAlpha = 1;
}
