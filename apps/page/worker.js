// Worker of the browser: drives the run of page.cpp, and exchanges with the page the messages that a WebSocket would
// carry (web/src/page/worker_link.ts). Appended to the script of Emscripten, in one file.
const TURN_S = 0.02; // longest driving before messages are read [s]; chosen

Module.postToPage = (bytes, isBinary) => {
  if (isBinary) postMessage({ kind: 'message', data: bytes.buffer }, [bytes.buffer]);
  else postMessage({ kind: 'message', data: new TextDecoder().decode(bytes) });
};

// Calls `use` with a copy of a message in the memory of the program.
function withBytes(data, use) {
  const isBinary = typeof data !== 'string';
  const bytes = isBinary ? new Uint8Array(data) : new TextEncoder().encode(data);
  const at = Module._malloc(bytes.length);
  Module.HEAPU8.set(bytes, at);
  use(at, bytes.length, isBinary);
  Module._free(at);
}

// Requests of the page by kind.
const requests = {
  connect: () => Module._page_connect(),
  message: ({ data }) => withBytes(data, (at, size, isBinary) => Module._page_receive(at, size, isBinary)),
  taken: ({ count }) => Module._page_acknowledge(count),
  get({ id, path }) {
    const text = Module.ccall('page_get', 'number', ['string'], [path]);
    postMessage({ kind: 'content', id, text: text === 0 ? null : UTF8ToString(text) });
  },
};

// Drives up to now, again and again.
function turn() {
  const begin = performance.now();
  Module._page_advance(begin / 1000, TURN_S);
  setTimeout(turn, Math.max(0, 4 - (performance.now() - begin))); // every 4 ms, the least timer of browsers
}

const early = []; // requests before the program is ready
globalThis.onmessage = ({ data }) => early.push(data);

Module.onRuntimeInitialized = () => {
  const problem = Module.ccall('page_begin', 'string', [], []);
  if (problem !== '') return postMessage({ kind: 'problem', text: problem });
  globalThis.onmessage = ({ data }) => requests[data.kind](data);
  for (const request of early) requests[request.kind](request);
  turn();
};
