// SPDX-License-Identifier: MIT
// An hour of a run in real time with three pages open: what the program takes of a core, what each page's main thread
// takes of one, whether their heaps grow, and how old a picture is at the end. By processor time, which other programs
// change little; no test asserts it.
//   CHICANE=/path/to/chicane node open_hour.mjs [minutes, 60] [preset, race] [tabs, plots,explain,laps]
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { loadavg } from 'node:os';
import { argv } from 'node:process';
import { setTimeout as sleep } from 'node:timers/promises';
import { launch } from './browser.mjs';
import { startDrive } from './chicane_drive.mjs';
import { pageCost } from './page_cost.mjs';
import { meter } from './paints.mjs';

const MINUTES = Number(argv[2] ?? 60);
const PRESET = argv[3] ?? 'race';
const OPEN = (argv[4] ?? 'plots,explain,laps').split(',');
const SAMPLES = 6;

/** Processor time of a program [s], all of its threads. */
function processorTime(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, 'utf8').replace(/.*\) /, '').split(' ');
  return (Number(fields[11]) + Number(fields[12])) / Number(execFileSync('getconf', ['CLK_TCK']));
}
const percent = (share) => `${(100 * share).toFixed(1)} %`;

const drive = await startDrive(['--track', 'lakeside', '--preset', PRESET]);
const browser = await launch();
const pages = [];
for (const tab of OPEN) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  const page = await context.newPage();
  await page.addInitScript(() => localStorage.setItem('chicane.camera', '"track"'));
  await page.goto(`${drive.url}#${tab}`);
  await page.getByText('Live', { exact: true }).waitFor();
  pages.push({ tab, read: await meter(page) });
}
await sleep(60_000); // plots and tables fill, the limit is found
console.log(`load ${loadavg()[0].toFixed(1)} at the beginning`);
console.log(
  `| minutes | program, of a core | ${OPEN.map((tab) => `${tab}: main thread | heap [MB]`).join(' | ')} |\n` +
    `|--:|--:|${OPEN.map(() => '--:|--:').join('|')}|`,
);
const read = () => Promise.all(pages.map((each) => each.read()));
let [clock, used, before] = [performance.now(), processorTime(drive.pid), await read()];
for (let i = 1; i <= SAMPLES; ++i) {
  await sleep((60_000 * MINUTES) / SAMPLES);
  const now = await read();
  const elapsed = (performance.now() - clock) / 1000;
  const taken = processorTime(drive.pid) - used;
  const cells = now.map(
    (each, k) => `${percent((each.busy - before[k].busy) / elapsed)} | ${(each.heap / 1e6).toFixed(2)}`,
  );
  console.log(`| ${((MINUTES * i) / SAMPLES).toFixed(1)} | ${percent(taken / elapsed)} | ${cells.join(' | ')} |`);
  [clock, used, before] = [performance.now(), processorTime(drive.pid), await read()];
}
for (const tab of OPEN.slice(0, 2)) {
  const cost = await pageCost(browser, drive.url, tab, 20);
  console.log(
    `${tab}: message to screen p50 ${cost.median.toFixed(0)} ms, p95 ${cost.p95.toFixed(0)} ms, a fourth page`,
  );
}
console.log(`load ${loadavg()[0].toFixed(1)} at the end`);
await browser.close();
await drive.stop();
