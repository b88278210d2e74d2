// SPDX-License-Identifier: MIT
// What a choice that restarts the run costs viewers: how long until the new run is seen, and the longest gap
// between two frames meanwhile, beside as much time in which nothing is chosen. The limit of the run before is still
// being searched at each choice.
//   CHICANE=/path/to/chicane node choices.mjs [rounds, 10] [seconds, 1]
import { argv } from 'node:process';
import { setTimeout as sleep } from 'node:timers/promises';
import { startDrive, subscribe } from './chicane_drive.mjs';

const ROUNDS = Number(argv[2] ?? 10);
const SECONDS = Number(argv[3] ?? 1);
const CHOICES = [
  ['track', 'oval'],
  ['car', 'road-car'],
  ['track', 'hairpins'],
  ['track', 'speedway'],
  ['car', 'udacity'],
  ['track', 'lakeside'],
];

/** Gaps between frames [ms], and when the first frame of another run came. */
async function watch(url) {
  const seen = { gaps: [], refusals: [], last: NaN, time: -1, began: NaN };
  const isFrame = (topic) => topic === '/chicane/frame';
  const { client } = await subscribe(url, isFrame, (_topic, { time_s: time }) => {
    const now = performance.now();
    if (Number.isFinite(seen.last)) seen.gaps.push(now - seen.last);
    if (time < seen.time) seen.began = now;
    [seen.last, seen.time] = [now, time];
  });
  client.on('status', ({ message }) => seen.refusals.push(message));
  return Object.assign(seen, { client });
}

const drive = await startDrive();
const seen = await watch(drive.url);
await sleep(1000);

/**
 * The longest gap [ms] of some time, at the beginning of which `act` happens, and how long it took the new run to be
 * seen.
 */
async function observe(act) {
  seen.gaps = [];
  const begin = performance.now();
  act();
  await sleep(SECONDS * 1000);
  return { longest: Math.max(...seen.gaps), until: seen.began - begin };
}

const found = { quiet: [], chosen: [], until: [] };
for (let round = 0; round < ROUNDS; ++round) {
  for (const [name, value] of CHOICES) {
    found.quiet.push((await observe(() => undefined)).longest);
    const { longest, until } = await observe(() => seen.client.setParameters([{ name, value }], name));
    found.chosen.push(longest);
    found.until.push(until);
  }
}

function row(name, values) {
  const all = [...values].sort((a, b) => a - b);
  const at = (share) => all[Math.min(all.length - 1, Math.floor(share * all.length))].toFixed(0);
  console.log(`| ${name} | ${all.length} | ${at(0.5)} | ${at(0.9)} | ${at(1)} |`);
}
console.log('| [ms] | number | median | 9 of 10 | worst |\n|---|--:|--:|--:|--:|');
row(`longest gap in ${SECONDS} s, nothing chosen`, found.quiet);
row('the same with a choice', found.chosen);
row('from the choice to the first frame of the new run', found.until);
for (const sentence of seen.refusals) console.log(sentence);
seen.client.close();
await drive.stop();
