import { readFileSync } from 'node:fs';
import { parse } from '@foxglove/rosmsg';
import { MessageReader } from '@foxglove/rosmsg2-serialization';
import { describe, expect, it } from 'vitest';
import { decoder } from './decoder';
import { TOPIC_NAMES } from './topics';

// Written by tests/protocol/ros_messages_test.cpp, which compares them byte for byte.
const folder = new URL('../../../tests/protocol/fixtures/ros/', import.meta.url);
const topics = JSON.parse(readFileSync(new URL('topics.json', folder), 'utf8')) as {
  topic: string;
  type: string;
  file: string;
  schema: string;
}[];

describe('messages of the C++ side', () => {
  it('include every topic this page subscribes to', () => {
    // The past has the type of a frame, and a channel of viewers alone (wire/viewer.hpp).
    const sent = TOPIC_NAMES.filter((name) => name !== '/chicane/past');
    for (const name of sent) expect(topics.map((each) => each.topic)).toContain(name);
  });

  it.each(topics)('$topic is read as the reference implementation reads it', ({ schema, file }) => {
    const bytes = readFileSync(new URL(file, folder));
    const reference = new MessageReader(parse(schema, { ros2: true }));
    expect(decoder(schema)(bytes)).toEqual(reference.readMessage(bytes));
  });
});
