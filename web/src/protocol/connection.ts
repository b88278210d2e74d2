import { FoxgloveClient, type Channel, type IWebSocket, type Service } from '@foxglove/ws-protocol';
import { decoder, encodeBool, encodeNothing } from './decoder';
import { TOPIC_NAMES, type TopicName, type Topics } from './topics';

/** Both names mean the same bytes; servers pick one. */
export const SUBPROTOCOLS = ['foxglove.sdk.v1', 'foxglove.websocket.v1'];

export type ServiceName = '/pause' | '/step' | '/reset';

export interface ConnectionEvents {
  /** The socket is open and the server has introduced itself. */
  open(): void;
  /** It has ended; the next attempt, the `attempt`-th in a row, begins in `delay` milliseconds. */
  lost(attempt: number, delay: number): void;
  message<T extends TopicName>(topic: T, message: Topics[T]): void;
  services(names: ReadonlySet<string>): void;
  /** A sentence for the operator. */
  notice(sentence: string): void;
}

/** How long to wait before the attempt number n = 1, 2, … [ms]: quick at first, never longer than two seconds. */
export const retryDelay = (attempt: number): number => Math.min(2000, 250 * 2 ** (attempt - 1));

/**
 * One lasting connection to a server of the Foxglove WebSocket protocol: subscribes to the topics this page draws, and
 * connects again, for ever, whenever it is lost.
 */
export class Connection {
  readonly #open: () => IWebSocket;
  readonly #events: ConnectionEvents;
  #client: FoxgloveClient | undefined;
  #attempt = 0;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #services = new Map<string, Service>();
  #calls = new Map<number, { service: Service; resolve: (sentence: string | null) => void }>();
  #nextCall = 1;

  constructor(open: () => IWebSocket, events: ConnectionEvents) {
    this.#open = open;
    this.#events = events;
    this.#connect();
  }

  close(): void {
    clearTimeout(this.#timer);
    const client = this.#client;
    this.#client = undefined;
    client?.close();
  }

  /** Tries at once instead of waiting for the next attempt. */
  retryNow(): void {
    if (this.#client) return;
    clearTimeout(this.#timer);
    this.#connect();
  }

  /** Resolves to null when done, to a sentence when not. */
  call(name: ServiceName, data?: boolean): Promise<string | null> {
    const service = this.#services.get(name);
    if (!service || !this.#client) return Promise.resolve(`${name} is not offered by this run`);
    const callId = this.#nextCall++;
    const request = data === undefined ? encodeNothing() : encodeBool(data);
    this.#client.sendServiceCallRequest({ serviceId: service.id, callId, encoding: 'cdr', data: request });
    return new Promise((resolve) => this.#calls.set(callId, { service, resolve }));
  }

  #connect(): void {
    const client = new FoxgloveClient({ ws: this.#open() });
    const readers = new Map<number, (bytes: ArrayBufferView) => void>();
    const mine = () => this.#client === client;
    this.#client = client;

    client.on('serverInfo', () => {
      if (!mine()) return;
      this.#attempt = 0;
      this.#events.open();
    });
    client.on('advertise', (channels) => {
      for (const channel of mine() ? channels : []) this.#subscribe(client, channel, readers);
    });
    client.on('message', ({ subscriptionId, data }) => {
      if (mine()) readers.get(subscriptionId)?.(data);
    });
    client.on('advertiseServices', (services) => {
      for (const service of services) this.#services.set(service.name, service);
      this.#events.services(new Set(this.#services.keys()));
    });
    client.on('serviceCallResponse', ({ callId, data }) => this.#answer(callId, data));
    client.on('serviceCallFailure', ({ callId, message }) => this.#finish(callId, message));
    client.on('status', ({ message }) => this.#events.notice(message));
    client.on('error', () => undefined); // a close event follows
    client.on('close', () => {
      if (mine()) this.#lost();
    });
  }

  #subscribe(client: FoxgloveClient, channel: Channel, readers: Map<number, (bytes: ArrayBufferView) => void>): void {
    const topic = TOPIC_NAMES.find((name) => name === channel.topic);
    if (!topic || channel.encoding !== 'cdr') return;
    const decode = decoder(channel.schema);
    readers.set(client.subscribe(channel.id), (bytes) => {
      this.#events.message(topic, decode(bytes) as Topics[typeof topic]);
    });
  }

  #answer(callId: number, data: ArrayBufferView): void {
    const service = this.#calls.get(callId)?.service;
    if (!service) return;
    const schema = service.response?.schema ?? service.responseSchema ?? '';
    const answer = decoder(schema)(data) as { success: boolean; message: string };
    this.#finish(callId, answer.success ? null : answer.message);
  }

  #finish(callId: number, sentence: string | null): void {
    this.#calls.get(callId)?.resolve(sentence);
    this.#calls.delete(callId);
  }

  #lost(): void {
    this.#client = undefined;
    this.#services.clear();
    this.#events.services(new Set());
    for (const callId of [...this.#calls.keys()]) this.#finish(callId, 'the connection was lost');
    const delay = retryDelay(++this.#attempt);
    this.#events.lost(this.#attempt, delay);
    this.#timer = setTimeout(() => this.#connect(), delay);
  }
}
