import { timeRange } from '../state/plot_view';
import { run } from '../state/run';
import { drawAll } from './picture_drawings';
import { chartColours } from './plot_colours';

const COLUMN = 560;
const HEAD = 26;

/** All plots on one canvas in two columns, with their titles, including those scrolled away. */
export async function pictureOfPlots(): Promise<HTMLCanvasElement> {
  await drawAll();
  const colours = chartColours();
  const plots = [...document.querySelectorAll<HTMLElement>('.plots .plot')].flatMap((plot) => {
    const canvas = plot.querySelector('canvas');
    return canvas && canvas.width > 0
      ? [{ canvas, title: plot.querySelector('h2')?.innerText ?? '', keys: keysOf(plot) }]
      : [];
  });
  const tall = Math.max(
    120,
    ...plots.map(({ canvas }) => (canvas.height / canvas.width) * COLUMN).filter((height) => height < COLUMN * 0.6),
  );
  const rows = Math.ceil(plots.length / 2);
  const picture = document.createElement('canvas');
  picture.width = 2 * COLUMN + 48;
  picture.height = 44 + rows * (tall + HEAD + 14);
  const context = picture.getContext('2d');
  if (!context) return picture;
  context.fillStyle = colours.panel;
  context.fillRect(0, 0, picture.width, picture.height);
  context.fillStyle = colours.text;
  context.font = `600 14px ${colours.font}`;
  context.fillText(caption(), 16, 26);
  plots.forEach(({ canvas, title, keys }, i) => {
    const [x, y] = [16 + (i % 2) * (COLUMN + 16), 40 + Math.floor(i / 2) * (tall + HEAD + 14)];
    context.fillStyle = colours.text;
    context.font = `600 12px ${colours.font}`;
    context.fillText(title, x, y + 16);
    let at = x + COLUMN;
    context.font = `12px ${colours.font}`;
    context.textAlign = 'right';
    for (const { text, colour } of keys.reverse()) {
      context.fillStyle = colour;
      context.fillText(text, at, y + 16);
      at -= context.measureText(text).width + 12;
    }
    context.textAlign = 'left';
    const scale = Math.min(COLUMN / canvas.width, tall / canvas.height);
    context.drawImage(canvas, x, y + HEAD, canvas.width * scale, canvas.height * scale);
  });
  return picture;
}

function keysOf(plot: HTMLElement): { text: string; colour: string }[] {
  return [...plot.querySelectorAll<HTMLElement>('.key')].map((key) => {
    const stroke = key.querySelector<HTMLElement>('.stroke');
    return { text: key.innerText.trim(), colour: getComputedStyle(stroke ?? key)[stroke ? 'borderTopColor' : 'color'] };
  });
}

function caption(): string {
  const [from, to] = timeRange();
  return [run.value?.controller, run.value?.car, run.value?.track, `${from.toFixed(1)} s to ${to.toFixed(1)} s`]
    .filter(Boolean)
    .join(' · ');
}
