// SPDX-License-Identifier: MIT
// The stock socket.io-client drives a few cycles: node socket_io_client.mjs SERVER_PROGRAM
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { createInterface } from 'node:readline';
import { io } from 'socket.io-client';

const telemetry = {
  ptsx: [-32.16173, -43.49173, -61.09, -78.29172, -93.05002, -107.7717],
  ptsy: [113.361, 105.941, 92.88499, 78.73102, 65.34102, 50.57938],
  psi_unity: 4.120315,
  psi: 3.733667,
  x: -40.62008,
  y: 108.7301,
  steering_angle: 0,
  throttle: 0,
  speed: 20,
};

const server = spawn(process.argv[2], { stdio: ['pipe', 'pipe', 'inherit'] });
const [line] = await once(createInterface({ input: server.stdout }), 'line');
const url = `http://127.0.0.1:${line.split(' ')[1]}`;
const deadline = setTimeout(() => {
  console.error('failed: nothing happens');
  process.exit(1);
}, 60_000);

/** A connected stock client. */
async function connect() {
  const socket = io(url, { transports: ['websocket'], reconnection: false });
  socket.on('connect_error', (error) => {
    console.error('connect_error:', error.message);
    process.exit(1);
  });
  await once(socket, 'connect');
  return socket;
}

/** Emits telemetry and returns the data of the one event that answers. */
async function ask(socket, data, event) {
  let others = 0;
  const count = () => {
    others += 1;
  };
  socket.onAny(count);
  const answer = once(socket, event);
  socket.emit('telemetry', data);
  const [reply] = await answer;
  await new Promise((resolve) => setTimeout(resolve, 20));
  socket.offAny(count);
  assert.equal(others, 1, 'exactly one answer');
  return reply;
}

for (let visit = 0; visit < 2; ++visit) {
  const socket = await connect();
  for (let cycle = 0; cycle < 5; ++cycle) {
    const steer = await ask(socket, telemetry, 'steer');
    assert.deepEqual(Object.keys(steer), ['mpc_x', 'mpc_y', 'next_x', 'next_y', 'steering_angle', 'throttle']);
    assert.ok(Math.abs(steer.steering_angle) <= 1 && Math.abs(steer.throttle) <= 1);
    assert.ok(steer.mpc_x.length > 0 && steer.mpc_x.length === steer.mpc_y.length);
  }
  assert.deepEqual(await ask(socket, null, 'manual'), {});
  const braking = await ask(socket, { ...telemetry, x: 'NaN' }, 'steer');
  assert.ok(braking.throttle < 0, 'broken telemetry is answered by braking');
  socket.disconnect();
}

clearTimeout(deadline);
server.stdin.end();
const [code] = await once(server, 'exit');
assert.equal(code, 0);
console.log('socket.io-client was answered');
