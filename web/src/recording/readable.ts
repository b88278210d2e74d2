// Bytes of a recording by ranges, from memory or from a server.
import type { McapTypes } from '@mcap/core';

type IReadable = McapTypes.IReadable;

/** A recording in memory: dropped on the page. */
export class BytesReadable implements IReadable {
  readonly #bytes: Uint8Array;

  constructor(bytes: Uint8Array) {
    this.#bytes = bytes;
  }

  size(): Promise<bigint> {
    return Promise.resolve(BigInt(this.#bytes.byteLength));
  }

  read(offset: bigint, size: bigint): Promise<Uint8Array> {
    const [from, to] = [Number(offset), Number(offset + size)];
    if (to > this.#bytes.byteLength) return Promise.reject(new RangeError('the recording ends too early'));
    return Promise.resolve(this.#bytes.subarray(from, to));
  }
}

const BLOCK = 1 << 20; // fetched at once [byte]; chosen
const KEPT = 48; // blocks in memory; chosen

/** A recording on a server with range requests, read in blocks; the last ones are cached. */
export class HttpReadable implements IReadable {
  readonly #url: string;
  readonly #fetch: typeof fetch;
  readonly #blocks = new Map<number, Promise<Uint8Array>>(); // least recently used first
  #size: Promise<bigint> | undefined;

  constructor(url: string, get: typeof fetch = (input, init) => fetch(input, init)) {
    this.#url = url;
    this.#fetch = get;
  }

  size(): Promise<bigint> {
    this.#size ??= this.#askSize();
    return this.#size;
  }

  async read(offset: bigint, size: bigint): Promise<Uint8Array> {
    const [from, to] = [Number(offset), Number(offset + size)];
    if (to > Number(await this.size())) throw new RangeError('the recording ends too early');
    const result = new Uint8Array(to - from);
    const numbers: number[] = [];
    for (let block = Math.floor(from / BLOCK); block * BLOCK < to; ++block) numbers.push(block);
    await Promise.all(
      numbers.map(async (number) => {
        const start = number * BLOCK;
        const bytes = await this.#block(number);
        const part = bytes.subarray(Math.max(0, from - start), to - start);
        result.set(part, Math.max(0, start - from));
      }),
    );
    return result;
  }

  async #askSize(): Promise<bigint> {
    const answer = await this.#fetch(this.#url, { headers: { range: 'bytes=0-0' } });
    const total = /\/(\d+)$/.exec(answer.headers.get('content-range') ?? '')?.[1];
    if (answer.status !== 206 || total === undefined)
      throw new Error(`${this.#url}: got HTTP ${answer.status} without a range, expected 206`);
    return BigInt(total);
  }

  #block(number: number): Promise<Uint8Array> {
    const known = this.#blocks.get(number);
    const block = known ?? this.#get(number);
    this.#blocks.delete(number);
    this.#blocks.set(number, block);
    const [oldest] = this.#blocks.keys();
    if (this.#blocks.size > KEPT && oldest !== undefined) this.#blocks.delete(oldest);
    return block;
  }

  async #get(number: number): Promise<Uint8Array> {
    const first = number * BLOCK;
    const last = Math.min(first + BLOCK, Number(await this.size())) - 1;
    try {
      const answer = await this.#fetch(this.#url, { headers: { range: `bytes=${first}-${last}` } });
      if (answer.status !== 206) throw new Error(`${this.#url}: got HTTP ${answer.status}, expected 206`);
      return new Uint8Array(await answer.arrayBuffer());
    } catch (error) {
      this.#blocks.delete(number); // the next read tries again
      throw error;
    }
  }
}
