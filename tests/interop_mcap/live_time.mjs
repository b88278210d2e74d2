// SPDX-License-Identifier: MIT
// The run's time as a program tells its viewers, by the Foxglove WebSocket protocol on a bare socket.
import { once } from 'node:events';
import { connect } from 'node:net';

/** A masked text frame of a client, up to 65535 bytes. */
function textFrame(text) {
  const payload = Buffer.from(text);
  const head =
    payload.length < 126 ? [0x81, 0x80 | payload.length] : [0x81, 0xfe, payload.length >> 8, payload.length & 255];
  return Buffer.concat([Buffer.from([...head, 0, 0, 0, 0]), payload]); // a mask of zeros
}

/** Connects and subscribes; `time()` is the newest time heard [s]. */
export async function listen(port) {
  const socket = connect(port, '127.0.0.1');
  await once(socket, 'connect');
  socket.write(
    `GET / HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n` +
      'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n' +
      'Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n',
  );
  let input = Buffer.alloc(0);
  let isOpen = false;
  let newest = null;
  const hear = (opcode, payload) => {
    if (opcode === 1) {
      const message = JSON.parse(payload.toString());
      const clock = message.op === 'advertise' && message.channels.find(({ topic }) => topic === '/clock');
      if (clock)
        socket.write(textFrame(JSON.stringify({ op: 'subscribe', subscriptions: [{ id: 1, channelId: clock.id }] })));
    } else if (opcode === 2 && payload[0] === 2) {
      newest = Number(payload.readBigUInt64LE(1)) / 1e9;
    }
  };
  socket.on('data', (data) => {
    input = Buffer.concat([input, data]);
    if (!isOpen) {
      const end = input.indexOf('\r\n\r\n');
      if (end < 0) return;
      isOpen = true;
      input = input.subarray(end + 4);
    }
    while (input.length >= 2) {
      const short = input[1] & 127;
      const start = short < 126 ? 2 : short === 126 ? 4 : 10;
      if (input.length < start) return;
      const size = short < 126 ? short : short === 126 ? input.readUInt16BE(2) : Number(input.readBigUInt64BE(2));
      if (input.length < start + size) return;
      hear(input[0] & 15, input.subarray(start, start + size));
      input = input.subarray(start + size);
    }
  });
  socket.on('error', () => {}); // it ends when the program is killed
  return { time: () => newest, close: () => socket.destroy() };
}
