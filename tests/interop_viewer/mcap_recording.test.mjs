// SPDX-License-Identifier: MIT
// The reference reader of MCAP files, @mcap/core, on a recorded run: opened by its index, every CRC checked, and
// messages decoded by the schemas in the file. mcap_replay.test.mjs seeks in one.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, it } from 'node:test';
import { McapIndexedReader, McapStreamReader } from '@mcap/core';
import { reader as readerOf } from './chicane_drive.mjs';

const STEPS = 250; // 10 s of 40 ms each
const MESSAGES = STEPS * 11 + 7; // and once: the run, three lines of the road, the limit, its line and the scene

let folder;
let bytes;
before(() => {
  folder = mkdtempSync(join(tmpdir(), 'chicane-mcap-'));
  const file = join(folder, 'run.mcap');
  try {
    execFileSync(process.env.CHICANE, ['drive', '--fast', '--set', 'time_limit_s=10', '--record', file], {
      stdio: 'ignore',
    });
  } catch (error) {
    assert.equal(error.status, 1); // the laps were not driven: that is what the time limit is for
  }
  bytes = readFileSync(file);
});
after(() => rmSync(folder, { recursive: true }));

const open = () =>
  McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(bytes.length),
      read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
    },
  });

async function collect(messages) {
  const all = [];
  for await (const message of messages) all.push(message);
  return all;
}

it('is opened by its index and says what it holds', async () => {
  const reader = await open();
  assert.equal(reader.header.profile, 'ros2');
  const { library } = reader.header;
  assert.match(library, /^chicane \d/);
  assert.equal(reader.channelsById.size, 20);
  assert.equal(reader.statistics.channelCount, 20);
  assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
  assert.equal(reader.statistics.messageCount, BigInt(MESSAGES));
  assert.equal((await collect(reader.readMessages())).length, MESSAGES);
});

it('passes every CRC, from the first byte to the last', () => {
  const reader = new McapStreamReader({ validateCrcs: true });
  reader.append(bytes);
  const counts = {};
  for (let record = reader.nextRecord(); record; record = reader.nextRecord())
    counts[record.type] = (counts[record.type] ?? 0) + 1;
  assert.ok(reader.done());
  assert.equal(counts.Message, MESSAGES);
  assert.equal(counts.Footer, 1);
});

it('decodes by the schemas in the file, on every channel', async () => {
  const reader = await open();
  const readers = new Map();
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    assert.equal(schema.encoding, 'ros2msg');
    assert.equal(channel.messageEncoding, 'cdr');
    const text = new TextDecoder().decode(schema.data);
    readers.set(channel.id, readerOf(text));
  }
  const seen = new Map();
  for (const message of await collect(reader.readMessages())) {
    const topic = reader.channelsById.get(message.channelId).topic;
    seen.set(topic, readers.get(message.channelId).readMessage(message.data));
  }
  const step = seen.get('/chicane/step');
  assert.equal(step.cycle, BigInt(STEPS - 1));
  assert.ok(Math.abs(step.time - 9.96) < 1e-9);
  assert.equal(step.waypoints.length, 12);
  assert.ok(step.speed > 5);
  assert.equal(seen.get('/drive').drive.steering_angle, Math.fround(step.command_steer));
  assert.equal(seen.get('/chicane/limit').is_known, false);
  assert.equal(seen.get('/chicane/limit').why_not, 'this run was driven without looking for it');
  assert.equal(seen.size, 18);
});

it('holds the scenario and how it was built', async () => {
  const reader = await open();
  const attachments = await collect(reader.readAttachments({ name: 'scenario.yaml' }));
  assert.match(new TextDecoder().decode(attachments[0].data), /^time_limit_s: 10$/m);
  const metadata = await collect(reader.readMetadata({ name: 'run' }));
  assert.equal(metadata[0].metadata.get('track'), 'lakeside');
  assert.match(metadata[0].metadata.get('compiler'), /^(gcc|clang) /);
});
