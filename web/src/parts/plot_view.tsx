// View of a chart or map of results, as SVG.
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { onScreen } from '../lib/on_screen';
import { tidy } from '../lib/scale';
import { dotSize, type Frame, frameOf, MARGIN, type Plot, pathOf, type Series, TONES } from './plot';

const FIRST_WIDTH = 512; // of a plot until the page has measured it [px]; chosen

/** Grid, ticks and the name of the horizontal axis. */
function Axes({ frame, name }: { frame: Frame; name: string }) {
  const [right, bottom] = [frame.width - MARGIN.right, frame.height - MARGIN.bottom];
  return (
    <g class="axes">
      {frame.xTicks.map((value) => (
        <g key={`x${value}`}>
          <path d={`M${frame.x(value)} ${MARGIN.top}V${bottom}`} />
          <text x={frame.x(value)} y={bottom + 16} text-anchor="middle">
            {tidy(value)}
          </text>
        </g>
      ))}
      {frame.yTicks.map((value) => (
        <g key={`y${value}`}>
          <path d={`M${MARGIN.left} ${frame.y(value)}H${right}`} />
          <text x={MARGIN.left - 6} y={frame.y(value) + 4} text-anchor="end">
            {tidy(value)}
          </text>
        </g>
      ))}
      <text x={(MARGIN.left + right) / 2} y={bottom + 34} text-anchor="middle">
        {name}
      </text>
    </g>
  );
}

/** Style with the colour of a series. */
const toneOf = ({ tone }: Series) => ({ '--tone': `var(--${TONES[tone]})` });

/** The series that the legend names. */
const namedIn = (series: readonly Series[]): readonly Series[] =>
  series.filter(({ name, values }) => name !== '' && values.length > 0);

/** A chart or a map with its legend, as wide as there is room. */
export function PlotView({ plot }: { plot: Plot }) {
  const figure = useRef<HTMLElement>(null);
  const [width, setWidth] = useState(FIRST_WIDTH);
  useLayoutEffect(() => {
    if (!figure.current) return;
    setWidth(figure.current.clientWidth || FIRST_WIDTH);
    const state = onScreen(figure.current, () => state.width > 0 && setWidth(state.width));
    return () => state.end();
  }, []);
  const frame = frameOf(plot, width);
  const named = namedIn(plot.series);
  return (
    <figure ref={figure} class={plot.part}>
      <figcaption class="row">
        {plot.title}
        {named.map((series) => (
          <span key={series.name} class={`key ${series.draw}`} style={toneOf(series)}>
            {series.name}
          </span>
        ))}
      </figcaption>
      <svg class="chart" viewBox={`0 0 ${frame.width} ${frame.height}`} role="img" aria-label={plot.title}>
        <rect
          x={MARGIN.left}
          y={MARGIN.top}
          width={frame.width - MARGIN.left - MARGIN.right}
          height={frame.height - MARGIN.top - MARGIN.bottom}
        />
        <Axes frame={frame} name={plot.x} />
        {plot.series.map((series, i) => (
          <path
            key={i}
            class={series.draw}
            style={{ ...toneOf(series), strokeWidth: series.draw === 'dots' ? dotSize(series) : 1.6 }}
            d={pathOf(series, frame)}
          />
        ))}
      </svg>
    </figure>
  );
}
