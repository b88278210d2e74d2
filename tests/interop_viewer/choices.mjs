// SPDX-License-Identifier: MIT
// What a choice that starts the run anew costs whoever watches: the longest gap between two frames, and the longest answer to a GET,
// which the network thread gives; beside as many seconds in which nothing is chosen.
//   CHICANE=/path/to/chicane node choices.mjs [rounds, 4] [seconds, 2]
import { get } from 'node:http';
import { argv } from 'node:process';
import { setTimeout as sleep } from 'node:timers/promises';
import rosmsg from '@foxglove/rosmsg';
import cdr from '@foxglove/rosmsg2-serialization';
import foxglove from '@foxglove/ws-protocol';
import WebSocket from 'ws';
import { startDrive } from './chicane_drive.mjs';

const ROUNDS = Number(argv[2] ?? 4);
const SECONDS = Number(argv[3] ?? 2);
const CHOICES = [
  ['track', 'oval'],
  ['car', 'road-car'],
  ['track', 'hairpins'],
  ['preset', 'sixty-mph'],
  ['track', 'speedway'],
  ['preset', 'default'],
  ['car', 'udacity'],
  ['track', 'lakeside'],
];

/** Gaps between frames [ms], and when the first frame of another run came. */
async function watch(url) {
  const client = new foxglove.FoxgloveClient({ ws: new WebSocket(url.replace('http', 'ws'), ['foxglove.sdk.v1']) });
  const seen = { client, gaps: [], refusals: [], last: NaN, time: -1, began: NaN };
  let reader;
  client.on('advertise', (channels) => {
    const { id, schema } = channels.find(({ topic }) => topic === '/chicane/frame');
    reader = new cdr.MessageReader(rosmsg.parse(schema, { ros2: true }));
    client.subscribe(id);
  });
  client.on('message', ({ data }) => {
    const now = performance.now();
    const { time_s: time } = reader.readMessage(data);
    if (Number.isFinite(seen.last)) seen.gaps.push(now - seen.last);
    if (time < seen.time) seen.began = now;
    [seen.last, seen.time] = [now, time];
  });
  client.on('status', ({ message }) => seen.refusals.push(message));
  await new Promise((resolve) => client.on('open', resolve));
  return seen;
}

/** How long GETs wait, one after the other [ms]. */
function ask(url) {
  const waits = [];
  let goesOn = true;
  const once = () =>
    new Promise((resolve, reject) => {
      const begin = performance.now();
      get(`${url}mode.json`, (response) => response.resume().on('end', () => resolve(waits.push(performance.now() - begin)))).on('error', reject);
    });
  const done = (async () => {
    while (goesOn) {
      await once();
      await sleep(5);
    }
  })();
  return { waits, stop: () => ((goesOn = false), done) };
}

const sorted = (values) => [...values].sort((a, b) => a - b);
const row = (name, values) => {
  const all = sorted(values);
  const at = (share) => (all[Math.min(all.length - 1, Math.floor(share * all.length))] ?? NaN).toFixed(1);
  console.log(`| ${name} | ${all.length} | ${at(0.5)} | ${at(0.99)} | ${at(1)} |`);
};

const drive = await startDrive();
const seen = await watch(drive.url);
await sleep(2000);
const found = { quiet: { longest: [], waits: [] }, chosen: { longest: [], waits: [], ready: [] } };

/** Watches for some seconds; `act` happens at their beginning. */
async function observe(into, act) {
  seen.gaps = [];
  seen.began = NaN;
  const asked = ask(drive.url);
  const begin = performance.now();
  act?.();
  await sleep(SECONDS * 1000);
  await asked.stop();
  into.longest.push(Math.max(...seen.gaps));
  into.waits.push(Math.max(...asked.waits));
  into.ready?.push(seen.began - begin);
}

for (let round = 0; round < ROUNDS; ++round) {
  for (const [name, value] of CHOICES) {
    await observe(found.quiet);
    await observe(found.chosen, () => seen.client.setParameters([{ name, value }], name));
  }
}
console.log('| | number | median [ms] | 99 of 100 | worst |\n|---|--:|--:|--:|--:|');
row(`longest gap between frames in ${SECONDS} s, nothing chosen`, found.quiet.longest);
row('the same with a choice', found.chosen.longest);
row(`longest answer to a GET in ${SECONDS} s, nothing chosen`, found.quiet.waits);
row('the same with a choice', found.chosen.waits);
row('from the choice to the first frame of the new run', found.chosen.ready);
if (seen.refusals.length > 0) console.log(seen.refusals);
seen.client.close();
await drive.stop();
