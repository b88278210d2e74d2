// SPDX-License-Identifier: MIT
// Starts `chicane` (its path in CHICANE) with a page, and listens to it as a second viewer, by the protocol's
// reference client.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import rosmsg from '@foxglove/rosmsg';
import cdr from '@foxglove/rosmsg2-serialization';
import foxglove from '@foxglove/ws-protocol';
import WebSocket from 'ws';

/** A run with our simulator. */
export function startDrive(args = [], port = 0) {
  const laps = args.includes('--laps') ? [] : ['--laps', '10000'];
  return startProgram('drive', [...laps, ...args], port);
}

/** Any command that has a page. */
export async function startProgram(command, args, port = 0) {
  const child = spawn(process.env.CHICANE ?? 'chicane', [command, '--port', String(port), ...args], {
    stdio: ['ignore', args.includes('--json') ? 'pipe' : 'ignore', 'pipe'],
  });
  let [said, out] = ['', ''];
  child.stdout?.on('data', (data) => (out += data));
  const address = new Promise((resolve, reject) => {
    child.stderr.on('data', (data) => {
      said = (said + data).slice(-4000);
      const found = /http:\/\/localhost:(\d+)\//.exec(said);
      if (found) resolve(Number(found[1]));
    });
    child.on('error', reject);
    child.on('exit', (code) => reject(new Error(`chicane ${command} ended with ${code}: ${said}`)));
  });
  const listening = await address;
  const program = {
    pid: child.pid,
    port: listening,
    url: `http://127.0.0.1:${listening}/`,
    async stop(signal = 'SIGTERM') {
      if (child.exitCode !== null || child.signalCode !== null) return;
      child.kill(signal);
      await once(child, 'exit');
      return child.exitCode;
    },
    /** Ends it, and gives what it printed for `--json`. */
    async result() {
      await program.stop('SIGINT');
      return JSON.parse(out);
    },
  };
  return program;
}

/** Changes a setting of the run, as the program's own page may: without an origin a viewer only watches. */
export async function change(url, name, value) {
  const socket = new WebSocket(url.replace('http', 'ws'), ['foxglove.sdk.v1'], { origin: new URL(url).origin });
  const client = new foxglove.FoxgloveClient({ ws: socket });
  await once(socket, 'open');
  const answer = new Promise((resolve) => client.on('parameterValues', resolve));
  client.setParameters([{ name, value }], 'change');
  const { parameters } = await answer;
  client.close();
  assert.deepEqual(
    parameters.map((each) => [each.name, each.value]),
    [[name, value]],
  );
}

/** Frames by cycle, the newest 2000 of them, and all changes. */
export async function watch(url) {
  const socket = new WebSocket(url.replace('http', 'ws'), ['foxglove.sdk.v1']);
  const client = new foxglove.FoxgloveClient({ ws: socket });
  const readers = new Map();
  const seen = { frames: new Map(), changes: [], newest: null };
  client.on('advertise', (channels) => {
    for (const { id, topic, schema } of channels) {
      if (!['/chicane/frame', '/chicane/change'].includes(topic)) continue;
      readers.set(client.subscribe(id), { topic, reader: new cdr.MessageReader(rosmsg.parse(schema, { ros2: true })) });
    }
  });
  client.on('message', ({ subscriptionId, data }) => {
    const { topic, reader } = readers.get(subscriptionId);
    const message = reader.readMessage(data);
    if (topic === '/chicane/change') return seen.changes.push(message);
    seen.newest = message;
    seen.frames.set(message.cycle, message);
    if (seen.frames.size > 2000) seen.frames.delete(seen.frames.keys().next().value);
  });
  await once(socket, 'open');
  return {
    ...seen,
    get newest() {
      return seen.newest;
    },
    close: () => socket.terminate(),
  };
}
