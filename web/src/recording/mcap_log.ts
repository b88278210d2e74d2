// Reader of MCAP recordings: decoded messages of the topics that this page knows.
import { McapIndexedReader, type McapTypes } from '@mcap/core';
import { decompress } from 'fzstd';
import { reasonOf } from '../lib/words';
import { decoder } from '../protocol/decoder';
import { TOPIC_NAMES, type TopicName, type Topics } from '../protocol/topics';

/** One message of a recording. */
export interface LoggedMessage<T extends TopicName = TopicName> {
  readonly topic: T;
  /** Time since the recording's first message [s]. */
  readonly time: number;
  readonly message: Topics[T];
}

const NANOSECONDS = 1e9;

/** An indexed recording: the messages that this page draws, in the order of time. */
export class McapLog {
  readonly name: string;
  /** From the first message to the last [s]. */
  readonly duration: number;
  readonly #reader: McapIndexedReader;
  readonly #start: bigint;
  readonly #decoders = new Map<number, { topic: TopicName; decode: (bytes: ArrayBufferView) => unknown }>();

  private constructor(name: string, reader: McapIndexedReader) {
    const statistics = reader.statistics;
    this.name = name;
    this.#reader = reader;
    this.#start = statistics?.messageStartTime ?? 0n;
    this.duration = Number((statistics?.messageEndTime ?? 0n) - this.#start) / NANOSECONDS;
    for (const channel of reader.channelsById.values()) {
      const topic = TOPIC_NAMES.find((each) => each === channel.topic);
      const schema = reader.schemasById.get(channel.schemaId);
      if (!topic || !schema || channel.messageEncoding !== 'cdr') continue;
      this.#decoders.set(channel.id, { topic, decode: decoder(new TextDecoder().decode(schema.data)) });
    }
  }

  /** Rejects with a reason if the file is no chicane recording or was never closed. */
  static async open(name: string, readable: McapTypes.IReadable): Promise<McapLog> {
    let reader: McapIndexedReader;
    try {
      reader = await McapIndexedReader.Initialize({
        readable,
        messageIndexCacheSizeBytes: 16 << 20,
        decompressHandlers: { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) },
      });
    } catch (error) {
      const why = reasonOf(error);
      throw new Error(
        `${name} cannot be read as a closed MCAP file (${why}); ` +
          `\`chicane replay ${name}\` also opens one that was cut short`,
      );
    }
    const log = new McapLog(name, reader);
    if (log.#decoders.size === 0) throw new Error(`${name} has none of the topics that chicane records`);
    return log;
  }

  /** Messages with from <= time <= to [s]. */
  async *messages(topics: readonly TopicName[], from: number, to: number): AsyncGenerator<LoggedMessage> {
    const nanoseconds = (seconds: number): bigint =>
      this.#start + BigInt(Math.round(Math.max(0, seconds) * NANOSECONDS));
    const range = { topics, startTime: nanoseconds(from), endTime: nanoseconds(Math.min(to, this.duration)) };
    for await (const { channelId, logTime, data } of this.#reader.readMessages(range)) {
      const known = this.#decoders.get(channelId);
      if (!known) continue;
      yield {
        topic: known.topic,
        time: Number(logTime - this.#start) / NANOSECONDS,
        message: known.decode(data) as Topics[TopicName],
      };
    }
  }

  /** The same messages as a list. */
  async read(topics: readonly TopicName[], from: number, to: number): Promise<LoggedMessage[]> {
    const all: LoggedMessage[] = [];
    for await (const message of this.messages(topics, from, to)) all.push(message);
    return all;
  }
}
