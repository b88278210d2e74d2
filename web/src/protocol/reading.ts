import type { Socket } from './foxglove';

// What this page adds to the protocol: it acknowledges what it has read, so that the program sends no more than
// arrives in time, and measures how old the newest frame is when it arrives (docs/viewer.md).

/** Messages of the program beyond the protocol. */
type Notice =
  | { readonly op: 'heard'; readonly at: number; readonly held: number }
  | { readonly op: 'pastLeft'; readonly messages: number };

/** What the program reports about the connection. */
export interface ReadingEvents {
  /** The next frame was sent at most `seconds` ago. */
  age(seconds: number): void;
  /** Number of frames from before the page was opened that are still to come. */
  pastLeft(messages: number): void;
}

/** Whether to acknowledge, and by which clock; a transport such as a worker's port acknowledges by itself. */
export interface Acknowledging {
  readonly acknowledges?: boolean;
  readonly now?: () => number; // [ms]
}

/** Bytes, or time since the last one, after which the next acknowledgement is due; chosen. */
const EVERY_BYTES = 4096;
const EVERY_MS = 40;

/** Reads a message beyond the protocol; null for messages of the protocol. */
function noticeIn(text: string): Notice | null {
  if (!/^\{[^{}]*"op":"(heard|pastLeft)"[^{}]*\}$/.test(text)) return null;
  return JSON.parse(text) as Notice;
}

/**
 * A socket that acknowledges the bytes of binary messages: of every few thousand, and of every message that comes some
 * time after the last. Without timers: browsers let those of hidden pages rest.
 */
export class ReadingSocket implements Socket {
  readonly #socket: Socket;
  readonly #now: () => number; // [ms]
  #read = 0; // [byte]
  #acknowledged = 0; // of them
  #acknowledgedAt = Number.NEGATIVE_INFINITY;
  onclose: Socket['onclose'] = null;
  onmessage: Socket['onmessage'] = null;

  constructor(
    socket: Socket,
    events: ReadingEvents,
    { acknowledges = true, now = () => performance.now() }: Acknowledging = {},
  ) {
    this.#socket = socket;
    this.#now = now;
    socket.onclose = (event) => this.onclose?.(event);
    socket.onmessage = (event) => {
      const { data } = event;
      // Counted before it is read: the program would wait for ever if a message cannot be read.
      if (acknowledges && data instanceof ArrayBuffer) this.#count(data.byteLength);
      const said = typeof data === 'string' ? noticeIn(data) : null;
      if (said?.op === 'heard') events.age(Math.max(0, (now() - said.at) / 1000 - said.held));
      else if (said) events.pastLeft(said.messages);
      else this.onmessage?.(event);
    };
  }

  get binaryType(): string {
    return this.#socket.binaryType;
  }
  set binaryType(type: string) {
    this.#socket.binaryType = type;
  }

  send(data: string | Uint8Array<ArrayBuffer>): void {
    this.#socket.send(data);
  }

  close(): void {
    this.#socket.close();
  }

  #count(bytes: number): void {
    this.#read += bytes;
    const now = this.#now();
    if (this.#read - this.#acknowledged < EVERY_BYTES && now - this.#acknowledgedAt < EVERY_MS) return;
    this.#acknowledged = this.#read;
    this.#acknowledgedAt = now;
    this.#socket.send(JSON.stringify({ op: 'received', bytes: this.#read, at: now }));
  }
}
