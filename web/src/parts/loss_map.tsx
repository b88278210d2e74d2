// Map of a lap in the colours of the time lost to another one.
import { boundsOf, type Point } from '../lib/math';
import { type Comparison, pointAt, scaleOf, stretches } from '../state/comparison';

const PIECE_M = 12; // length of a piece with one colour; chosen
const SIZE = 1000; // of the picture's longer side, in its own units

/** Colour from grey, where A is as fast, to that of lost or won. */
const colourOf = (lost: number, share: number): string =>
  `color-mix(in srgb, var(${lost > 0 ? '--lost' : '--won'}) ${Math.round(100 * share)}%, var(--edge))`;

/** The way of A in the colours of the time lost to B, with the numbers of corners; `at`: a place that is marked [m]. */
export function LossMap({ comparison, at }: { comparison: Comparison; at?: number }) {
  const { a, corners, length } = comparison;
  const [xs, ys] = [a.channel('x_m'), a.channel('y_m')];
  const pointOf = (place: number): Point => {
    const i = pointAt(comparison, place);
    return { x: xs?.[i] ?? NaN, y: -(ys?.[i] ?? NaN) };
  };
  const all = Array.from(xs ?? [], (x, i) => ({ x, y: -(ys?.[i] ?? NaN) }));
  const box = boundsOf(all);
  if (!box) return null;
  const [width, height] = [box.maxX - box.minX, box.maxY - box.minY];
  const scale = SIZE / Math.max(width, height, 1);
  const place = ({ x, y }: Point): [number, number] => [(x - box.minX) * scale, (y - box.minY) * scale];
  const pieces = stretches(comparison, PIECE_M);
  const most = scaleOf(pieces);
  const margin = 90;
  const labels = corners.flatMap(({ name, apex }) => {
    const [before, here, after] = [-0.03, 0, 0.03].map((step) => pointOf(apex + step * length)) as [
      Point,
      Point,
      Point,
    ];
    // Outwards: away from the middle of the chord.
    const [dx, dy] = [here.x - (before.x + after.x) / 2, here.y - (before.y + after.y) / 2];
    const far = Math.hypot(dx, dy) || 1;
    const [x, y] = place(here);
    // A lap that was seen in part has no place for some corners.
    return Number.isFinite(x + y + dx + dy) ? [{ name, x: x + (62 * dx) / far, y: y + (62 * dy) / far }] : [];
  });
  const dot = at === undefined ? null : place(pointOf(at));
  return (
    <svg
      class="loss-map chart"
      viewBox={`${-margin} ${-margin} ${width * scale + 2 * margin} ${height * scale + 2 * margin}`}
      role="img"
      aria-label={`The way of ${a.name} in the colours of the time lost`}
    >
      {pieces.map(({ from, to, lost }) => {
        const points = [0, 0.25, 0.5, 0.75, 1].map((share) => place(pointOf(from + share * (to - from))));
        const known = points.filter(([x, y]) => Number.isFinite(x + y));
        const share = Number.isFinite(lost) ? Math.min(1, Math.abs(lost) / most) : 0;
        return (
          <polyline
            key={from}
            points={known.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join(' ')}
            style={{ stroke: colourOf(lost, share), strokeWidth: 12 + 9 * share }}
          />
        );
      })}
      {labels.map(({ name, x, y }) => (
        <text key={name} class="turn" font-size="46" text-anchor="middle" dominant-baseline="central" x={x} y={y}>
          {name}
        </text>
      ))}
      {dot && Number.isFinite(dot[0] + dot[1]) && (
        <circle class="cursor" cx={dot[0]} cy={dot[1]} r="19" style={{ strokeWidth: 9 }} />
      )}
    </svg>
  );
}
