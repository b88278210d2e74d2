import { parse } from '@foxglove/rosmsg';
import { MessageReader } from '@foxglove/rosmsg2-serialization';

/** Reads CDR messages of the type that a ROS 2 schema text describes. */
export function decoder(schema: string): (bytes: ArrayBufferView) => unknown {
  const reader = new MessageReader(parse(schema, { ros2: true }));
  return (bytes) => reader.readMessage(bytes);
}

/** The request of std_srvs/srv/SetBool: XCDR1 header, little endian, and one byte. */
export const encodeBool = (value: boolean): Uint8Array => new Uint8Array([0, 1, 0, 0, value ? 1 : 0]);

/** The request of std_srvs/srv/Trigger, which is empty. */
export const encodeNothing = (): Uint8Array => new Uint8Array([0, 1, 0, 0]);

/** The request of chicane_msgs/srv/Ask, one text: its length with a final zero, and the bytes. */
export function encodeText(text: string): Uint8Array {
  const bytes = new TextEncoder().encode(text);
  const request = new Uint8Array(8 + bytes.length + 1);
  request.set([0, 1, 0, 0]);
  new DataView(request.buffer).setUint32(4, bytes.length + 1, true);
  request.set(bytes, 8);
  return request;
}
