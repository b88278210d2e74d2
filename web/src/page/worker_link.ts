import type { Socket } from '../protocol/foxglove';

// A page that needs no program: simulator and controller run in a worker of the page, whose script lies in it
// (apps/page), and speak the protocol that a program speaks over a WebSocket.

/** What apps/page/worker.js sends. */
type FromWorker =
  | { readonly kind: 'message'; readonly data: string | ArrayBuffer }
  | { readonly kind: 'content'; readonly id: number; readonly text: string | null }
  | { readonly kind: 'problem'; readonly text: string };

/** The part of a worker that this file uses. */
export interface Port {
  onmessage: ((event: { data: FromWorker }) => void) | null;
  postMessage(message: unknown): void;
}

/** Starts the worker; its script lies compressed in the page itself. */
async function startWorker(): Promise<Port> {
  const held = document.getElementById('chicane-worker')?.textContent ?? '';
  const bytes = Uint8Array.from(atob(held.trim()), (letter) => letter.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  const script = new Blob([await new Response(plain).blob()], { type: 'text/javascript' });
  return new Worker(URL.createObjectURL(script)) as unknown as Port;
}

/** A socket whose messages go through the worker's port. */
class WorkerSocket implements Socket {
  binaryType = 'arraybuffer';
  onclose: Socket['onclose'] = null;
  onmessage: Socket['onmessage'] = null;
  readonly #send: (message: unknown) => void;

  constructor(send: (message: unknown) => void) {
    this.#send = send;
  }

  send(data: string | Uint8Array<ArrayBuffer>): void {
    // Bytes may be a part of a larger buffer.
    this.#send({ kind: 'message', data: typeof data === 'string' ? data : data.slice().buffer });
  }

  close(): void {
    this.onclose?.({});
  }
}

/** The run in the page's worker: opened like a WebSocket, asked for what a program answers to GET. */
export class WorkerLink {
  readonly #port: Promise<Port>;
  readonly #answers = new Map<number, (text: string | null) => void>();
  readonly #fail: (sentence: string) => void;
  #socket: WorkerSocket | undefined;
  #next = 1;

  /** `fail` is called with the reason when the run cannot begin. */
  constructor(fail: (sentence: string) => void, start: () => Promise<Port> = startWorker) {
    this.#fail = fail;
    this.#port = start();
    this.#port.then(
      (port) => {
        port.onmessage = ({ data }) => this.#take(port, data);
      },
      (error: unknown) => fail(String(error)),
    );
  }

  open(): Socket {
    const socket = new WorkerSocket((message) => void this.#post(message));
    this.#socket = socket;
    void this.#port.then((port) => {
      if (this.#socket !== socket) return;
      port.postMessage({ kind: 'connect' });
    });
    return socket;
  }

  /** The content of "/schema.json" and the like; null when there is none. */
  get(path: string): Promise<string | null> {
    const id = this.#next++;
    void this.#post({ kind: 'get', id, path });
    return new Promise((resolve) => this.#answers.set(id, resolve));
  }

  async #post(message: unknown): Promise<void> {
    (await this.#port).postMessage(message);
  }

  #take(port: Port, message: FromWorker): void {
    if (message.kind === 'problem') {
      this.#fail(message.text);
    } else if (message.kind === 'content') {
      this.#answers.get(message.id)?.(message.text);
      this.#answers.delete(message.id);
    } else {
      this.#socket?.onmessage?.({ data: message.data });
      port.postMessage({ kind: 'taken', count: 1 });
    }
  }
}
