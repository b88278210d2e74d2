// Messages of the C++ side, for tests: written by tests/protocol/ros_messages_test.cpp, with the numbers of
// tests/protocol/viewer_samples.hpp.
import { readFileSync } from 'node:fs';

/** Folder of the messages. */
export const FOLDER = new URL('../../../tests/protocol/fixtures/ros/', import.meta.url);

/** Bytes of a message. */
export const bytesOf = (file: string): Uint8Array => readFileSync(new URL(file, FOLDER));

/** All topics of the server, with the definition of their type and the file of a message. */
export const topics = JSON.parse(new TextDecoder().decode(bytesOf('topics.json'))) as readonly {
  readonly topic: string;
  readonly type: string;
  readonly schema: string;
  readonly file: string;
}[];
