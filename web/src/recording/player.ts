import { computed, signal } from '@preact/signals';
import { readSchema } from '../protocol/schema';
import type { Frame } from '../protocol/topics';
import { session as drawing } from '../scene3d/session';
import { beginSession, receive, rewind } from '../state/demultiplexer';
import { keepAllLaps, lapSamples, laps, sampleLap } from '../state/laps';
import { link, notice, services } from '../state/link';
import { complete } from '../state/message_fields';
import { run } from '../state/run';
import { schema } from '../state/settings';
import { beginSettings, takeSettings } from '../state/settings_session';
import { everyFrame } from '../state/ticker';
import { type Landmark, LogSource, landmarksOf } from './log_source';
import type { McapLog } from './mcap_log';
import type { Mode } from './mode';
import { openFiles, openRecordings, type Recordings } from './open';
import { RecordedDrive } from './recorded_drive';

// State of the time line.

export const player = signal<LogSource | null>(null);
export const logs = signal<readonly McapLog[]>([]);
/** Index of the one that is played. */
export const played = signal(0);
export const position = signal(0); // [s]
export const isPlaying = signal(false);
export const landmarks = signal<readonly Landmark[]>([]);
/** Share of the recording that has been searched for landmarks. */
export const searched = signal(0);
export const duration = computed(() => player.value?.log.duration ?? 0);

/** Schema of the pace, the only setting of a recording. */
const PACE = readSchema([
  {
    key: 'run.pace',
    group: 'run',
    kind: 'number',
    unit: '',
    minimum: 0.05,
    maximum: 20,
    choices: [],
    default: 1,
    meaning: 'How fast the recording plays.',
    is_live: true,
  },
]);

async function framesOf(log: McapLog): Promise<{ time: number; frame: Frame }[]> {
  const frames = await log.read(['/chicane/frame'], 0, log.duration);
  return frames.map(({ time, message }) => ({ time, frame: complete('/chicane/frame', message as Frame) }));
}

/** Plays one of several recordings; another one is shown beside it as a ghost. */
export async function play(recordings: Recordings, which = 0, start = recordings.start): Promise<LogSource> {
  const log = recordings.logs[which];
  if (!log) throw new Error('there is no recording to show');
  player.value?.close();
  logs.value = recordings.logs;
  played.value = which;
  landmarks.value = [];
  const source = await LogSource.open(log, {
    open(name) {
      beginSession();
      beginSettings(name);
      schema.value = PACE;
      link.value = 'live';
    },
    lost: () => undefined,
    rewind,
    message: (topic, message) => receive(topic, message, performance.now()),
    services: (names) => (services.value = names),
    settings: takeSettings,
    notice: (sentence) => (notice.value = sentence),
    moved(time, plays) {
      position.value = time;
      isPlaying.value = plays;
    },
  });
  player.value = source;
  await source.seek(start);
  void look(source);
  const rival = recordings.logs[which === 0 ? 1 : 0];
  drawing.rival =
    rival && rival !== log ? RecordedDrive.from(rival.name, await framesOf(rival), () => position.value) : null;
  return source;
}

export const playMode = async (mode: Exclude<Mode, { name: 'live' }>): Promise<LogSource> =>
  play(await openRecordings(mode));
export const playFiles = async (files: readonly File[]): Promise<LogSource> => play(await openFiles(files));

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
    for (const { frame } of await framesOf(log)) {
      if (player.value !== source) return;
      sampleLap(frame);
    }
    for (const { lap, lap_time_s: time } of laps.value) lapSamples.complete(lap - 1, time);
    laps.value = [...laps.value]; // notifies the views that the laps can be compared now
  } catch (error) {
    notice.value = error instanceof Error ? error.message : String(error);
  }
}

everyFrame((now) => player.value?.advance(now));
