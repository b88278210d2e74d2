import type uPlot from 'uplot';
import { firstSince } from '../draw/axis';
import { RUNG_WORDS } from '../protocol/messages';
import { Column } from '../state/columns';
import { plotted } from '../state/plot_view';
import type { ChartColours } from './plot_colours';

const HEIGHT = 5; // CSS pixels

/** Severity of a control step: 0 usable and sent unchanged, 1 changed or replaced, 2 not the controller's. */
export function stepSeverity(status: number, rung: number, isGated: number): 0 | 1 | 2 {
  const who = RUNG_WORDS[rung]?.severity ?? 'bad';
  if (status < 0 || who === 'bad') return 2;
  return who === 'warning' || isGated > 0 ? 1 : 0;
}

/** A band at the bottom of a plot: green while the controller's answer was usable and sent unchanged. */
export function drawStatusStrip(plot: uPlot, colours: ChartColours): void {
  const history = plotted();
  const times = history.column(Column.time_s);
  const [statuses, rungs, gated] = [Column.solve_status, Column.rung, Column.is_gated].map((column) =>
    history.column(column),
  );
  const { left, top, width, height } = plot.bbox;
  const tall = HEIGHT * devicePixelRatio;
  const look = [colours.good, colours.warning, colours.bad];
  const from = firstSince(times, plot.scales.x?.min ?? 0);
  const pixel = (i: number): number => Math.min(left + width, Math.max(left, plot.valToPos(times[i] ?? 0, 'x', true)));
  const at = (i: number): number => stepSeverity(statuses?.[i] ?? 0, rungs?.[i] ?? 0, gated?.[i] ?? 0);
  for (let i = from; i < times.length; ) {
    const value = at(i);
    let end = i + 1;
    while (end < times.length && at(end) === value) ++end;
    plot.ctx.fillStyle = look[value] ?? colours.text;
    plot.ctx.fillRect(
      pixel(i),
      top + height - tall,
      Math.max(devicePixelRatio, pixel(Math.min(end, times.length - 1)) - pixel(i)),
      tall,
    );
    i = end;
  }
}
