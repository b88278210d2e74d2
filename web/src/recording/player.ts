// State of the recordings that are shown: the one that plays, its time line, its laps, and another one as a ghost.
import { computed, effect, untracked } from '@preact/signals';
import { store } from '../lib/store';
import { reasonOf } from '../lib/words';
import { readSchema } from '../protocol/schema';
import { complete, type Frame, type Run } from '../protocol/topics';
import { posesOf, RecordedDrive } from '../scene3d/ghost';
import { beginSession, receive, rewind } from '../state/demultiplexer';
import { ghosts } from '../state/ghost_shown';
import { keepAllLaps, lapSamples, laps, sampleLap } from '../state/laps';
import { link, notice, services } from '../state/link';
import { requests } from '../state/operate';
import { removeOtherLaps } from '../state/other_laps';
import { run } from '../state/run';
import { seekTo } from '../state/seek';
import { schema } from '../state/settings';
import { everyFrame } from '../state/ticker';
import { offerLaps } from './add_laps';
import { type Landmark, LogSource, landmarksOf } from './log_source';
import type { McapLog } from './mcap_log';
import type { ServedLogs } from './mode';
import { openFiles, openRecordings, type Recordings } from './open';
import { type LoggedRun, runsOf } from './runs_of_log';

/** The recording that plays; null in a live run. */
export const player = store.signal<LogSource | null>('page', null);
export const logs = store.signal<readonly McapLog[]>('page', []);
/** Index of the one that is played. */
export const played = store.signal('page', 0);
export const position = store.signal('page', 0); // [s]
export const isPlaying = store.signal('page', false);
export const landmarks = store.signal<readonly Landmark[]>('page', []);
/** Share of the recording that has been searched for landmarks, in [0, 1]. */
export const searched = store.signal('page', 0);
export const duration = computed(() => player.value?.log.duration ?? 0);

/** Schema of the pace, the only setting of a recording. */
const PACE = readSchema([
  { key: 'run.pace', kind: 'number', minimum: 0.05, maximum: 20, default: 1, meaning: 'How fast the recording plays.' },
]);

/** All frames of a recording. */
async function framesOf(log: McapLog): Promise<{ time: number; frame: Frame }[]> {
  const frames = await log.read(['/chicane/frame'], 0, log.duration);
  return frames.map(({ time, message }) => ({ time, frame: complete('/chicane/frame', message as Frame) }));
}

/** Plays one of several recordings; another one is shown beside it as a ghost. */
export async function play(recordings: Recordings, which = 0, start = recordings.start): Promise<LogSource> {
  const log = recordings.logs[which];
  if (!log) throw new Error('there is no recording to show');
  player.value?.close();
  sampling.end();
  logs.value = recordings.logs;
  played.value = which;
  landmarks.value = [];
  const source = await LogSource.open(log, {
    open() {
      beginSession();
      schema.value = PACE;
      link.value = 'live';
    },
    lost: () => undefined,
    rewind,
    message: (topic, message) => receive(topic, message, performance.now()),
    services: (names) => (services.value = names),
    settings: (values) => requests.receive(values),
    notice: (sentence) => (notice.value = sentence),
    moved(time, plays) {
      position.value = time;
      isPlaying.value = plays;
    },
  });
  player.value = source;
  seekTo.value = (time) => void source.seek(time).catch((error: unknown) => (notice.value = reasonOf(error)));
  await source.seek(start);
  void look(source);
  await showBeside(beside.value, log);
  return source;
}

/** Index of the recording that is shown as a ghost beside the one played; −1: none. */
export const beside = store.signal('page', 1);

/** Shows another recording as a ghost, where it was driven on the same track. */
export async function showBeside(which: number, log = logs.value[played.value]): Promise<void> {
  const rival = logs.value[which] === log ? logs.value.find((each) => each !== log) : logs.value[which];
  ghosts.recording = null;
  beside.value = rival ? logs.value.indexOf(rival) : -1;
  if (!rival || !log) return;
  const [mine, other] = await Promise.all([trackOf(log), trackOf(rival)]);
  if (mine !== other) {
    notice.value = `${rival.name} was driven on another track (${other.split(' ')[0]}): it is not drawn on this road`;
    beside.value = -1;
    return;
  }
  ghosts.recording = new RecordedDrive(rival.name, posesOf(await framesOf(rival)), Infinity, () => position.value);
}

/** Track of a recording and its length, as one text. */
async function trackOf(log: McapLog): Promise<string> {
  const [first] = await log.read(['/chicane/run'], 0, log.duration);
  const run = complete('/chicane/run', (first?.message ?? {}) as Run);
  return `${run.track} ${run.track_length_m.toFixed(1)}`;
}

/** Plays the first of the recordings that the program serves, or that were dropped on the page. */
export async function playFirst(from: ServedLogs | readonly File[]): Promise<LogSource> {
  const recordings = await ('logs' in from ? openRecordings(from) : openFiles(from));
  void readRuns(recordings);
  return play(recordings);
}

/** Runs of all recordings, where there are several. */
const others = store.data('page', () => ({ runs: [] as readonly LoggedRun[] }));

/** Reads the laps of several recordings, one after another. */
async function readRuns({ logs: all }: Recordings): Promise<void> {
  others.runs = [];
  try {
    if (all.length > 1) for (const log of all) others.runs = [...others.runs, ...(await runsOf(log))];
    offerOthers();
  } catch (error) {
    notice.value = reasonOf(error);
  }
}

/** Offers the laps of the recordings that are not played for comparison. */
function offerOthers(): void {
  removeOtherLaps();
  const log = logs.value[played.value];
  offerLaps(others.runs.filter(({ recording }) => recording !== log?.name));
}

/** Ends the sampling of the recording that was played before. */
const sampling = store.data('page', () => ({ end: (): void => undefined }));

/** Samples all laps of the run that is shown. */
function sampleRun(source: LogSource, frames: readonly { time: number; frame: Frame }[], which: number): void {
  lapSamples.clear();
  for (const { time, frame } of frames) if (source.runAt(time) === which) sampleLap(frame);
  for (const { lap, lap_time_s: seconds } of laps.value) lapSamples.complete(lap - 1, seconds);
  laps.value = [...laps.value]; // notifies the views that the laps can be compared now
}

/** Reads the whole recording while it plays: landmarks, and all laps for comparison. */
async function look(source: LogSource): Promise<void> {
  const { log } = source;
  try {
    const found = await landmarksOf(log, (share) => (searched.value = share));
    if (player.value !== source) return;
    landmarks.value = found;
    searched.value = 1;
    if (!run.value) return;
    keepAllLaps();
    const frames = await framesOf(log);
    let sampled = -1;
    sampling.end = effect(() => {
      const now = source.runAt(position.value);
      if (player.value !== source || now === sampled) return;
      sampled = now;
      untracked(() => {
        sampleRun(source, frames, now);
        offerOthers();
      });
    });
  } catch (error) {
    notice.value = reasonOf(error);
  }
}

everyFrame((now) => player.value?.advance(now));
