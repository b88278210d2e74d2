// SPDX-License-Identifier: MIT
// The whole program is killed (SIGKILL) at random moments while it records in real time: each recording must open
// without a repair step, with our reader and with @mcap/core, and must hold all but the last 100 ms of what viewers had
// been told.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, it } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { promisify } from 'node:util';
import { McapStreamReader } from '@mcap/core';
import { startDrive, watch } from './chicane_drive.mjs';

const KILLS = process.env.CHICANE_SLOW_TESTS ? 50 : 6;
const AT_ONCE = 3;
const MOST_LOST_S = 0.1;

let folder;
before(() => {
  folder = mkdtempSync(join(tmpdir(), 'chicane-kill-'));
});
after(() => rmSync(folder, { recursive: true }));

/** The last second that viewers were told of, and the file. */
async function recordUntilKilled(number, seconds) {
  const file = join(folder, `${number}.mcap`);
  const drive = await startDrive(['--record', file]);
  const viewer = await watch(drive.url);
  while (!viewer.newest) await sleep(5);
  await sleep(1000 * seconds);
  const exit = drive.stop('SIGKILL');
  const told = viewer.newest.time_s;
  await exit;
  viewer.close();
  return { file, told };
}

/** Step messages by the reference reader, from front to back, as it reads a file that has no end. */
function readByReference(file) {
  const reader = new McapStreamReader({ validateCrcs: true });
  reader.append(readFileSync(file));
  const topics = new Map();
  const seen = { steps: 0, last: 0, hasEnd: false };
  for (let record = reader.nextRecord(); record; record = reader.nextRecord()) {
    if (record.type === 'Channel') topics.set(record.id, record.topic);
    if (record.type === 'Footer') seen.hasEnd = true;
    if (record.type !== 'Message' || topics.get(record.channelId) !== '/chicane/step') continue;
    seen.steps += 1;
    seen.last = Number(record.logTime) / 1e9;
  }
  return seen;
}

async function readByUs(file) {
  const { stdout } = await promisify(execFile)(process.env.CHICANE, ['replay', file, '--verify', '--json']);
  return JSON.parse(stdout);
}

it(`${KILLS} recordings of killed programs open as they are and lack at most ${1000 * MOST_LOST_S} ms`, async () => {
  const lost = [];
  let next = 0;
  const worker = async () => {
    while (next < KILLS) {
      const number = next++;
      const seconds = 0.2 + 2.5 * Math.random();
      const { file, told } = await recordUntilKilled(number, seconds);
      const seen = readByReference(file);
      const report = await readByUs(file);
      const about = `kill ${number}, ${seconds.toFixed(3)} s after the first frame: ${JSON.stringify(report)}`;
      assert.equal(seen.hasEnd, false, about);
      assert.equal(report.closed, false, about);
      assert.equal(report.damaged, 0, about);
      assert.equal(report.steps, seen.steps, about);
      assert.equal(report.identical, seen.steps, about);
      assert.ok(seen.steps > 0, about);
      lost.push(told - seen.last);
      assert.ok(told - seen.last <= MOST_LOST_S + 1e-9, `${about}: told ${told} s, recorded ${seen.last} s`);
    }
  };
  await Promise.all(Array.from({ length: AT_ONCE }, worker));
  lost.sort((a, b) => a - b);
  const at = (share) => (1000 * Math.max(0, lost[Math.floor(share * (lost.length - 1))])).toFixed(0);
  console.log(`lost of what was told: median ${at(0.5)} ms, at most ${at(1)} ms, in ${lost.length} kills`);
});
