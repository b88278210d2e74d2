// The browser's worker: drives the run that page.cpp holds, and exchanges with the page what a WebSocket would carry
// (web/src/page/worker_link.ts). Behind Emscripten's own script, in one file.
const TURN_S = 0.02; // driven at once at most, so that messages wait no longer [s]

Module.postToPage = (bytes, isBinary) => {
  if (isBinary) postMessage({ kind: 'message', data: bytes.buffer }, [bytes.buffer]);
  else postMessage({ kind: 'message', data: new TextDecoder().decode(bytes) });
};

function withBytes(data, use) {
  const isBinary = typeof data !== 'string';
  const bytes = isBinary ? new Uint8Array(data) : new TextEncoder().encode(data);
  const at = Module._malloc(bytes.length);
  Module.HEAPU8.set(bytes, at);
  use(at, bytes.length, isBinary);
  Module._free(at);
}

const requests = {
  connect: () => Module._page_connect(),
  message: ({ data }) => withBytes(data, (at, size, isBinary) => Module._page_receive(at, size, isBinary)),
  taken: ({ count }) => Module._page_acknowledge(count),
  get({ id, path }) {
    const text = Module.ccall('page_get', 'number', ['string'], [path]);
    postMessage({ kind: 'content', id, text: text === 0 ? null : UTF8ToString(text) });
  },
};

function turn() {
  const begin = performance.now();
  Module._page_advance(begin / 1000, TURN_S);
  setTimeout(turn, Math.max(0, 4 - (performance.now() - begin)));
}

const early = []; // before the program is there
globalThis.onmessage = ({ data }) => early.push(data);

Module.onRuntimeInitialized = () => {
  const problem = Module.ccall('page_begin', 'string', [], []);
  if (problem !== '') return postMessage({ kind: 'problem', text: problem });
  globalThis.onmessage = ({ data }) => requests[data.kind](data);
  for (const request of early) requests[request.kind](request);
  turn();
};
