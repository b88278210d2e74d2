import { expect, it } from 'vitest';
import { decoder } from './decoder';

const read = (schema: string, ...bytes: number[]): unknown => decoder(schema)(new Uint8Array([0, 1, 0, 0, ...bytes]));

it('reads fields at multiples of their size, and no constants', () => {
  const schema =
    'uint8 ONE=1 # a constant\nuint8 a\nuint16 b 7 # with a default\n\n# a comment\nuint32 c\nuint8 d\nuint64 e';
  const bytes = [1, 0, 2, 0, 3, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0];
  expect(read(schema, ...bytes)).toEqual({ a: 1, b: 2, c: 3, d: 4, e: 5n });
});

it('reads lists of any, of a fixed and of a bounded length', () => {
  const schema = 'int8[] a\nint16[2] b\nbool[<=4] c\nstring<=9 d';
  const bytes = [1, 0, 0, 0, 255, 0, 254, 255, 3, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 104, 0];
  expect(read(schema, ...bytes)).toEqual({ a: Int8Array.of(-1), b: Int16Array.of(-2, 3), c: [true], d: 'h' });
});

it('reads types that are defined behind, with and without the name of their package', () => {
  const schema = 'pkg/Outer[] a\n===\nMSG: pkg/Outer\nInner b\n===\nMSG: pkg/msg/Inner\nuint8 c\n';
  expect(read(schema, 1, 0, 0, 0, 7)).toEqual({ a: [{ b: { c: 7 } }] });
});

it('takes an unqualified type from the package that names it, and refuses one that two packages have', () => {
  const inner = ['one', 'two'].map((name) => `===\nMSG: ${name}/Inner\nuint8 ${name}\n`).join('');
  expect(read(`two/Outer a\n${inner}===\nMSG: two/Outer\nInner b\n`, 7)).toEqual({ a: { b: { two: 7 } } });
  expect(() => read(`Inner a\n${inner}`, 7)).toThrow('ambiguous type Inner: one/Inner, two/Inner');
});

it('refuses lengths beyond the end of the message before it makes room for them', () => {
  const long = [255, 255, 255, 255];
  for (const type of ['float64[]', 'string', 'string[]', 'bool[]'])
    expect(() => read(`${type} a`, ...long, 104, 0), type).toThrow(/^CDR: got 10 bytes, expected at least \d+$/);
  expect(() => read('float64[100000000] a', 1)).toThrow('CDR: got 5 bytes');
  expect(() => read('uint32 a', 1, 2)).toThrow('CDR: got 6 bytes, expected at least 8');
  expect(() => decoder('uint8 a')(new Uint8Array([0, 1]))).toThrow('CDR: got 2 bytes, expected at least 4');
});

it('reads big-endian messages, and refuses other representations by name', () => {
  const decode = decoder('uint16 a');
  expect(decode(new Uint8Array([0, 0, 0, 0, 1, 2]))).toEqual({ a: 258 });
  expect(() => decode(new Uint8Array([0, 7, 0, 0, 1, 2]))).toThrow('CDR: got representation 7, expected 0 or 1');
  expect(() => read('Lost a', 0)).toThrow('got the unknown type Lost');
});
