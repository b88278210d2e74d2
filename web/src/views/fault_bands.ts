import type uPlot from 'uplot';
import { firstSince } from '../draw/axis';
import { Column } from '../state/columns';
import { plotted } from '../state/plot_view';
import type { ChartColours } from './plot_colours';

/** Behind the lines of a plot: a red ground while a fault acts, amber while another than the controller drives. */
export function drawFaultBands(plot: uPlot, colours: ChartColours): void {
  const history = plotted();
  const times = history.column(Column.time_s);
  const [faults, rungs] = [history.column(Column.active_faults), history.column(Column.rung)];
  const stateAt = (i: number): 0 | 1 | 2 => ((faults[i] ?? 0) > 0 ? 2 : (rungs[i] ?? 0) > 0 ? 1 : 0);
  const { left, top, width, height } = plot.bbox;
  const end = firstSince(times, plot.scales.x?.max ?? Infinity);
  const pixel = (i: number): number => Math.min(left + width, Math.max(left, plot.valToPos(times[i] ?? 0, 'x', true)));
  for (let i = Math.max(0, firstSince(times, plot.scales.x?.min ?? 0) - 1); i < end; ) {
    const state = stateAt(i);
    let next = i + 1;
    while (next < end && stateAt(next) === state) ++next;
    if (state > 0) {
      plot.ctx.globalAlpha = 0.13;
      plot.ctx.fillStyle = state === 2 ? colours.bad : colours.warning;
      const from = pixel(i);
      plot.ctx.fillRect(from, top, Math.max(devicePixelRatio, pixel(Math.min(next, times.length - 1)) - from), height);
      plot.ctx.globalAlpha = 1;
    }
    i = next;
  }
}
