// SPDX-License-Identifier: MIT
// The reference client of the Foxglove WebSocket protocol against our server: what Foxglove and Lichtblick do.
import assert from 'node:assert/strict';
import { after, before, describe, it } from 'node:test';
import { clientOf, reader, startDrive } from './chicane_drive.mjs';
import { PATIENCE } from './patience.mjs';

let drive;
before(async () => {
  drive = await startDrive(['--laps', '0']);
});
after(async () => {
  assert.equal(await drive.stop(), 0);
});

/** A connected client that remembers what it was told. */
async function connect(subprotocol) {
  const { socket, client } = clientOf(drive.url, subprotocol);
  const seen = { info: null, channels: new Map(), services: new Map(), problems: [] };
  const next = (event, accept = () => true) =>
    new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`no ${event} within ${PATIENCE} ms`)), PATIENCE);
      const listener = (message) => {
        if (!accept(message)) return;
        clearTimeout(timer);
        client.off(event, listener);
        resolve(message);
      };
      client.on(event, listener);
    });
  client.on('serverInfo', (info) => (seen.info = info));
  client.on('advertise', (channels) => channels.forEach((channel) => seen.channels.set(channel.topic, channel)));
  client.on('advertiseServices', (services) => services.forEach((service) => seen.services.set(service.name, service)));
  client.on('status', (status) => seen.problems.push(status.message));
  client.on('error', (error) => seen.problems.push(String(error)));
  await next('advertiseServices');
  return { client, socket, seen, next };
}

const decode = (schema, bytes) => reader(schema).readMessage(bytes);

for (const subprotocol of ['foxglove.websocket.v1', 'foxglove.sdk.v1']) {
  describe(subprotocol, () => {
    let connection;
    before(async () => {
      connection = await connect(subprotocol);
    });
    after(() => connection.client.close());

    it('is accepted, and the server introduces itself', () => {
      const { socket, seen } = connection;
      assert.equal(socket.protocol, subprotocol);
      assert.equal(seen.info.name, 'chicane');
      assert.deepEqual(seen.info.capabilities, ['time', 'parameters', 'parametersSubscribe', 'services']);
    });

    it('sends every advertised topic, each decodable by its own schema', async () => {
      const { client, seen, next } = connection;
      assert.equal(seen.channels.size, 19);
      // a lap completed, a setting changed, the limit found: not in this short run
      const onOccasion = ['/chicane/lap', '/chicane/change', '/chicane/limit', '/track/racing_line'];
      for (const channel of seen.channels.values()) {
        assert.equal(channel.encoding, 'cdr');
        assert.equal(channel.schemaEncoding, 'ros2msg');
        if (onOccasion.includes(channel.topic)) continue;
        const id = client.subscribe(channel.id);
        const { data } = await next('message', ({ subscriptionId }) => subscriptionId === id);
        const message = decode(channel.schema, data);
        assert.ok(Object.keys(message).length > 0, channel.topic);
        if (channel.topic === '/track/left') assert.ok(message.poses.length > 300);
        if (channel.topic === '/odom')
          assert.deepEqual([message.header.frame_id, message.child_frame_id], ['odom', 'base_link']);
        if (channel.topic === '/scene')
          assert.deepEqual(
            message.entities.map(({ id, frame_id: frame }) => `${id} in ${frame}`),
            ['road in map', 'car in base_link'],
          );
        client.unsubscribe(id);
      }
      assert.deepEqual(seen.problems, []);
    });

    it('sends frames that move on, with the time of the run', async () => {
      const { client, seen, next } = connection;
      const channel = seen.channels.get('/chicane/frame');
      const id = client.subscribe(channel.id);
      const times = [];
      await next('message', ({ subscriptionId, timestamp, data }) => {
        if (subscriptionId !== id) return false;
        const frame = decode(channel.schema, data);
        assert.equal(timestamp, BigInt(frame.stamp.sec) * 1_000_000_000n + BigInt(frame.stamp.nsec));
        times.push(frame.time_s);
        return times.length === 21;
      });
      times.shift(); // the frame before a reset may still be the newest
      for (let i = 1; i < times.length; ++i) assert.ok(times[i] > times[i - 1], `${times}`);
      const { timestamp } = await next('time');
      assert.ok(timestamp > 0n);
      client.unsubscribe(id);
    });

    it('calls services, and tells all viewers of a pause', async () => {
      const { client, seen, next } = connection;
      const call = async (name, data) => {
        const service = seen.services.get(name);
        const request = new Uint8Array([0, 1, 0, 0, ...data]);
        client.sendServiceCallRequest({ serviceId: service.id, callId: 77, encoding: 'cdr', data: request });
        const response = await next('serviceCallResponse', ({ callId }) => callId === 77);
        return decode(service.response.schema, response.data);
      };
      const runChannel = seen.channels.get('/chicane/run');
      const id = client.subscribe(runChannel.id);
      const paused = next(
        'message',
        ({ subscriptionId, data }) => subscriptionId === id && decode(runChannel.schema, data).is_paused,
      );
      assert.deepEqual(await call('/step', []), { success: false, message: 'the run is not paused' });
      assert.deepEqual(await call('/pause', [1]), { success: true, message: 'paused' });
      await paused;
      assert.deepEqual(await call('/step', []), { success: true, message: 'one step' });
      assert.deepEqual(await call('/reset', []), { success: true, message: 'reset' });
      assert.deepEqual(await call('/pause', [0]), { success: true, message: 'running' });
      client.sendServiceCallRequest({ serviceId: 0, callId: 78, encoding: 'json', data: new Uint8Array() });
      const failure = await next('serviceCallFailure', ({ callId }) => callId === 78);
      assert.match(failure.message, /cdr/);
      client.unsubscribe(id);
    });
  });
}

it('a viewer that never reads does not stop the others', async () => {
  const lazy = await connect('foxglove.sdk.v1');
  for (const channel of lazy.seen.channels.values()) lazy.client.subscribe(channel.id);
  lazy.socket.pause();
  const eager = await connect('foxglove.sdk.v1');
  const id = eager.client.subscribe(eager.seen.channels.get('/chicane/frame').id);
  let count = 0;
  await eager.next('message', ({ subscriptionId }) => subscriptionId === id && ++count === 30);
  lazy.socket.terminate();
  eager.client.close();
});
