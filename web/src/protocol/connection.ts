// Client of the Foxglove WebSocket protocol: subscriptions, services, parameters, and reconnection.
import { decoder, encodeBool, encodeNothing, encodeText } from './decoder';
import {
  type Channel,
  type FromServer,
  type Parameter,
  readBytes,
  type Service,
  type Socket,
  serviceCall,
} from './foxglove';
import {
  type AskAnswer,
  isSetting,
  type ServiceName,
  type SetAnswer,
  type Setting,
  type Source,
  type SourceEvents,
} from './source';
import { TOPIC_NAMES, type Topics } from './topics';

/** Names of the protocol, new and old, of which the server picks one. */
export const SUBPROTOCOLS = ['foxglove.sdk.v1', 'foxglove.websocket.v1'];

/** Address at which the program that serves this page answers viewers, with options after '?'. */
export function viewerUrl(options = ''): URL {
  const url = new URL('viewer', location.href);
  url.search = options;
  url.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
  return url;
}

/** Delay before reconnection attempt 1, 2, … [ms]: 250 ms at first, at most two seconds. */
export const retryDelay = (attempt: number): number => Math.min(2000, 250 * 2 ** (attempt - 1));

const ALL = 'all'; // id of requests for all parameters
const LOST = 'the connection was lost';
/** Time after a lost connection within which requests without an answer are sent again [ms]; chosen. */
const RESEND_WITHIN_MS = 10_000;

/** A request to change a setting that is not answered yet. */
interface PendingSet {
  readonly name: string;
  readonly value: Setting;
  sentence: string | null; // of the refusal, which precedes the answer
  resolve(answer: SetAnswer): void;
}

/**
 * A connection to a server of the Foxglove WebSocket protocol: subscribes to the topics of this page and to all
 * parameters, and reconnects whenever it is lost.
 */
export class Connection implements Source {
  readonly #open: () => Socket;
  readonly #events: SourceEvents;
  #socket: Socket | undefined;
  #readers = new Map<number, (bytes: DataView) => void>(); // by subscription
  #attempt = 0; // to reconnect, since the last success
  #timer: ReturnType<typeof setTimeout> | undefined;
  #services = new Map<string, Service>(); // by name
  #calls = new Map<number, { service: Service; resolve: (answer: AskAnswer) => void }>(); // by call id
  #sets = new Map<string, PendingSet>(); // by request id, in the order sent
  #unanswered: readonly PendingSet[] = []; // when the connection was lost
  #lostAt = 0; // performance.now() [ms]
  #session = ''; // of the server that answered last
  #nextCall = 1; // id of the next request
  #hasParameters = false;

  constructor(open: () => Socket, events: SourceEvents) {
    this.#open = open;
    this.#events = events;
    this.#connect();
  }

  close(): void {
    clearTimeout(this.#timer);
    const socket = this.#socket;
    this.#socket = undefined;
    socket?.close();
  }

  retryNow(): void {
    if (this.#socket) return;
    clearTimeout(this.#timer);
    this.#connect();
  }

  async call(name: ServiceName, data?: boolean): Promise<string | null> {
    const { isTaken, message } = await this.#request(name, data === undefined ? encodeNothing() : encodeBool(data));
    return isTaken ? null : message;
  }

  ask(name: ServiceName, question: string): Promise<AskAnswer> {
    return this.#request(name, encodeText(question));
  }

  #request(name: ServiceName, data: Uint8Array): Promise<AskAnswer> {
    const service = this.#services.get(name);
    if (!service || !this.#socket)
      return Promise.resolve({ isTaken: false, message: `${name} is not offered by this run` });
    const callId = this.#nextCall++;
    this.#socket.send(serviceCall(service.id, callId, data));
    return new Promise((resolve) => this.#calls.set(callId, { service, resolve }));
  }

  set(name: string, value: Setting): Promise<SetAnswer> {
    if (!this.#socket || !this.#hasParameters)
      return Promise.resolve({ value: null, sentence: `${name} cannot be changed in this run` });
    return new Promise((resolve) => this.#sendSet({ name, value, sentence: null, resolve }));
  }

  #sendSet(request: PendingSet): void {
    const { name, value } = request;
    const id = `set ${this.#nextCall++}`;
    // JSON does not distinguish 3 from 3.0: the type does.
    const parameter: Parameter = typeof value === 'number' ? { name, value, type: 'float64' } : { name, value };
    this.#sets.set(id, request);
    this.#say({ op: 'setParameters', parameters: [parameter], id });
  }

  /** Sends unanswered requests again where the same program is back in time; not those of driving by hand. */
  #sendAgain(session: string): void {
    const isSame =
      session === this.#session && performance.now() - this.#lostAt <= RESEND_WITHIN_MS && this.#hasParameters;
    this.#session = session;
    for (const request of this.#unanswered) {
      if (isSame && !request.name.startsWith('manual.')) this.#sendSet(request);
      else request.resolve({ value: null, sentence: LOST });
    }
    this.#unanswered = [];
  }

  refresh(): void {
    if (this.#hasParameters) this.#say({ op: 'getParameters', parameterNames: [], id: ALL });
  }

  #say(message: object): void {
    this.#socket?.send(JSON.stringify(message));
  }

  /** Opens a socket and listens to it. */
  #connect(): void {
    const socket = this.#open();
    this.#socket = socket;
    this.#readers.clear();
    socket.binaryType = 'arraybuffer';
    socket.onmessage = ({ data }) => {
      if (this.#socket !== socket) return;
      if (data instanceof ArrayBuffer) this.#takeBytes(data);
      else this.#take(JSON.parse(String(data)) as FromServer);
    };
    socket.onclose = () => {
      if (this.#socket === socket) this.#lost();
    };
  }

  /** Handles a message of the server as text. */
  #take(message: FromServer): void {
    switch (message.op) {
      case 'serverInfo':
        this.#introduced(message.capabilities, message.sessionId ?? '');
        break;
      case 'advertise':
        for (const channel of message.channels) this.#subscribe(channel);
        break;
      case 'advertiseServices':
        for (const service of message.services) this.#services.set(service.name, service);
        this.#events.services(new Set(this.#services.keys()));
        break;
      case 'parameterValues':
        this.#parameterValues(message.parameters, message.id);
        break;
      case 'serviceCallFailure':
        this.#finish(message.callId, { isTaken: false, message: message.message });
        break;
      case 'status':
        this.#status(message.message);
    }
  }

  #takeBytes(data: ArrayBuffer): void {
    const message = readBytes(data);
    if (message?.op === 'data') this.#readers.get(message.subscription)?.(message.bytes);
    if (message?.op === 'answer') this.#answer(message.callId, message.bytes);
  }

  #introduced(capabilities: readonly string[], session: string): void {
    this.#attempt = 0;
    this.#hasParameters = capabilities.includes('parameters');
    this.#events.open(session);
    this.refresh();
    if (this.#hasParameters) this.#say({ op: 'subscribeParameterUpdates', parameterNames: [] });
    this.#sendAgain(this.#hasParameters ? session : '');
  }

  #subscribe({ id, topic: name, encoding, schema }: Channel): void {
    const topic = TOPIC_NAMES.find((each) => each === name);
    if (!topic || encoding !== 'cdr') return;
    const decode = decoder(schema);
    const subscription = this.#readers.size;
    this.#readers.set(subscription, (bytes) => {
      this.#events.message(topic, decode(bytes) as Topics[typeof topic]);
    });
    this.#say({ op: 'subscribe', subscriptions: [{ id: subscription, channelId: id }] });
  }

  #parameterValues(parameters: readonly Parameter[], id: string | undefined): void {
    const values = new Map<string, Setting>();
    for (const { name, value } of parameters) if (isSetting(value)) values.set(name, value);
    const pending = id === undefined ? undefined : this.#sets.get(id);
    if (id !== undefined && pending) {
      this.#sets.delete(id);
      pending.resolve({ value: values.get(pending.name) ?? null, sentence: pending.sentence });
      values.delete(pending.name);
    }
    if (values.size > 0) this.#events.settings(values, id === ALL);
  }

  /** A refusal names its parameter and precedes the answer; it belongs to the oldest open request of that name. */
  #status(sentence: string): void {
    for (const pending of this.#sets.values()) {
      if (pending.sentence !== null || !sentence.startsWith(pending.name)) continue;
      pending.sentence = sentence;
      return;
    }
    this.#events.notice(sentence);
  }

  #answer(callId: number, data: DataView): void {
    const service = this.#calls.get(callId)?.service;
    if (!service) return;
    try {
      const schema = service.response?.schema ?? service.responseSchema ?? '';
      const answer = decoder(schema)(data) as { success: boolean; message: string };
      this.#finish(callId, { isTaken: answer.success, message: answer.message });
    } catch (error) {
      this.#finish(callId, { isTaken: false, message: `the answer of ${service.name} cannot be read: ${error}` });
    }
  }

  #finish(callId: number, answer: AskAnswer): void {
    this.#calls.get(callId)?.resolve(answer);
    this.#calls.delete(callId);
  }

  /** Ends open requests, keeps those to change settings, and plans the next attempt. */
  #lost(): void {
    this.#socket = undefined;
    this.#hasParameters = false;
    this.#services.clear();
    this.#events.services(new Set());
    for (const callId of [...this.#calls.keys()]) this.#finish(callId, { isTaken: false, message: LOST });
    if (this.#sets.size > 0) this.#lostAt = performance.now();
    this.#unanswered = [...this.#unanswered, ...this.#sets.values()];
    this.#sets.clear();
    if (performance.now() - this.#lostAt > RESEND_WITHIN_MS) this.#sendAgain('');
    const delay = retryDelay(++this.#attempt);
    this.#events.lost(this.#attempt, delay);
    this.#timer = setTimeout(() => this.#connect(), delay);
  }
}
