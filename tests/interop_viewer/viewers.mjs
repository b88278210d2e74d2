// SPDX-License-Identifier: MIT
// What many viewers cost the car: the control step of a run in real time, with and without them. Half of them never
// read.
//   CHICANE=/path/to/chicane node viewers.mjs [viewers, 200] [seconds, 20] [times, 3]
import { once } from 'node:events';
import { readFileSync } from 'node:fs';
import { setPriority } from 'node:os';
import { argv, exit } from 'node:process';
import { setTimeout as sleep } from 'node:timers/promises';
import WebSocket from 'ws';
import { startDrive } from './chicane_drive.mjs';

const VIEWERS = Number(argv[2] ?? 200);
const SECONDS = Number(argv[3] ?? 20);
const TIMES = Number(argv[4] ?? 3);
/** What a dashboard subscribes to. */
const TOPICS = ['/chicane/frame', '/chicane/plan', '/chicane/run', '/chicane/lap', '/chicane/change', '/reference'];
const PAGE = 4096; // [bytes]

setPriority(19); // the clients' work is not what is measured

/** Resident memory [MB]. */
const memoryOf = (pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, 'utf8'))[1]) / 1e3;

/** A viewer that subscribes as a dashboard does, and reads, or stops reading for ever. */
async function view(port, reads) {
  const socket = new WebSocket(`ws://127.0.0.1:${port}`, ['foxglove.sdk.v1']);
  const viewer = { frames: 0, longest: 0, isDropped: false, close: () => socket.terminate() };
  let [frame, last] = [-1, NaN];
  socket.on('close', () => (viewer.isDropped = true));
  socket.on('error', () => undefined);
  socket.on('message', (data, isBinary) => {
    if (isBinary) {
      if (data.readUInt8(0) !== 1 || data.readUInt32LE(1) !== frame) return;
      const now = performance.now();
      if (now - last > viewer.longest) viewer.longest = now - last;
      last = now;
      ++viewer.frames;
      return;
    }
    const { op, channels } = JSON.parse(data);
    if (op !== 'advertise') return;
    const wanted = channels.filter(({ topic }) => TOPICS.includes(topic));
    frame = wanted.findIndex(({ topic }) => topic === '/chicane/frame');
    socket.send(
      JSON.stringify({ op: 'subscribe', subscriptions: wanted.map(({ id }, i) => ({ id: i, channelId: id })) }),
      () => {
        if (!reads) socket.pause();
      },
    );
  });
  await once(socket, 'open');
  return viewer;
}

/** TCP buffers of the whole machine [MB]. */
const kernelMemory = () =>
  (Number(/^TCP:.* mem (\d+)/m.exec(readFileSync('/proc/net/sockstat', 'utf8'))[1]) * PAGE) / 1e6;

async function measure(count) {
  const before = kernelMemory();
  const drive = await startDrive(['--json']);
  const viewers = [];
  for (let i = 0; i < count; ++i) viewers.push(await view(drive.port, i % 2 === 0));
  let kernel = 0;
  for (let i = 0; i < SECONDS; ++i) {
    await sleep(1000);
    kernel = Math.max(kernel, kernelMemory() - before);
  }
  const memory = memoryOf(drive.pid);
  const readers = viewers.filter((_, i) => i % 2 === 0);
  const dropped = readers.filter(({ isDropped }) => isDropped).length;
  const { step_time_us: step, deadline_misses: misses } = await drive.result();
  for (const { close } of viewers) close();
  const [fewest, gap] = [Math.min(...readers.map(({ frames }) => frames)), Math.max(...readers.map((r) => r.longest))];
  const told = readers.length === 0 ? ['', ''] : [(fewest / SECONDS).toFixed(0), gap.toFixed(0)];
  console.log(
    `| ${count} | ${[step.p50, step.p99, step.p999, step.max].map((each) => each.toFixed(0)).join(' | ')} ` +
      `| ${misses} | ${told.join(' | ')} | ${memory.toFixed(0)} | ${kernel.toFixed(0)} | ${dropped} |`,
  );
  return { isSteady: dropped === 0 };
}

console.log(
  '| viewers | step p50 [µs] | p99 | p99.9 | max | late | fewest frames a second | longest gap [ms] | memory [MB] ' +
    '| sockets [MB] | readers dropped |\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|',
);
let isSteady = true;
for (let i = 0; i < TIMES; ++i)
  for (const count of [0, VIEWERS]) isSteady = (await measure(count)).isSteady && isSteady;
exit(isSteady ? 0 : 1);
