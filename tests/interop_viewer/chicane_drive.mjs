// SPDX-License-Identifier: MIT
// Starts `chicane` (its path in CHICANE) with a page, and listens to it by the reference client of the protocol.
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
      if (child.exitCode !== null || child.signalCode !== null) return child.exitCode;
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

/** A client with the origin of the program's own page: without one a viewer only watches. */
export function clientOf(url, subprotocol = 'foxglove.sdk.v1') {
  const socket = new WebSocket(url.replace('http', 'ws'), [subprotocol], { origin: new URL(url).origin });
  return { socket, client: new foxglove.FoxgloveClient({ ws: socket }) };
}

export const reader = (schema) => new cdr.MessageReader(rosmsg.parse(schema, { ros2: true }));

/** A client, once it is connected, that hears each message of the topics that `wants` takes. */
export async function subscribe(url, wants, onMessage) {
  const { socket, client } = clientOf(url);
  const readers = new Map();
  client.on('advertise', (channels) => {
    for (const { id, topic, schema } of channels.filter((channel) => wants(channel.topic)))
      readers.set(client.subscribe(id), { topic, of: reader(schema) });
  });
  client.on('message', ({ subscriptionId, data }) => {
    const { topic, of } = readers.get(subscriptionId);
    onMessage(topic, of.readMessage(data));
  });
  await once(socket, 'open');
  return { socket, client };
}

/** Changes a setting of the run. */
export async function change(url, name, value) {
  const { socket, client } = clientOf(url);
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
  const seen = { frames: new Map(), changes: [], newest: null };
  const wants = (topic) => ['/chicane/frame', '/chicane/change'].includes(topic);
  const { socket } = await subscribe(url, wants, (topic, message) => {
    if (topic === '/chicane/change') return seen.changes.push(message);
    seen.newest = message;
    seen.frames.set(message.cycle, message);
    if (seen.frames.size > 2000) seen.frames.delete(seen.frames.keys().next().value);
  });
  return {
    ...seen,
    get newest() {
      return seen.newest;
    },
    close: () => socket.terminate(),
  };
}
