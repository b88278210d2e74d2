// Bands in the plots over time: quality of the control steps, and faults.
import type { Chart } from '../draw/chart';
import { theme } from '../draw/theme';
import { firstSince } from '../lib/math';
import { RUNG_WORDS } from '../protocol/messages';
import { Column } from '../state/columns';
import { plotted } from '../state/plot_view';

const STRIP_HEIGHT = 5; // [px]; chosen
const GROUND_OPACITY = 0.13; // of the bands of faults; chosen

/** Severity of a control step: 0 usable and sent unchanged, 1 changed or replaced, 2 not the controller's. */
export function stepSeverity(status: number, rung: number, isGated: number): 0 | 1 | 2 {
  const who = RUNG_WORDS[rung]?.severity ?? 'bad';
  if (status < 0 || who === 'bad') return 2;
  return who === 'warning' || isGated > 0 ? 1 : 0;
}

/** Fills the lowest `tall` pixels of a plot, from stretch to stretch in the colour of its state. */
function fillStates(chart: Chart, stateAt: (row: number) => number, colours: readonly string[], tall: number): void {
  const { context, left, right, bottom, from, to, x } = chart;
  const times = plotted().column(Column.time_s);
  const pixel = (i: number): number => Math.min(right, Math.max(left, x(times[i] ?? 0)));
  const end = firstSince(times, to);
  for (let i = Math.max(0, firstSince(times, from) - 1); i < end; ) {
    const state = stateAt(i);
    let next = i + 1;
    while (next < end && stateAt(next) === state) ++next;
    context.fillStyle = colours[state] ?? 'transparent';
    const begin = pixel(i);
    context.fillRect(begin, bottom - tall, Math.max(1, pixel(Math.min(next, times.length - 1)) - begin), tall);
    i = next;
  }
}

/** Draws a band at the bottom of a plot: green while the controller's answer was usable and sent unchanged. */
export function drawStatusStrip(chart: Chart): void {
  const { wonInText, planInText, lostInText } = theme();
  const [status, rung, gated] = [Column.solve_status, Column.rung, Column.is_gated].map((each) =>
    plotted().column(each),
  );
  const stateAt = (i: number): number => stepSeverity(status?.[i] ?? 0, rung?.[i] ?? 0, gated?.[i] ?? 0);
  fillStates(chart, stateAt, [wonInText, planInText, lostInText], STRIP_HEIGHT);
}

/** Draws the ground of a plot: red while a fault acts, amber while another than the controller drives. */
export function drawFaultBands(chart: Chart): void {
  const [faults, rungs] = [plotted().column(Column.active_faults), plotted().column(Column.rung)];
  const stateAt = (i: number): number => ((faults[i] ?? 0) > 0 ? 2 : (rungs[i] ?? 0) > 0 ? 1 : 0);
  chart.context.globalAlpha = GROUND_OPACITY;
  fillStates(chart, stateAt, ['transparent', theme().planInText, theme().lostInText], chart.bottom - chart.top);
  chart.context.globalAlpha = 1;
}
