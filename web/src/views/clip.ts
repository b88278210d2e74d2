import { download, fileName } from '../lib/download';
import { fixed, lapTime } from '../lib/format';
import { store } from '../lib/store';
import { inSpeedUnit, speedUnit } from '../lib/units';
import { live } from '../state/live';
import { endReplay, isReplaying, startReplay } from '../state/replay';
import { run } from '../state/run';
import { everyFrame } from '../state/ticker';

// The last seconds as a film: they are shown once more, and what the picture shows is recorded by the browser.

const FRAMES_PER_SECOND = 30;
const TYPES = ['video/webm;codecs=vp9', 'video/webm', 'video/mp4'];

/** Whether a film is being made. */
export const isFilming = store.signal('page', false);

const typeOfFilm = (): string | undefined =>
  typeof MediaRecorder === 'undefined' ? undefined : TYPES.find((type) => MediaRecorder.isTypeSupported(type));

export const canFilm = (): boolean => !isFilming.value && typeOfFilm() !== undefined;

/** The picture, with speed, lap time and track written on it. */
function paint(into: CanvasRenderingContext2D, picture: HTMLCanvasElement): void {
  const { width, height } = into.canvas;
  into.drawImage(picture, 0, 0, width, height);
  const frame = live.frame;
  if (!frame) return;
  const size = Math.round(height / 20);
  const text = [
    `${fixed(inSpeedUnit(frame.speed_mps), 0)} ${speedUnit().name}`,
    `lap ${frame.lap + 1}  ${lapTime(frame.lap_time_s)}`,
    run.value?.track ?? '',
  ].join('   ');
  into.font = `600 ${size}px system-ui, sans-serif`;
  into.fillStyle = 'rgb(10 14 20 / 70%)';
  into.fillRect(0, height - 2 * size, width, 2 * size);
  into.fillStyle = '#fff';
  into.fillText(text, size, height - 0.65 * size);
}

/** Shows the last seconds once more, and offers their film as a file when they are over. */
export function film(): void {
  const picture = [...document.querySelectorAll<HTMLCanvasElement>('.map canvas')][0];
  const type = typeOfFilm();
  if (!picture || picture.width === 0 || type === undefined) return;
  const canvas = document.createElement('canvas');
  // Coders want even sizes.
  [canvas.width, canvas.height] = [picture.width & ~1, picture.height & ~1];
  const context = canvas.getContext('2d');
  if (!context) return;
  if (isReplaying()) endReplay();
  startReplay();
  if (!isReplaying()) return;
  isFilming.value = true;
  const recorder = new MediaRecorder(canvas.captureStream(FRAMES_PER_SECOND), { mimeType: type });
  const parts: Blob[] = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  recorder.onstop = () => {
    isFilming.value = false;
    const ending = type.startsWith('video/mp4') ? 'mp4' : 'webm';
    download(fileName([run.value?.track ?? '', 'last-seconds'], ending), new Blob(parts, { type }));
  };
  recorder.start(1000);
  const end = everyFrame(() => {
    if (picture.isConnected) paint(context, picture);
    if (isReplaying()) return;
    end();
    recorder.stop();
  });
}
