import { duration } from '../lib/format';
import { live } from '../state/live';
import { run } from '../state/run';
import { shown } from '../state/shown';
import { CanvasView } from './canvas_view';
import { chartColours } from './plot_colours';

const QUANTILES = [
  { share: 0.5, label: 'p50' },
  { share: 0.99, label: 'p99' },
  { share: 0.999, label: 'p99.9' },
] as const;

/** A power of ten of microseconds, for the axis. */
const decadeLabel = (power: number): string =>
  power < 3 ? `${10 ** power} µs` : power < 6 ? `${10 ** (power - 3)} ms` : `${10 ** (power - 6)} s`;

const micros = (value: number): string => {
  const { value: number, unit } = duration(value);
  return `${number} ${unit}`;
};

function paint(context: CanvasRenderingContext2D, width: number, height: number): void {
  const colours = chartColours();
  const histogram = live.stepTimes;
  const span = histogram.span;
  context.font = `11px ${colours.font}`;
  context.fillStyle = colours.faint;
  if (!span) {
    context.fillText('No control step yet', 12, 24);
    return;
  }
  // Whole decades around the values.
  const decade = Math.log10;
  const low = Math.floor(decade(histogram.edge(span[0])) + 1e-9);
  const high = Math.max(low + 1, Math.ceil(decade(histogram.edge(span[1])) - 1e-9));
  const [left, right, top, bottom] = [12, width - 12, 26, height - 20];
  const x = (value: number): number => left + ((decade(value) - low) / (high - low)) * (right - left);
  const most = histogram.counts.reduce((a, b) => Math.max(a, b), 0);

  context.lineWidth = 1;
  context.strokeStyle = colours.grid;
  context.textAlign = 'center';
  for (let power = low; power <= high; ++power) {
    context.beginPath();
    context.moveTo(x(10 ** power), top);
    context.lineTo(x(10 ** power), bottom);
    context.stroke();
    const isEnd = power === low || power === high;
    context.textAlign = !isEnd ? 'center' : power === low ? 'left' : 'right';
    context.fillText(decadeLabel(power), x(10 ** power), height - 5);
  }
  // Heights are logarithmic too: the rare slow steps are what matters.
  const tall = (count: number): number => (Math.log10(1 + count) / Math.log10(1 + most)) * (bottom - top);
  context.fillStyle = colours.series[0] ?? colours.text;
  for (let bin = span[0]; bin < span[1]; ++bin) {
    const [from, to] = [x(histogram.edge(bin)), x(histogram.edge(bin + 1))];
    const size = tall(histogram.counts[bin] ?? 0);
    context.fillRect(from + 0.5, bottom - size, Math.max(1, to - from - 1), size);
  }
  QUANTILES.forEach(({ share, label }, i) => {
    const at = x(histogram.quantile(share));
    context.strokeStyle = context.fillStyle = [colours.soft, colours.warning, colours.bad][i] ?? colours.text;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(at, top - 6);
    context.lineTo(at, bottom);
    context.stroke();
    context.textAlign = i === 2 ? 'left' : 'right';
    context.fillText(label, at + (i === 2 ? 4 : -4), top - (i === 1 ? 12 : 0));
  });
}

/** Times of all control steps since the page was opened. */
export function HistogramView() {
  void shown.value;
  const { stepTimes } = live;
  const period = (run.value?.control_period_s ?? NaN) * 1e6;
  return (
    <section class="plot" aria-label="Step times">
      <header>
        <h2>
          Step times <span class="unit">{stepTimes.total} steps, logarithmic</span>
        </h2>
        <p>
          {QUANTILES.map(({ share, label }) => (
            <span key={label} class="key">
              {label} <b>{micros(stepTimes.quantile(share))}</b>
            </span>
          ))}
          <span class="key">
            max <b>{micros(stepTimes.max)}</b>
          </span>
          {Number.isFinite(period) && (
            <span class="key">
              of <b>{micros(period)}</b>
            </span>
          )}
        </p>
      </header>
      <CanvasView
        label="Histogram of the times of control steps"
        paint={paint}
        version={() => live.stepTimes.total}
        interval={250}
      />
    </section>
  );
}
