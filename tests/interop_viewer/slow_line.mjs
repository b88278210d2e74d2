// SPDX-License-Identifier: MIT
// A slow line in front of a program: so many bytes a second, and so much delay each way.
import { once } from 'node:events';
import { connect, createServer } from 'node:net';

const HELD = 16 * 1024; // by a router on the way [byte]

/** Passes bytes on after `delay` [ms], no more than `rate` of them a second. */
function carry(from, to, rate, delay) {
  let [waiting, free] = [0, 0];
  from.on('data', (bytes) => {
    waiting += bytes.length;
    const now = performance.now();
    free = Math.max(free, now) + (1000 * bytes.length) / rate;
    if (waiting > HELD) from.pause();
    setTimeout(() => {
      waiting -= bytes.length;
      if (waiting <= HELD) from.resume();
      setTimeout(() => to.writable && to.write(bytes), delay);
    }, free - now);
  });
  from.on('close', () => to.destroy());
  from.on('error', () => to.destroy());
}

/** Stands between a browser and `port`; `rate` [byte/s] and `delay` [ms] are those of the line. */
export async function slowLine(port, { rate, delay }) {
  const carried = { bytes: 0 };
  const server = createServer({ highWaterMark: 4096 }, (browser) => {
    const program = connect({ port, host: '127.0.0.1', highWaterMark: 4096 });
    carry(browser, program, 1e9, delay);
    carry(program, browser, rate, delay);
    program.on('data', (bytes) => (carried.bytes += bytes.length));
  });
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  const address = server.address().port;
  return { url: `http://127.0.0.1:${address}/`, port: address, carried, stop: () => server.close() };
}
