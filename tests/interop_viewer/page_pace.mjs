// SPDX-License-Identifier: MIT
// How fast the run of the page that needs no program is, by processor time, which a busy machine does not change.
//   node page_pace.mjs build/page/page.js [rounds, 5]
import { readFileSync } from 'node:fs';
import { argv, cpuUsage } from 'node:process';
import { setTimeout as sleep } from 'node:timers/promises';
import vm from 'node:vm';

// What a browser's worker has.
Object.assign(globalThis, { self: globalThis, location: { href: 'file:///page.js' } });
Object.assign(globalThis, { importScripts: () => undefined, postMessage: () => undefined });
let isReady = false;
vm.runInThisContext(`${readFileSync(argv[2] ?? 'build/page/page.js', 'utf8')}
  const begin = Module.onRuntimeInitialized;
  Module.onRuntimeInitialized = () => { begin(); globalThis.isReady = true; };`);
while (!isReady) {
  await sleep(50);
  isReady = globalThis.isReady === true;
}
const { Module, UTF8ToString } = globalThis;
const time = () => JSON.parse(UTF8ToString(Module.ccall('page_get', 'number', ['string'], ['/run.json']))).time_s;
let clock = performance.now() / 1000 + 1000; // ahead of the worker's own
for (let round = 0; round <= Number(argv[3] ?? 5); ++round) {
  const [from, used] = [time(), cpuUsage()];
  for (let i = 0; i < 100; ++i) {
    clock += 1;
    Module._page_advance(clock, 1000);
  }
  const { user, system } = cpuUsage(used);
  const seconds = (user + system) / 1e6;
  const driven = time() - from;
  // The first round warms the compiler up.
  if (round > 0)
    console.log(
      `${driven.toFixed(0)} s in ${seconds.toFixed(2)} s of processor time: ${(driven / seconds).toFixed(0)} x`,
    );
}
process.exit(0);
