import { expect, it } from 'vitest';
import type { Socket } from './foxglove';
import { ReadingSocket } from './reading';

function connected() {
  const sent: unknown[] = [];
  const raw: Socket = {
    binaryType: 'arraybuffer',
    onclose: null,
    onmessage: null,
    close: () => undefined,
    send: (data) => sent.push(JSON.parse(String(data))),
  };
  const clock = { now: 1000 };
  const log = { ages: [] as number[], left: [] as number[], passed: [] as unknown[] };
  const socket = new ReadingSocket(
    raw,
    { age: (seconds) => log.ages.push(seconds), pastLeft: (messages) => log.left.push(messages) },
    { now: () => clock.now },
  );
  socket.onmessage = ({ data }) => log.passed.push(data);
  return { raw, sent, clock, log, socket, say: (data: unknown) => raw.onmessage?.({ data }) };
}

it('acknowledges bytes, not each message', () => {
  const { sent, clock, say } = connected();
  say(new ArrayBuffer(100));
  expect(sent).toEqual([{ op: 'received', bytes: 100, at: 1000 }]);
  clock.now += 10;
  for (let i = 0; i < 39; ++i) say(new ArrayBuffer(100));
  expect(sent).toHaveLength(1);
  for (let i = 0; i < 2; ++i) say(new ArrayBuffer(100));
  expect(sent[1]).toEqual({ op: 'received', bytes: 4200, at: 1010 });
  clock.now += 40;
  say(new ArrayBuffer(1));
  expect(sent[2]).toEqual({ op: 'received', bytes: 4201, at: 1050 });
});

it('acknowledges what nobody can read, or the program would wait for ever', () => {
  const { raw, sent, socket } = connected();
  socket.onmessage = () => {
    throw new Error('unreadable');
  };
  expect(() => raw.onmessage?.({ data: new ArrayBuffer(100) })).toThrow('unreadable');
  expect(sent).toHaveLength(1);
});

it('says how old the next frame is at most, and how much of the past is left', () => {
  const { clock, log, say } = connected();
  clock.now = 3000;
  say('{"op":"heard","at":1000.0,"held":0.5}');
  say('{"messages":17,"op":"pastLeft"}');
  expect(log.ages).toEqual([1.5]);
  expect(log.left).toEqual([17]);
  expect(log.passed).toEqual([]);
});

it('passes everything else on, texts that contain such words, too', () => {
  const { log, say } = connected();
  const texts = ['{"op":"status","level":2,"message":"no"}', '{"op":"serverInfo","metadata":{"op":"heard"}}'];
  for (const text of texts) say(text);
  expect(log.passed).toEqual(texts);
});
