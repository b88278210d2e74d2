import { parse } from '@foxglove/rosmsg';
import { MessageReader } from '@foxglove/rosmsg2-serialization';
import { expect, it } from 'vitest';
import { decoder } from './decoder';
import { bytesOf, FOLDER, topics } from './test_fixtures';
import { TOPIC_NAMES } from './topics';

/** As JSON with a field a line: numbers beyond it as texts, lists of numbers as one text. */
function readable(message: unknown): string {
  const plain = (_: string, value: unknown): unknown => {
    if (ArrayBuffer.isView(value)) return [...(value as Float64Array)].join(' ');
    return typeof value === 'bigint' || Number.isNaN(value) ? String(value) : value;
  };
  return `${JSON.stringify(message, plain, 1)}\n`;
}

it('include every topic this page subscribes to', () => {
  // The past has the type of a frame, and a channel of viewers alone (wire/viewer.hpp).
  const sent = TOPIC_NAMES.filter((name) => name !== '/chicane/past');
  for (const name of sent) expect(topics.map((each) => each.topic)).toContain(name);
});

it.each(topics)('$topic is read as the reference implementation reads it', ({ schema, file }) => {
  const bytes = bytesOf(file);
  const reference = new MessageReader(parse(schema, { ros2: true }));
  expect(decoder(schema)(bytes)).toEqual(reference.readMessage(bytes));
});

// Beside the bytes, for people and for other decoders; renewed with them, and to be read before it is kept.
it.each(topics)('$topic carries the values that stand beside its bytes', async ({ schema, file }) => {
  const message = decoder(schema)(bytesOf(file));
  await expect(readable(message)).toMatchFileSnapshot(new URL(file.replace(/bin$/, 'json'), FOLDER).pathname);
});
