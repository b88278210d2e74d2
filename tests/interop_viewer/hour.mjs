// SPDX-License-Identifier: MIT
// One hour of a run at 60 frames a second, sent to a dashboard as fast as it takes it: does what the page keeps stop
// growing?
//   CHICANE=/path/to/chicane node hour.mjs [minutes, 60] [2d or 3d]
// The program drives the hour in virtual time and records it; the recording is sent over a socket as the program would
// send it live. Every ten minutes of the run, after a forced collection, memory and nodes of the page are counted.
import { execFileSync } from 'node:child_process';
import { closeSync, fstatSync, mkdtempSync, openSync, readSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { argv, exit } from 'node:process';
import { McapIndexedReader } from '@mcap/core';
import { WebSocketServer } from 'ws';
import { launch } from './browser.mjs';
import { startDrive } from './chicane_drive.mjs';
import { MODES } from './dashboard_page.mjs';

const MINUTES = Number(argv[2] ?? 60);
const DIMENSION = argv[3] ?? '2d';
const SAMPLES = 6;
const IN_FLIGHT = 600; // messages sent and not yet taken
const MOST_GROWTH_MB = 1; // from the first sample to the last

const folder = mkdtempSync(join(tmpdir(), 'chicane-hour-'));
const log = join(folder, 'hour.mcap');
console.error(`driving ${MINUTES} minutes …`);
const settings = [
  'car=road-car',
  `time_limit_s=${60 * MINUTES}`,
  'control_period_ms=16',
  'tracking_mpc.horizon_steps=20',
];
try {
  execFileSync(
    process.env.CHICANE ?? 'chicane',
    ['drive', '--fast', '--laps', '10000', '--record', log, ...settings.flatMap((each) => ['--set', each])],
    { stdio: 'ignore' },
  );
} catch {
  // Not all of ten thousand laps: it says so by its exit code.
}

const file = openSync(log);
const reader = await McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt(fstatSync(file).size),
    read(offset, size) {
      const bytes = new Uint8Array(Number(size));
      readSync(file, bytes, 0, bytes.length, offset);
      return Promise.resolve(bytes);
    },
  },
});
const isShown = ({ topic, messageEncoding }) =>
  messageEncoding === 'cdr' && (topic.startsWith('/chicane/') || topic.startsWith('/track/') || topic === '/reference');
const channels = [...reader.channelsById.values()].filter(isShown);

/** Speaks as much of the protocol as a viewer needs. */
const server = new WebSocketServer({ port: 0, host: '127.0.0.1', handleProtocols: () => 'foxglove.sdk.v1' });
const subscribed = new Map(); // subscription by channel
const viewer = new Promise((resolve) => {
  server.on('connection', (socket) => {
    socket.send(JSON.stringify({ op: 'serverInfo', capabilities: [], sessionId: 'hour' }));
    const advertised = channels.map(({ id, topic, schemaId }) => {
      const schema = new TextDecoder().decode(reader.schemasById.get(schemaId).data);
      return { id, topic, encoding: 'cdr', schema };
    });
    socket.send(JSON.stringify({ op: 'advertise', channels: advertised }));
    socket.on('message', (text) => {
      const { op, subscriptions } = JSON.parse(text);
      if (op !== 'subscribe') return;
      for (const { id, channelId } of subscriptions) subscribed.set(channelId, id);
      resolve(socket);
    });
  });
});

function messageData(subscription, time, data) {
  const message = Buffer.allocUnsafe(13 + data.length);
  message.writeUInt8(1, 0);
  message.writeUInt32LE(subscription, 1);
  message.writeBigUInt64LE(time, 5);
  message.set(data, 13);
  return message;
}

const drive = await startDrive(['--pace', '0.05']); // for its page; the data is ours
const browser = await launch();
const context = await browser.newContext({
  viewport: { width: 1366, height: 768 },
  bypassCSP: true, // the page's own policy allows its own server only
});
const page = await context.newPage();
const complaints = [];
page.on('pageerror', (error) => complaints.push(String(error)));
await page.addInitScript(
  ({ port, dimension }) => {
    localStorage.setItem('chicane.camera', JSON.stringify(dimension === '3d' ? 'chase' : 'track'));
    globalThis.taken = 0;
    globalThis.WebSocket = class extends WebSocket {
      constructor(_url, protocols) {
        super(`ws://127.0.0.1:${port}`, protocols);
        this.addEventListener('message', ({ data }) => (globalThis.taken += data instanceof ArrayBuffer ? 1 : 0));
      }
    };
  },
  { port: server.address().port, dimension: DIMENSION },
);
await page.goto(`${drive.url}#watch`);
const socket = await viewer;
await page.waitForTimeout(500);
const session = await context.newCDPSession(page);

async function sample(minute, frames, wall) {
  await page.locator('#mode-watch').click();
  await page.waitForTimeout(500);
  for (let i = 0; i < 3; ++i) await session.send('HeapProfiler.collectGarbage');
  const heap = await session.send('Runtime.getHeapUsage');
  const { nodes, jsEventListeners } = await session.send('Memory.getDOMCounters');
  return {
    minute,
    frames,
    heap: heap.usedSize / 1e6,
    buffers: (heap.backingStorageSize ?? NaN) / 1e6,
    nodes,
    listeners: jsEventListeners,
    wall,
  };
}

const row = ({ minute, frames, heap, buffers, nodes, listeners, wall }) =>
  `| ${Number(minute.toFixed(1))} | ${frames} | ${heap.toFixed(2)} | ${buffers.toFixed(2)} | ${nodes} ` +
  `| ${listeners} | ${wall.toFixed(0)} |`;
console.log(
  '| minutes | frames | heap [MB] | arrays [MB] | nodes | listeners | after [s] |\n|--:|--:|--:|--:|--:|--:|--:|',
);

const begin = performance.now();
const samples = [];
let [sent, frames, mode] = [0, 0, 0];
const start = reader.statistics.messageStartTime;
const frameChannel = channels.find(({ topic }) => topic === '/chicane/frame').id;
for await (const { channelId, logTime, data } of reader.readMessages({ topics: channels.map(({ topic }) => topic) })) {
  const minute = Number(logTime - start) / 60e9;
  const subscription = subscribed.get(channelId);
  if (subscription === undefined) continue;
  if (channelId === frameChannel) ++frames;
  socket.send(messageData(subscription, logTime, data));
  if (++sent % 100 === 0) {
    while ((await page.evaluate(() => globalThis.taken)) < sent - IN_FLIGHT) await page.waitForTimeout(2);
  }
  if (minute >= ((samples.length + 1) * MINUTES) / SAMPLES - 1e-3) {
    while ((await page.evaluate(() => globalThis.taken)) < sent) await page.waitForTimeout(2);
    samples.push(await sample(minute, frames, (performance.now() - begin) / 1000));
    console.log(row(samples.at(-1)));
    if (samples.length === SAMPLES) break;
  } else if (minute > (mode + 1) * (MINUTES / 60)) {
    await page.locator(`#mode-${MODES[++mode % MODES.length]}`).click();
  }
}
await browser.close();
await drive.stop();
socket.terminate();
server.close();
closeSync(file);
rmSync(folder, { recursive: true });

const growth = samples.at(-1).heap + samples.at(-1).buffers - samples[0].heap - samples[0].buffers;
console.log(`\n${growth.toFixed(2)} MB more at the end than after the first sixth; ${complaints.length} complaints`);
for (const each of complaints) console.log(each);
exit(samples.length === SAMPLES && growth < MOST_GROWTH_MB && complaints.length === 0 ? 0 : 1);
