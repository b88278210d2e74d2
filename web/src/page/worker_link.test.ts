import { expect, test } from 'vitest';
import { type Port, WorkerLink } from './worker_link';

/** A worker that keeps what it is sent. */
function fakeWorker() {
  const sent: unknown[] = [];
  const port: Port = { onmessage: null, postMessage: (message) => sent.push(message) };
  const link = new WorkerLink(
    () => undefined,
    async () => port,
  );
  return { sent, port, link, say: (data: unknown) => port.onmessage?.({ data } as never) };
}
const settle = () => new Promise((resolve) => setTimeout(resolve, 0));

test('a connection opens, carries messages both ways, and says what it has taken', async () => {
  const { sent, link, say } = fakeWorker();
  const socket = link.open();
  const got: unknown[] = [];
  socket.onmessage = ({ data }) => got.push(data);
  await settle();
  expect(sent).toEqual([{ kind: 'connect' }]);
  socket.send(new Uint8Array([1, 2, 3, 4]).subarray(1, 3));
  socket.send('text');
  await settle();
  expect(sent.slice(1)).toEqual([
    { kind: 'message', data: new Uint8Array([2, 3]).buffer },
    { kind: 'message', data: 'text' },
  ]);
  say({ kind: 'message', data: 'hello' });
  expect(got).toEqual(['hello']);
  expect(sent.at(-1)).toEqual({ kind: 'taken', count: 1 });
});

test('messages go to the connection that was opened last', async () => {
  const { sent, link, say } = fakeWorker();
  const got: string[] = [];
  link.open().onmessage = () => got.push('first');
  link.open().onmessage = () => got.push('second');
  await settle();
  say({ kind: 'message', data: '' });
  expect(got).toEqual(['second']);
  expect(sent.filter((message) => (message as { kind: string }).kind === 'connect')).toHaveLength(1);
});

test('each question gets its own answer', async () => {
  const { link, say } = fakeWorker();
  const answers = [link.get('/schema.json'), link.get('/none.json')];
  await settle();
  say({ kind: 'content', id: 2, text: null });
  say({ kind: 'content', id: 1, text: '[]' });
  expect(await Promise.all(answers)).toEqual(['[]', null]);
});

test('reports a run that cannot begin, and a worker that cannot', async () => {
  const sentences: string[] = [];
  const { port, say } = fakeWorker();
  new WorkerLink(
    (sentence) => sentences.push(sentence),
    async () => port,
  );
  await settle();
  say({ kind: 'problem', text: 'no track' });
  new WorkerLink(
    (sentence) => sentences.push(sentence),
    () => Promise.reject(new Error('no worker')),
  );
  await settle();
  expect(sentences).toEqual(['no track', 'Error: no worker']);
});
