// SPDX-License-Identifier: MIT
// What the dashboard costs at sixty frames a second: processor time of its main thread, memory, and how old a picture
// is.
//   CHICANE=/path/to/chicane node performance.mjs [seconds, 8] [times, 1]
import { argv } from 'node:process';
import { launch } from './browser.mjs';
import { startDrive } from './chicane_drive.mjs';
import { pageCost } from './page_cost.mjs';
import { SIXTY_A_SECOND } from './paints.mjs';

const SECONDS = Number(argv[2] ?? 8);
const TIMES = Number(argv[3] ?? 1);

async function measure(browser, url, tab) {
  const cost = await pageCost(browser, url, tab, SECONDS);
  const columns = [
    tab,
    cost.framesPerSecond.toFixed(0),
    cost.paintsPerSecond.toFixed(0),
    (100 * cost.mainThread).toFixed(0),
    cost.median?.toFixed(0),
    cost.p95?.toFixed(0),
    cost.heap.toFixed(1),
    cost.growth.toFixed(2),
  ];
  console.log(`| ${columns.join(' | ')} |`);
}

const browser = await launch();
const drive = await startDrive(SIXTY_A_SECOND);
console.log(
  '| tab | frames/s | painted/s | main thread, of one core [%] | message to screen p50 [ms] | p95 [ms] ' +
    '| heap [MB] | growth [MB] |\n|---|--:|--:|--:|--:|--:|--:|--:|',
);
for (let i = 0; i < TIMES; ++i) for (const tab of ['plots', 'explain']) await measure(browser, drive.url, tab);
await browser.close();
await drive.stop();
