// The part of the Foxglove WebSocket protocol that this page speaks.

/** A method's parameters may be wider: that lets a WebSocket be one. */
type Handler<E> = { handle(event: E): void }['handle'] | null;

/** A WebSocket as far as this page uses it. */
export interface Socket {
  binaryType: string;
  onmessage: Handler<{ readonly data: unknown }>;
  onclose: Handler<object>;
  send(data: string | Uint8Array<ArrayBuffer>): void;
  close(): void;
}

/** A topic that a server advertises. */
export interface Channel {
  readonly id: number;
  readonly topic: string;
  readonly encoding: string;
  readonly schema: string;
}

/** A service that a server advertises. */
export interface Service {
  readonly id: number;
  readonly name: string;
  readonly response?: { readonly schema: string };
  readonly responseSchema?: string; // of older servers
}

/** A parameter with its value. */
export interface Parameter {
  readonly name: string;
  readonly value?: unknown;
  readonly type?: string;
}

/** Messages of a server as text, as far as this page reads them. */
export type FromServer =
  | { readonly op: 'serverInfo'; readonly capabilities: readonly string[]; readonly sessionId?: string }
  | { readonly op: 'advertise'; readonly channels: readonly Channel[] }
  | { readonly op: 'advertiseServices'; readonly services: readonly Service[] }
  | { readonly op: 'parameterValues'; readonly parameters: readonly Parameter[]; readonly id?: string }
  | { readonly op: 'serviceCallFailure'; readonly callId: number; readonly message: string }
  | { readonly op: 'status'; readonly message: string };

/** Messages of a server as bytes: of a subscription, or the answer to a call. */
export type BytesFromServer =
  | { readonly op: 'data'; readonly subscription: number; readonly bytes: DataView }
  | { readonly op: 'answer'; readonly callId: number; readonly bytes: DataView };

const HEAD_BYTES = 13; // of all binary messages

/** Reads a binary message; null where it is of another kind, or too short. */
export function readBytes(data: ArrayBuffer): BytesFromServer | null {
  if (data.byteLength < HEAD_BYTES) return null;
  const view = new DataView(data);
  const kind = view.getUint8(0);
  // The time of the message, 8 bytes, follows the subscription.
  if (kind === 1) return { op: 'data', subscription: view.getUint32(1, true), bytes: new DataView(data, HEAD_BYTES) };
  // Service, call, and the name of the encoding with its length.
  const begin = HEAD_BYTES + view.getUint32(9, true);
  if (kind !== 3 || begin > data.byteLength) return null;
  return { op: 'answer', callId: view.getUint32(5, true), bytes: new DataView(data, begin) };
}

/** A call of a service, with a request in CDR. */
export function serviceCall(service: number, call: number, request: Uint8Array): Uint8Array<ArrayBuffer> {
  const encoding = new TextEncoder().encode('cdr');
  const bytes = new Uint8Array(HEAD_BYTES + encoding.length + request.length);
  const view = new DataView(bytes.buffer);
  bytes[0] = 2;
  [service, call, encoding.length].forEach((value, i) => view.setUint32(1 + 4 * i, value, true));
  bytes.set(encoding, HEAD_BYTES);
  bytes.set(request, HEAD_BYTES + encoding.length);
  return bytes;
}
