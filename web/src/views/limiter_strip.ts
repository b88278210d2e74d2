import { Column } from '../state/columns';
import { rowsSince } from '../state/explain';
import { live } from '../state/live';
import { cursorTime } from '../state/plot_view';
import type { Paint } from './canvas_view';
import { chartColours } from './plot_colours';

/** A band over time in the colour of what limited the speed. */
export const paintLimiterStrip =
  (seconds: number): Paint =>
  (context, width, height) => {
    const colours = chartColours();
    const times = live.plots.column(Column.time_s);
    const limiters = live.plots.column(Column.speed_limiter);
    const end = times.at(-1) ?? 0;
    const x = (time: number): number => width * (1 - (end - time) / seconds);
    for (let i = rowsSince(live.plots, seconds); i < times.length; ) {
      let next = i + 1;
      while (next < times.length && limiters[next] === limiters[i]) ++next;
      context.fillStyle = colours.limiter[limiters[i] ?? 0] ?? colours.faint;
      const [from, to] = [x(times[i] ?? 0), x(times[Math.min(next, times.length - 1)] ?? 0)];
      context.fillRect(from, 0, Math.max(1, to - from), height);
      i = next;
    }
    if (cursorTime.value === null) return;
    context.fillStyle = colours.text;
    context.fillRect(x(cursorTime.value) - 1, 0, 2, height);
  };
