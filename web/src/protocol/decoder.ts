// Messages in CDR, by the ROS 2 definition of their type: its fields, then each type that it uses under "MSG: name".

/** Read position in a message. Numbers are aligned to their own size, counted from the end of the 4-byte header. */
class Cursor {
  readonly view: DataView;
  readonly isLittle: boolean;
  #at = 4;

  constructor(bytes: ArrayBufferView) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.#need(4);
    const representation = this.view.getUint16(0);
    if (representation > 1) throw new Error(`CDR: got representation ${representation}, expected 0 or 1`);
    this.isLittle = representation === 1;
  }

  /** Moves past the next value, of `size` bytes; returns where it begins. */
  take(size: number, alignment = 1): number {
    const begin = 4 + Math.ceil((this.#at - 4) / alignment) * alignment;
    this.#need(begin + size);
    this.#at = begin + size;
    return begin;
  }

  /** Reads the length of a list or a string. */
  count(): number {
    return this.view.getUint32(this.take(4, 4), this.isLittle);
  }

  /** Throws unless `count` elements of at least `size` bytes can follow; asked before a list is allocated. */
  need(count: number, size: number): void {
    this.#need(this.#at + count * size);
  }

  #need(end: number): void {
    const { byteLength } = this.view;
    if (end > byteLength) throw new Error(`CDR: got ${byteLength} bytes, expected at least ${end}`);
  }
}

/** Reads one value at the position, and moves past it. */
type Read = (from: Cursor) => unknown;

/** Types of numbers: size, reader of DataView, and list. */
const NUMBERS = {
  int8: { size: 1, get: 'getInt8', list: Int8Array },
  uint8: { size: 1, get: 'getUint8', list: Uint8Array },
  int16: { size: 2, get: 'getInt16', list: Int16Array },
  uint16: { size: 2, get: 'getUint16', list: Uint16Array },
  int32: { size: 4, get: 'getInt32', list: Int32Array },
  uint32: { size: 4, get: 'getUint32', list: Uint32Array },
  int64: { size: 8, get: 'getBigInt64', list: BigInt64Array },
  uint64: { size: 8, get: 'getBigUint64', list: BigUint64Array },
  float32: { size: 4, get: 'getFloat32', list: Float32Array },
  float64: { size: 8, get: 'getFloat64', list: Float64Array },
} as const;

const isNumber = (type: string): type is keyof typeof NUMBERS => type in NUMBERS;
const text = new TextDecoder();

function readString(from: Cursor): string {
  const length = from.count();
  const { buffer, byteOffset } = from.view;
  return text.decode(new Uint8Array(buffer, byteOffset + from.take(length), Math.max(0, length - 1)));
}

/** Reader of a type by its name; without a package, of the package `own` or the only type of that name. */
function find(type: string, own: string, types: ReadonlyMap<string, Read>): Read {
  const names = [...types.keys()].filter((name) => name === type || name.endsWith(`/${type}`));
  const exact = [type, `${own}/${type}`].find((name) => types.has(name));
  const read = types.get(exact ?? (names.length === 1 ? (names[0] ?? '') : ''));
  if (read) return read;
  const known = names.length > 1 ? `ambiguous type ${type}: ${names.join(', ')}` : `unknown type ${type}`;
  throw new Error(`message definition: got the ${known}`);
}

/** Reader of one value of a type; `own` is the package of the message that has the field. */
function readerOf(type: string, own: string, types: ReadonlyMap<string, Read>): Read {
  if (isNumber(type)) {
    const { size, get } = NUMBERS[type];
    return (from) => from.view[get](from.take(size, size), from.isLittle);
  }
  if (type === 'bool') return (from) => from.view.getUint8(from.take(1)) !== 0;
  if (type === 'string') return readString;
  if (/^builtin_interfaces\/(Time|Duration)$/.test(type)) {
    const [sec, nsec] = [readerOf('int32', own, types), readerOf('uint32', own, types)];
    return (from) => ({ sec: sec(from), nsec: nsec(from) });
  }
  let known: Read | undefined; // found at the first message: types are defined after those that use them
  return (from) => {
    known ??= find(type, own, types);
    return known(from);
  };
}

/** Reader of a list of `count` values; not-a-number: the message says how many follow. */
function listReader(type: string, count: number, one: Read): Read {
  const size = isNumber(type) ? NUMBERS[type].size : 1;
  const lengthOf = (from: Cursor): number => {
    const length = Number.isNaN(count) ? from.count() : count;
    from.need(length, size);
    return length;
  };
  if (!isNumber(type)) return (from) => Array.from({ length: lengthOf(from) }, () => one(from));
  const { list: List } = NUMBERS[type];
  return (from) => {
    const all = new List(lengthOf(from));
    for (let i = 0; i < all.length; ++i) all[i] = one(from) as never;
    return all;
  };
}

/** "float64[3] name": a type, perhaps bounded or a list, and a name; what follows is a default value. */
const FIELD = /^([\w/]+)(?:<=\d+)?(?:\[(<=)?(\d*)\])?\s+(\w+)(?!\s*=)\b/;

/** Reader of a message by the lines of its definition. */
function structReader(lines: readonly string[], own: string, types: ReadonlyMap<string, Read>): Read {
  const fields = lines.flatMap((line): [string, Read][] => {
    const [all, named = '', bound, length, name = ''] = FIELD.exec(line.replace(/#.*/, '').trim()) ?? [];
    if (all === undefined) return []; // a constant, a comment
    const type = named.replace('/msg/', '/').replace(/^(byte|char)$/, 'uint8');
    const one = readerOf(type, own, types);
    if (length === undefined) return [[name, one]];
    return [[name, listReader(type, bound || length === '' ? NaN : Number(length), one)]];
  });
  return (from) => {
    if (fields.length === 0) from.take(1); // an empty message is one byte
    const message: Record<string, unknown> = {};
    for (const [name, read] of fields) message[name] = read(from);
    return message;
  };
}

/** Reads messages of the type that a ROS 2 definition describes. */
export function decoder(schema: string): (bytes: ArrayBufferView) => unknown {
  const types = new Map<string, Read>();
  const [root = '', ...others] = schema.split(/^=+$/m);
  for (const each of others) {
    const [, name = '', rest = ''] = /^\s*MSG:\s*(\S+)([\s\S]*)$/.exec(each) ?? [];
    const [own = ''] = name.split('/');
    types.set(name.replace('/msg/', '/'), structReader(rest.split('\n'), own, types));
  }
  const read = structReader(root.split('\n'), '', types);
  return (bytes) => read(new Cursor(bytes));
}

/** The request of std_srvs/srv/SetBool: XCDR1 header, little endian, and one byte. */
export const encodeBool = (value: boolean): Uint8Array => new Uint8Array([0, 1, 0, 0, value ? 1 : 0]);

/** The request of std_srvs/srv/Trigger, which is empty. */
export const encodeNothing = (): Uint8Array => new Uint8Array([0, 1, 0, 0]);

/** The request of chicane_msgs/srv/Ask, one text: its length with a final zero, and the bytes. */
export function encodeText(text: string): Uint8Array {
  const bytes = new TextEncoder().encode(text);
  const request = new Uint8Array(8 + bytes.length + 1);
  request.set([0, 1, 0, 0]);
  new DataView(request.buffer).setUint32(4, bytes.length + 1, true);
  request.set(bytes, 8);
  return request;
}
