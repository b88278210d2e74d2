// Plays a recording as a source of messages: seek, step, pace, and the events of its time line.
import { begunBits } from '../lib/bits';
import { nameInWords, reasonOf } from '../lib/words';
import type { ServiceName, SetAnswer, Setting, Source, SourceEvents } from '../protocol/source';
import type { Frame, Lap, Run, TopicName } from '../protocol/topics';
import type { LoggedMessage, McapLog } from './mcap_log';

/** An event on the time line of a recording. */
export interface Landmark {
  readonly time: number; // [s]
  readonly kind: 'run' | 'lap' | 'change' | 'off-track' | 'fallback' | 'gate' | 'fault';
  readonly label: string;
}

/** What a recording reports beside the events of any source. */
export interface LogEvents extends SourceEvents {
  /** Playback jumps: what was shown belongs to another time. */
  rewind(): void;
  /** The position [s], and whether it plays. */
  moved(time: number, isPlaying: boolean): void;
}

/** Topics that describe a run, sent as of any time. */
const STATIC: readonly TopicName[] = [
  '/chicane/run',
  '/track/left',
  '/track/right',
  '/track/centre',
  '/chicane/lap',
  '/chicane/limit',
];
/** Topics of the moments of a run. */
const MOVING: readonly TopicName[] = [
  '/chicane/frame',
  '/chicane/situation',
  '/chicane/plan',
  '/reference',
  '/chicane/change',
];
/** Topics of which only the last seconds matter after a jump. */
const SHORT: readonly TopicName[] = ['/chicane/situation', '/chicane/plan', '/reference'];
/** Time before a jump for which frames are sent [s]: the longest reach of the plots. */
const LOOK_BACK_S = 60;
/** Time before a jump for which plans are sent [s]: more than the age of the plan that is compared (HINDSIGHT_S). */
const PLAN_BACK_S = 1.2;
const SEGMENT_S = 4; // length that is read ahead at once; chosen
/** Bounds of the pace: those of the program's run.pace. */
const LEAST_PACE = 0.05;
const MOST_PACE = 20;

/**
 * Plays a recording with the messages and services of a live run; seek() jumps anywhere. It reads no clock: advance()
 * has to be called at every repaint.
 */
export class LogSource implements Source {
  readonly log: McapLog;
  readonly #events: LogEvents;
  #static: LoggedMessage[] = []; // all messages of STATIC
  #starts: readonly number[] = [0];
  #shown = 0; // the run whose laps are sent
  #segment: LoggedMessage[] = [];
  #readTo = 0; // end of the segment [s]
  #isReading = false;
  #generation = 0; // counts jumps: results of reads begun before the last one are dropped
  #position = 0;
  #isPlaying = false;
  #pace = 1;
  #clock = NaN; // of the last advance() [ms]

  private constructor(log: McapLog, events: LogEvents) {
    this.log = log;
    this.#events = events;
  }

  static async open(log: McapLog, events: LogEvents): Promise<LogSource> {
    const source = new LogSource(log, events);
    source.#static = await log.read(STATIC, 0, log.duration);
    source.#starts = runStarts(source.#static);
    events.open(log.name);
    events.services(new Set<ServiceName>(['/pause', '/step', '/reset']));
    source.#sendPace(true);
    return source;
  }

  /** Where the runs of this recording begin [s], ascending, the first at 0. */
  get starts(): readonly number[] {
    return this.#starts;
  }

  /** Number of the run at a time, from 0. */
  runAt(time: number): number {
    return Math.max(0, this.#starts.filter((start) => start <= time + 1e-9).length - 1);
  }

  close(): void {
    ++this.#generation;
    this.#isPlaying = false;
  }

  call(name: ServiceName, data?: boolean): Promise<string | null> {
    if (name === '/pause') return this.#play(!(data ?? true));
    if (name === '/reset') return this.seek(0).then(() => null);
    return this.step();
  }

  set(name: string, value: Setting): Promise<SetAnswer> {
    if (name !== 'run.pace' || typeof value !== 'number')
      return Promise.resolve({ value: null, sentence: `${name} belongs to the recording and cannot be changed` });
    const isInRange = value >= LEAST_PACE && value <= MOST_PACE;
    if (isInRange) this.#pace = value;
    this.#sendPace(false);
    return Promise.resolve({
      value: this.#pace,
      sentence: isInRange ? null : `run.pace: got ${value}, expected ${LEAST_PACE} to ${MOST_PACE}`,
    });
  }

  refresh(): void {
    this.#sendPace(true);
  }

  /** Jumps to `time` [s]: the messages of the minute before it are sent at once. */
  async seek(time: number): Promise<void> {
    const generation = ++this.#generation;
    const to = Math.min(Math.max(time, 0), this.log.duration);
    this.#position = to;
    this.#events.moved(to, this.#isPlaying);
    const begin = this.#starts[this.runAt(to)] ?? 0; // of the run that is driven then
    const [past, plans] = await Promise.all([
      this.log.read(
        MOVING.filter((topic) => !SHORT.includes(topic)),
        Math.max(begin, to - LOOK_BACK_S),
        to,
      ),
      this.log.read(SHORT, Math.max(begin, to - PLAN_BACK_S), to),
    ]);
    if (generation !== this.#generation) return;
    this.#events.rewind();
    this.#sendStatic(to);
    for (const each of [...past, ...plans].sort((a, b) => a.time - b.time)) this.#send(each);
    this.#segment = [];
    this.#readTo = to;
    this.#clock = NaN;
    this.#events.moved(to, this.#isPlaying);
  }

  /** Advances to the next control step. */
  async step(): Promise<string | null> {
    const generation = this.#generation;
    for (let ahead = 0.1; ahead < 20; ahead *= 4) {
      const frames = await this.log.read(['/chicane/frame'], this.#position + 1e-6, this.#position + ahead);
      if (generation !== this.#generation) return null;
      const next = frames[0];
      if (!next) continue;
      const all = await this.log.read([...MOVING, ...STATIC], this.#position + 1e-6, next.time + 1e-6);
      if (generation !== this.#generation) return null;
      for (const each of all) this.#send(each);
      this.#position = this.#readTo = next.time;
      this.#segment = [];
      this.#events.moved(next.time, this.#isPlaying);
      return null;
    }
    return 'the recording ends here';
  }

  /** Sends the messages due at `now`, as of performance.now() [ms]. */
  advance(now: number): void {
    const elapsed = (now - this.#clock) / 1000;
    this.#clock = now;
    if (!this.#isPlaying) return;
    void this.#readAhead();
    if (!(elapsed >= 0)) return;
    const wanted = this.#position + Math.min(elapsed, 0.25) * this.#pace;
    const until = Math.min(wanted, this.#readTo, this.log.duration); // waits for the reader
    let sent = 0;
    for (const each of this.#segment) {
      if (each.time > until + 1e-9) break; // tolerates rounding of summed intervals
      this.#send(each);
      ++sent;
    }
    this.#segment.splice(0, sent);
    this.#position = until;
    if (this.runAt(until) !== this.#shown) this.#sendStatic(until);
    if (until >= this.log.duration) this.#isPlaying = false;
    this.#events.moved(until, this.#isPlaying);
    if (!this.#isPlaying) this.#sendStatic(until);
  }

  /** Begins or ends playing; from the end of the recording it begins again. */
  async #play(isPlaying: boolean): Promise<null> {
    if (isPlaying && this.#position >= this.log.duration) await this.seek(0);
    this.#isPlaying = isPlaying;
    this.#clock = NaN;
    this.#sendStatic(this.#position, ['/chicane/run']);
    this.#events.moved(this.#position, isPlaying);
    return null;
  }

  /** Reads the next segment before it is due. */
  async #readAhead(): Promise<void> {
    const enough = this.#position + (SEGMENT_S / 2) * Math.max(1, this.#pace);
    if (this.#isReading || this.#readTo >= enough || this.#readTo >= this.log.duration) return;
    this.#isReading = true;
    const generation = this.#generation;
    const [from, to] = [this.#readTo, this.#readTo + SEGMENT_S * Math.max(1, this.#pace)];
    try {
      const messages = await this.log.read([...MOVING, ...STATIC], from + 1e-9, to);
      if (generation !== this.#generation) return;
      this.#segment.push(...messages);
      this.#readTo = to;
    } catch (error) {
      this.#isPlaying = false;
      this.#events.notice(`the recording cannot be read further: ${reasonOf(error)}`);
    } finally {
      this.#isReading = false;
    }
  }

  /** Sends run and road as of `time`, and all laps of the run that is driven then. */
  #sendStatic(time: number, topics: readonly TopicName[] = STATIC): void {
    this.#shown = this.runAt(time);
    for (const topic of topics) {
      const known = this.#static.filter((each) => each.topic === topic);
      const sent =
        topic === '/chicane/lap'
          ? known.filter((each) => this.runAt(each.time - 1e-6) === this.#shown)
          : [known.filter((each) => each.time <= time).at(-1) ?? known[0]];
      for (const each of sent) if (each) this.#send(each);
    }
  }

  #send({ topic, message }: LoggedMessage): void {
    if (topic === '/chicane/run')
      this.#events.message(topic, { ...(message as Run), mode: 'replay', is_paused: !this.#isPlaying });
    else if (topic === '/chicane/frame') this.#events.message(topic, { ...(message as Frame), pace: this.#pace });
    else this.#events.message(topic, message as never);
  }

  #sendPace(isAll: boolean): void {
    this.#events.settings(new Map([['run.pace', this.#pace]]), isAll);
  }
}

/** Where runs begin: another run is described, or laps are counted from 1 again. */
export function runStarts(messages: readonly LoggedMessage[]): number[] {
  const starts = [0];
  let lap = 0;
  const begin = (time: number): void => {
    if (time > (starts.at(-1) ?? 0) + 1e-6) starts.push(time);
    lap = 0;
  };
  for (const { topic, time, message } of messages) {
    if (topic === '/chicane/run' && time > 0) begin(time);
    if (topic !== '/chicane/lap') continue;
    const { lap: number, lap_time_s: seconds } = message as Lap;
    if (number <= lap) begin(Math.max(0, time - seconds));
    lap = number;
  }
  return starts;
}

/** The events of a recording. `progress` in [0, 1] is called while it is read. */
export async function landmarksOf(
  log: McapLog,
  progress: (share: number) => void = () => undefined,
): Promise<Landmark[]> {
  const found: Landmark[] = [];
  const was = { offTrack: 0, rung: 0, isGated: false, faults: 0, lap: -1 };
  let faultNames: readonly string[] = [];
  for await (const { topic, time, message } of log.messages(
    ['/chicane/run', '/chicane/frame', '/chicane/lap', '/chicane/change'],
    0,
    log.duration,
  )) {
    progress(log.duration > 0 ? time / log.duration : 1);
    if (topic === '/chicane/run') {
      const { track, car } = message as Run;
      if (time > 0) found.push({ time, kind: 'run', label: `another run: ${car} on ${track}` });
      faultNames = (message as Run).fault_names ?? [];
    } else if (topic === '/chicane/lap') {
      const { lap, lap_time_s: seconds } = message as Lap;
      found.push({ time, kind: 'lap', label: `lap ${lap}: ${seconds.toFixed(2)} s` });
    } else if (topic === '/chicane/change') {
      const { name, value } = message as { name: string; value: string };
      if (!name.startsWith('manual.')) found.push({ time, kind: 'change', label: `${name} = ${value}` });
    } else if (topic === '/chicane/frame') {
      const frame = message as { off_track_events: number; rung: number; is_gated: boolean; active_faults?: number };
      const faults = frame.active_faults ?? 0;
      if (frame.off_track_events > was.offTrack) found.push({ time, kind: 'off-track', label: 'off the road' });
      if (frame.rung > 0 && was.rung === 0) found.push({ time, kind: 'fallback', label: 'fallback took over' });
      if (frame.is_gated && !was.isGated) found.push({ time, kind: 'gate', label: 'command gate intervened' });
      for (const bit of begunBits(faults, was.faults))
        found.push({ time, kind: 'fault', label: nameInWords(faultNames[bit] ?? 'fault').toLowerCase() });
      Object.assign(was, { offTrack: frame.off_track_events, rung: frame.rung, isGated: frame.is_gated, faults });
    }
  }
  return found;
}
