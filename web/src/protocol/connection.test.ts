import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import { Connection, retryDelay } from './connection';
import type { Socket } from './foxglove';
import type { SourceEvents } from './source';
import { bytesOf, topics } from './test_fixtures';
import { TOPIC_NAMES } from './topics';

/** A server on the other end of no network. */
class FakeSocket implements Socket {
  binaryType = '';
  onclose: Socket['onclose'] = null;
  onmessage: Socket['onmessage'] = null;
  readonly sent: (string | Uint8Array)[] = [];
  close(): void {
    this.onclose?.({});
  }
  send(data: string | Uint8Array): void {
    this.sent.push(data);
  }
  say(message: object): void {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
  sayBytes(bytes: Uint8Array): void {
    this.onmessage?.({ data: bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) });
  }
  introduce(capabilities: string[] = []): void {
    this.say({ op: 'serverInfo', name: 'chicane', sessionId: 'a1', capabilities });
    this.say({
      op: 'advertise',
      channels: topics.map(({ topic, type, schema }, id) => ({ id, topic, encoding: 'cdr', schemaName: type, schema })),
    });
    this.say({
      op: 'advertiseServices',
      services: ['/pause', '/step'].map((name, id) => ({ id, name, responseSchema: 'bool success\nstring message\n' })),
    });
  }
}

/** A connection; of a server with `capabilities`, one that is introduced. */
function start(capabilities?: string[]) {
  const sockets: FakeSocket[] = [];
  const state = { open: vi.fn(), lost: vi.fn(), services: vi.fn() };
  const events = { ...state, message: vi.fn(), settings: vi.fn(), notice: vi.fn() };
  const connection = new Connection(() => {
    const socket = new FakeSocket();
    sockets.push(socket);
    return socket;
  }, events as SourceEvents);
  if (capabilities) sockets[0]?.introduce(capabilities);
  return { sockets, events, connection, last: () => sockets.at(-1) as FakeSocket };
}

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

it('subscribes to the topics it knows and hands decoded messages on', () => {
  const { events, last } = start([]);
  expect(events.open).toHaveBeenCalledExactlyOnceWith('a1');
  const subscribed = last().sent.map(
    (text) => (JSON.parse(text as string) as { subscriptions: { id: number; channelId: number }[] }).subscriptions[0],
  );
  const wanted = TOPIC_NAMES.filter((name) => name !== '/chicane/past'); // which the server has for viewers alone
  expect(subscribed.map((s) => topics[s?.channelId ?? -1]?.topic).sort()).toEqual([...wanted].sort());
  const run = bytesOf('chicane_run.bin');
  const channel = topics.findIndex(({ topic }) => topic === '/chicane/run');
  const id = subscribed.find((s) => s?.channelId === channel)?.id ?? -1;
  last().sayBytes(new Uint8Array([1, id, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, ...run]));
  expect(events.message).toHaveBeenCalledWith('/chicane/run', expect.objectContaining({ track: 'lakeside' }));
});

it('connects again, ever more slowly, and quickly again after a success', () => {
  const { sockets, events, last } = start();
  last().close();
  expect(events.lost).toHaveBeenLastCalledWith(1, 250);
  vi.advanceTimersByTime(249);
  expect(sockets).toHaveLength(1);
  vi.advanceTimersByTime(1);
  expect(sockets).toHaveLength(2);
  last().close();
  expect(events.lost).toHaveBeenLastCalledWith(2, 500);
  vi.advanceTimersByTime(500);
  last().introduce();
  last().close();
  expect(events.lost).toHaveBeenLastCalledWith(1, 250);
  expect([1, 2, 3, 4, 5, 50].map(retryDelay)).toEqual([250, 500, 1000, 2000, 2000, 2000]);
});

it('does not connect again once closed', () => {
  const { sockets, connection } = start();
  connection.close();
  vi.advanceTimersByTime(60_000);
  expect(sockets).toHaveLength(1);
});

it('calls services and tells how they ended', async () => {
  const { connection, last } = start();
  expect(await connection.call('/reset')).toMatch(/not offered/);
  last().introduce();
  const done = connection.call('/pause', true);
  const bytes = last().sent.at(-1) as Uint8Array;
  expect([...bytes]).toEqual([2, 0, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0, 99, 100, 114, 0, 1, 0, 0, 1]);
  last().sayBytes(
    new Uint8Array([3, 0, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0, 99, 100, 114, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0]),
  );
  expect(await done).toBeNull();
  const refused = connection.call('/step');
  last().say({ op: 'serviceCallFailure', serviceId: 1, callId: 2, message: 'the run is over' });
  expect(await refused).toBe('the run is over');
  const unreadable = connection.call('/step');
  const cut = [3, 1, 0, 0, 0, 3, 0, 0, 0, 3, 0, 0, 0, 99, 100, 114, 0, 1, 0, 0, 1];
  last().sayBytes(new Uint8Array(cut.slice(0, 9))); // no head: nothing
  last().sayBytes(new Uint8Array([...cut.slice(0, 9), 255, 255, 255, 255])); // an encoding beyond the end: nothing
  last().sayBytes(new Uint8Array(cut));
  expect(await unreadable).toMatch(/^the answer of \/step cannot be read: .* got 5 bytes, expected at least 12$/);
  const pending = connection.call('/step');
  last().close();
  expect(await pending).toBe('the connection was lost');
});

const saidAs = (socket: FakeSocket, op: string) =>
  socket.sent
    .filter((each) => typeof each === 'string')
    .map((each) => JSON.parse(each as string) as { op: string; id?: string })
    .filter((each) => each.op === op);

it('asks for all parameters and their changes, where there are any', () => {
  const { events, connection, last } = start([]);
  expect(saidAs(last(), 'getParameters')).toEqual([]);
  last().close();
  vi.advanceTimersByTime(250);
  last().introduce(['parameters', 'parametersSubscribe']);
  expect(saidAs(last(), 'getParameters')).toEqual([{ op: 'getParameters', parameterNames: [], id: 'all' }]);
  expect(saidAs(last(), 'subscribeParameterUpdates')).toHaveLength(1);
  const parameters = [{ name: 'a', value: 1 }, { name: 'b', value: 'x' }, { name: 'c' }];
  last().say({ op: 'parameterValues', id: 'all', parameters });
  expect(events.settings).toHaveBeenLastCalledWith(new Map(Object.entries({ a: 1, b: 'x' })), true);
  last().say({ op: 'parameterValues', parameters: [{ name: 'a', value: 2 }] });
  expect(events.settings).toHaveBeenLastCalledWith(new Map([['a', 2]]), false);
  connection.refresh();
  expect(saidAs(last(), 'getParameters')).toHaveLength(2);
});

it('sets a parameter and tells the value in force, with the sentence of a refusal', async () => {
  const { events, connection, last } = start();
  expect((await connection.set('a', 1)).sentence).toMatch(/cannot be changed/);
  last().introduce(['parameters']);
  const granted = connection.set('latency_ms', 90);
  const refused = connection.set('latency_ms', 900);
  const [first, second] = saidAs(last(), 'setParameters');
  expect(first).toMatchObject({ parameters: [{ name: 'latency_ms', value: 90, type: 'float64' }] });
  last().say({ op: 'parameterValues', id: first?.id, parameters: [{ name: 'latency_ms', value: 90 }] });
  last().say({ op: 'status', level: 2, message: 'latency_ms: got 900, expected a number in [0, 500] ms' });
  last().say({ op: 'parameterValues', id: second?.id, parameters: [{ name: 'latency_ms', value: 90 }] });
  expect(await granted).toEqual({ value: 90, sentence: null });
  expect(await refused).toEqual({ value: 90, sentence: 'latency_ms: got 900, expected a number in [0, 500] ms' });
  expect(events.notice).not.toHaveBeenCalled();
  last().say({ op: 'status', level: 2, message: 'subscribe: there is no channel 99' });
  expect(events.notice).toHaveBeenCalledOnce();
});

it('sends what was not answered once more when it is soon back, and says so when it is not', async () => {
  const { connection, last } = start(['parameters']);
  const pending = connection.set('latency_ms', 80);
  const wheel = connection.set('manual.steer', 0.5);
  last().close();
  vi.advanceTimersByTime(250);
  last().introduce(['parameters']);
  expect((await wheel).sentence).toBe('the connection was lost');
  const again = saidAs(last(), 'setParameters');
  expect(again).toMatchObject([{ parameters: [{ name: 'latency_ms', value: 80, type: 'float64' }] }]);
  last().say({ op: 'parameterValues', id: again[0]?.id, parameters: [{ name: 'latency_ms', value: 80 }] });
  expect(await pending).toEqual({ value: 80, sentence: null });
  const late = connection.set('latency_ms', 70);
  last().close();
  for (let seconds = 0; seconds < 14; seconds += 2) {
    vi.advanceTimersByTime(2000);
    last().close();
  }
  expect(await late).toEqual({ value: null, sentence: 'the connection was lost' });
});

it('sends another program nothing that was meant for the one before', async () => {
  const { connection, last } = start(['parameters']);
  const pending = connection.set('latency_ms', 80);
  last().close();
  vi.advanceTimersByTime(250);
  last().say({ op: 'serverInfo', name: 'chicane', sessionId: 'b2', capabilities: ['parameters'] });
  expect((await pending).sentence).toBe('the connection was lost');
  expect(saidAs(last(), 'setParameters')).toEqual([]);
});
