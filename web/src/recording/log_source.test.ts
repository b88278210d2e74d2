import { parse } from '@foxglove/rosmsg';
import { MessageWriter } from '@foxglove/rosmsg2-serialization';
import { McapWriter, TempBuffer } from '@mcap/core';
import { beforeAll, describe, expect, it } from 'vitest';
import type { Frame, TopicName } from '../protocol/topics';
import { type LogEvents, LogSource, landmarksOf, runStarts } from './log_source';
import { McapLog } from './mcap_log';
import { BytesReadable, HttpReadable } from './readable';

// A small recording of 10 s: frames at 10 Hz on a straight, a lap at 4 s, off the road at 6 s, a setting changed at 7
// s, one fault from 8 s to 9 s and another that begins where that ends. It was driven at 15 times its pace.
const FRAME =
  'float64 time_s\nuint32 off_track_events\nuint8 rung\nbool is_gated\nuint32 active_faults\nfloat64 pace\n';
const LAP = 'uint32 lap\nfloat64 lap_time_s\n';
const CHANGE = 'string name\nstring value\n';
const RUN = 'string track\nbool is_paused\nstring[] fault_names\n';
const HOUR_NS = 3_600_000_000_000n; // log times need not begin at zero

describe('the runs of a recording', () => {
  const message = (topic: TopicName, time: number, content = {}) => ({ topic, time, message: content as never });
  const lap = (number: number, time: number) => message('/chicane/lap', time, { lap: number, lap_time_s: 3 });

  it('begin where another one is reported, and where laps are counted again', () => {
    expect(runStarts([message('/chicane/run', 0), lap(1, 5), lap(2, 8)])).toEqual([0]);
    expect(runStarts([message('/chicane/run', 0), lap(1, 5), message('/chicane/run', 6), lap(1, 9)])).toEqual([0, 6]);
    expect(runStarts([message('/chicane/run', 0), lap(1, 5), lap(1, 9), lap(2, 12)])).toEqual([0, 6]);
  });
});

async function record(isClosed = true): Promise<Uint8Array> {
  const file = new TempBuffer();
  const writer = new McapWriter({ writable: file, chunkSize: 2000 });
  await writer.start({ profile: 'ros2', library: 'test' });
  const channels = new Map<string, { id: number; writer: MessageWriter }>();
  for (const [topic, text] of [
    ['/chicane/run', RUN],
    ['/chicane/frame', FRAME],
    ['/chicane/lap', LAP],
    ['/chicane/change', CHANGE],
  ] as const) {
    const data = new TextEncoder().encode(text);
    const schemaId = await writer.registerSchema({ name: topic, encoding: 'ros2msg', data });
    const id = await writer.registerChannel({ schemaId, topic, messageEncoding: 'cdr', metadata: new Map() });
    channels.set(topic, { id, writer: new MessageWriter(parse(text, { ros2: true })) });
  }
  const add = async (topic: string, seconds: number, message: object): Promise<void> => {
    const channel = channels.get(topic);
    if (!channel) throw new Error(topic);
    const logTime = HOUR_NS + BigInt(Math.round(seconds * 1e9));
    const data = channel.writer.writeMessage(message);
    await writer.addMessage({ channelId: channel.id, sequence: 0, logTime, publishTime: logTime, data });
  };
  await add('/chicane/run', 0, { track: 'straight', is_paused: false, fault_names: ['link_lost', 'half_grip'] });
  for (let i = 0; i <= 100; ++i) {
    const time = i / 10;
    const faults = time < 8 ? 0 : time < 9 ? 2 : 1;
    const events = { off_track_events: time >= 6 ? 1 : 0, rung: 0, is_gated: false, active_faults: faults };
    await add('/chicane/frame', time, { time_s: time, ...events, pace: 15 });
    if (i === 40) await add('/chicane/lap', time, { lap: 1, lap_time_s: 4 });
    if (i === 70) await add('/chicane/change', time, { name: 'latency_ms', value: '150' });
  }
  if (isClosed) await writer.end();
  return file.get();
}

class Page implements LogEvents {
  sessions: string[] = [];
  received: { topic: TopicName; message: unknown }[] = [];
  rewinds = 0;
  where = { time: NaN, isPlaying: false };
  paces: unknown[] = [];
  open = (session: string): void => void this.sessions.push(session);
  lost = (): void => undefined;
  message = (topic: TopicName, message: unknown): void => void this.received.push({ topic, message });
  services = (): void => undefined;
  settings = (values: ReadonlyMap<string, unknown>): void => void this.paces.push(values.get('run.pace'));
  notice = (sentence: string): never => {
    throw new Error(sentence);
  };
  rewind = (): void => {
    ++this.rewinds;
    this.received = [];
  };
  moved = (time: number, isPlaying: boolean): void => {
    this.where = { time, isPlaying };
  };
  frames(): number[] {
    return this.received
      .filter(({ topic }) => topic === '/chicane/frame')
      .map(({ message }) => (message as Frame).time_s);
  }
}

let bytes: Uint8Array;
let log: McapLog;
beforeAll(async () => {
  bytes = await record();
  log = await McapLog.open('run.mcap', new BytesReadable(bytes));
});

/** Lets pending reads come to their end. */
const settle = async (): Promise<void> => {
  for (let i = 0; i < 20; ++i) await new Promise((resolve) => setTimeout(resolve, 0));
};

describe('a recording', () => {
  it('counts its time from its first message', () => expect(log.duration).toBeCloseTo(10, 6));

  it('names what cannot be read, and what helps', async () => {
    await expect(McapLog.open('cut.mcap', new BytesReadable((await record(false)).slice(0, 3000)))).rejects.toThrow(
      /cut\.mcap.*chicane replay/,
    );
    await expect(McapLog.open('text', new BytesReadable(new Uint8Array(40)))).rejects.toThrow('text');
  });

  it('shows its landmarks', async () => {
    const shares: number[] = [];
    const found = await landmarksOf(log, (share) => shares.push(share));
    expect(found.map(({ kind, time, label }) => [kind, Math.round(time * 10) / 10, label])).toEqual([
      ['lap', 4, 'lap 1: 4.00 s'],
      ['off-track', 6, 'off the road'],
      ['change', 7, 'latency_ms = 150'],
      ['fault', 8, 'half grip'],
      ['fault', 9, 'link lost'],
    ]);
    expect(shares.at(-1)).toBeCloseTo(1, 6);
  });
});

async function opened() {
  const page = new Page();
  return { page, source: await LogSource.open(log, page) };
}

describe('playing a recording', () => {
  it('sends the minute before the time sought, and every lap', async () => {
    const { page, source } = await opened();
    await source.seek(5.04);
    expect(page.rewinds).toBe(1);
    expect(page.frames().at(0)).toBe(0);
    expect(page.frames().at(-1)).toBe(5);
    await source.seek(3);
    expect(page.frames().at(-1)).toBe(3);
    // The pace of playing, not of the recorded run; and all laps, including later ones.
    expect(page.received.find(({ topic }) => topic === '/chicane/frame')?.message).toMatchObject({ pace: 1 });
    expect(page.received.filter(({ topic }) => topic === '/chicane/lap')).toHaveLength(1);
    const run = { track: 'straight', mode: 'replay', is_paused: true };
    expect(page.received.find(({ topic }) => topic === '/chicane/run')?.message).toMatchObject(run);
  });

  it('plays at its pace, in order, each message once, to the end', async () => {
    const { page, source } = await opened();
    await source.seek(0);
    expect(await source.set('run.pace', 2)).toEqual({ value: 2, sentence: null });
    await source.call('/pause', false);
    let now = 1000;
    source.advance(now);
    await settle();
    // One second at twice the pace.
    for (let i = 0; i < 10; ++i) {
      now += 100;
      source.advance(now);
    }
    expect(page.where.time).toBeCloseTo(2, 6);
    expect(page.frames().at(-1)).toBeCloseTo(2, 6);
    for (let i = 0; i < 100 && page.where.isPlaying; ++i) {
      now += 100;
      source.advance(now);
      await settle();
    }
    expect(page.where).toEqual({ time: log.duration, isPlaying: false });
    expect(page.frames()).toEqual([...new Set(page.frames())].sort((a, b) => a - b));
    expect(page.frames()).toHaveLength(101);
  });

  it('steps from one control step to the next', async () => {
    const { page, source } = await opened();
    await source.seek(6.95);
    expect(await source.call('/step')).toBeNull();
    expect(page.frames().at(-1)).toBe(7);
    expect(page.received.some(({ topic }) => topic === '/chicane/change')).toBe(true);
    await source.seek(10);
    expect(await source.call('/step')).toMatch('ends here');
  });

  it('drops the result of a jump when another one follows', async () => {
    const { page, source } = await opened();
    await Promise.all([source.seek(9), source.seek(1)]);
    expect(page.rewinds).toBe(1);
    expect(page.frames().at(-1)).toBe(1);
  });

  it('refuses to change what was recorded, and an impossible pace', async () => {
    const { source } = await opened();
    expect((await source.set('latency_ms', 50)).sentence).toMatch('belongs to the recording');
    expect(await source.set('run.pace', 100)).toEqual({ value: 1, sentence: 'run.pace: got 100, expected 0.05 to 20' });
  });
});

describe('a recording on a server', () => {
  const serve = (asked: string[]): typeof fetch =>
    ((_url: string, init: { headers: { range: string } }) => {
      asked.push(init.headers.range);
      const [from = 0, to = 0] = init.headers.range.slice('bytes='.length).split('-').map(Number);
      const body = bytes.slice(from, to + 1);
      return Promise.resolve(
        new Response(body, { status: 206, headers: { 'content-range': `bytes ${from}-${to}/${bytes.length}` } }),
      );
    }) as unknown as typeof fetch;

  it('is read by ranges, each block once', async () => {
    const asked: string[] = [];
    const remote = await McapLog.open('run.mcap', new HttpReadable('/log/0.mcap', serve(asked)));
    expect(await remote.read(['/chicane/frame'], 0, 10)).toHaveLength(101);
    expect(asked).toEqual(['bytes=0-0', `bytes=0-${bytes.length - 1}`]);
  });

  it('says when the server knows no ranges', async () => {
    const whole = (() => Promise.resolve(new Response('all of it', { status: 200 }))) as unknown as typeof fetch;
    await expect(McapLog.open('run.mcap', new HttpReadable('/log/0.mcap', whole))).rejects.toThrow('HTTP 200');
  });
});
