// SPDX-License-Identifier: MIT
// The dashboard's figures, all by one command: what a page and its program cost, how soon a page is there, early and
// late in a run, how soon another future is, and what a second car costs the control step. Prints a table for the
// documentation; no test asserts it, because it depends on what else the machine does.
//   CHICANE=/path/to/chicane node measure.mjs [laps of the long run, 1000] [minutes of the hour, 60] [only these parts]
// Parts: page, program, late, hour, race. The long run takes 13 s / 20 a lap, the hour some minutes.
import { execFileSync, spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { availableParallelism, cpus, loadavg } from 'node:os';
import { argv } from 'node:process';
import { setTimeout as sleep } from 'node:timers/promises';
import { launch } from './browser.mjs';
import { startDrive } from './chicane_drive.mjs';
import { above, DashboardPage } from './dashboard_page.mjs';
import { arrivals, meter, notePaints, SIXTY_A_SECOND } from './paints.mjs';

const LAPS = Number(argv[2] ?? 1000);
const MINUTES = Number(argv[3] ?? 60);
const PARTS = argv.slice(4);
const isWanted = (part) => PARTS.length === 0 || PARTS.includes(part);

const row = (what, value, aim = '') => console.log(`| ${what} | ${value} | ${aim} |`);
const quantile = (values, share) =>
  [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];
const ms = (value) => (value >= 1000 ? `${(value / 1000).toFixed(2)} s` : `${value.toFixed(0)} ms`);

/** Processor time of a program [s], all of its threads. */
function processorTime(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, 'utf8').replace(/.*\) /, '').split(' ');
  return (Number(fields[11]) + Number(fields[12])) / Number(execFileSync('getconf', ['CLK_TCK']));
}
const memory = (pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, 'utf8'))[1]) / 1e3;

/**
 * From the beginning of a cold visit, nothing cached, until `isThere` is true in the page [ms], by the page's own
 * clock; asked at each of its repaints.
 */
async function timeUntil(browser, address, isThere, argument) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  const page = await context.newPage();
  await page.addInitScript(() => localStorage.setItem('chicane.camera', '"track"'));
  await page.addInitScript(
    ({ text, argument }) => {
      const isThere = new Function(`return ${text}`)();
      globalThis.wasThere = new Promise((resolve) => {
        const look = () => {
          if (document.body && isThere(argument)) resolve(performance.now());
          else requestAnimationFrame(look);
        };
        requestAnimationFrame(look);
      });
    },
    { text: isThere.toString(), argument },
  );
  await page.goto(address);
  const time = await page.evaluate(() => globalThis.wasThere);
  await context.close();
  return time;
}
/** The map with road and car: more colours than an empty ground has. */
const hasPicture = () => {
  const canvas = document.querySelector('canvas.map-2d');
  if (!canvas || canvas.width === 0) return false;
  const copy = new OffscreenCanvas(160, 90).getContext('2d');
  copy.drawImage(canvas, 0, 0, 160, 90);
  return new Set(new Uint32Array(copy.getImageData(0, 0, 160, 90).data.buffer)).size > 8;
};
/** The table of laps with this one, the newest at its end. */
const hasLap = (lap) =>
  Number.parseInt(document.querySelector('[data-testid="lap-rows"] tbody tr:last-child th')?.textContent ?? '', 10) >=
  lap;

/** What a page costs that shows the run at `url` for so many seconds. `meanwhile` is awaited beside. */
async function pageCost(browser, url, mode, seconds, meanwhile = async () => undefined) {
  const dashboard = await DashboardPage.open(browser, url, { mode, fluent: true, script: notePaints });
  const { page } = dashboard;
  await dashboard.until(dashboard.speed, above(5), 'a car that drives');
  const read = await meter(page);
  await sleep(3000); // the history fills, code is compiled
  const other = await arrivals(url);
  const [begin, first] = [performance.now(), await read()];
  await Promise.all([sleep(seconds * 1000), meanwhile()]);
  const elapsed = (performance.now() - begin) / 1000;
  const paints = new Map(await page.evaluate(() => [...globalThis.paints]));
  const arrived = other.times.size;
  const last = await read();
  other.close();
  await page.context().close();
  const ages = [...other.times].flatMap(([stamp, time]) => (paints.has(stamp) ? [paints.get(stamp) - time] : []));
  return {
    framesPerSecond: arrived / elapsed,
    mainThread: (last.busy - first.busy) / elapsed, // of one core
    p95: quantile(ages, 0.95), // from message to screen [ms]
  };
}

async function several(times, measure) {
  const values = [];
  for (let i = 0; i < times; ++i) values.push(await measure());
  return `${ms(quantile(values, 0.5))} (${ms(Math.min(...values))} to ${ms(Math.max(...values))})`;
}

/** From the click on "Drive both" to the verdict, of ten seconds from now on [ms]. */
async function timeToAnswer(browser, url) {
  const dashboard = await DashboardPage.open(browser, url, { mode: 'try', fluent: true });
  const { page } = dashboard;
  await dashboard.aimAt('second');
  await dashboard.type('latency_ms', 60);
  await page.getByLabel('For how long').selectOption('10');
  const time = await page.evaluate(async () => {
    const begin = performance.now();
    [...document.querySelectorAll('button')].find((each) => each.textContent === 'Drive both').click();
    while (!document.querySelector('[data-testid="what-if-verdict"]'))
      await new Promise((resolve) => requestAnimationFrame(resolve));
    return performance.now() - begin;
  });
  await page.context().close();
  return time;
}

/** The control step of a run in real time [µs], with a second car or without; a page begins it and goes. */
async function stepTimes(browser, withRival, seconds) {
  const drive = await startDrive(['--track', 'oval', '--pace', '4', '--json']);
  const dashboard = await DashboardPage.open(browser, drive.url, { mode: 'try', fluent: true });
  const { page } = dashboard;
  if (withRival) {
    await dashboard.aimAt('second');
    await dashboard.type('tracking_mpc.weight_lateral', 4);
    await dashboard.button('Race A against B').click();
    await page.getByTestId('race').waitFor();
  } else {
    await dashboard.startAgain();
  }
  await page.context().close();
  await sleep(seconds * 1000);
  return (await drive.result()).step_time_us;
}

const browser = await launch();
const model = cpus()[0]?.model ?? 'unknown';
console.log(`${model}, ${availableParallelism()} cores, load ${loadavg()[0].toFixed(1)} at the beginning\n`);
console.log('| | measured | aim |\n|---|--:|--:|');

if (isWanted('page')) {
  const drive = await startDrive(['--track', 'oval', ...SIXTY_A_SECOND]);
  await pageCost(browser, drive.url, 'understand', 1); // the program's page is read once
  row('first picture of a cold page', await several(5, () => timeUntil(browser, drive.url, hasPicture)), '≤ 1 s');
  for (const mode of ['watch', 'understand']) {
    const cost = await pageCost(browser, drive.url, mode, 10);
    const rate = `${mode}, ${cost.framesPerSecond.toFixed(0)} frames a second`;
    row(`main thread of the page, ${rate}`, `${(100 * cost.mainThread).toFixed(0)} %`, '< 50 %');
    row(`message to screen p95, ${rate}`, ms(cost.p95), '≤ 100 ms');
  }
  await drive.stop();
}
if (isWanted('program')) {
  for (const preset of ['default', 'race']) {
    const drive = await startDrive(['--track', 'oval', '--preset', preset]);
    let share = 0;
    await pageCost(browser, drive.url, 'understand', 30, async () => {
      const [begin, used] = [performance.now(), processorTime(drive.pid)];
      await sleep(30_000);
      share = (processorTime(drive.pid) - used) / ((performance.now() - begin) / 1000);
    });
    row(`program, ${preset}, real time, one page`, `${(100 * share).toFixed(1)} % of a core`, '≤ 2 %');
    await drive.stop();
  }
}
if (isWanted('late')) {
  const drive = await startDrive(['--track', 'oval', '--pace', '20']);
  for (const lap of [1, 50, LAPS]) {
    const watching = await DashboardPage.open(browser, drive.url, { mode: 'understand', fluent: true });
    while (!(await watching.page.evaluate(hasLap, lap))) await sleep(500);
    await watching.page.context().close();
    const table = await several(5, () => timeUntil(browser, `${drive.url}#understand`, hasLap, lap));
    row(`table of laps, of a page opened at lap ${lap}`, table, '≤ 1 s');
    row(`another future from now on, asked at lap ${lap}`, await several(5, () => timeToAnswer(browser, drive.url)));
    row(`memory of the program at lap ${lap}`, `${memory(drive.pid).toFixed(0)} MB`);
  }
  await drive.stop();
}
if (isWanted('race')) {
  const seconds = 60;
  const all = { alone: [], both: [] };
  for (let i = 0; i < 2; ++i) {
    all.alone.push(await stepTimes(browser, false, seconds));
    all.both.push(await stepTimes(browser, true, seconds));
  }
  for (const [name, times] of Object.entries(all)) {
    const told = (key) => times.map((each) => each[key].toFixed(0)).join(', ');
    row(
      `control step p50 / p99.9 of ${name === 'both' ? 'two cars' : 'one car'}, each run [µs]`,
      `${told('p50')} / ${told('p999')}`,
    );
  }
  const best = (runs) => Math.min(...runs.map(({ p999 }) => p999));
  const moved = best(all.both) - best(all.alone);
  row('p99.9 of the control step moves by, better run of each', `${(moved / 1000).toFixed(3)} ms`, '< 1 ms');
}
await browser.close();
if (isWanted('hour')) {
  const found = spawnSync('node', ['hour.mjs', String(MINUTES)], { encoding: 'utf8' });
  row(
    `heap and arrays of a page after ${MINUTES} minutes more than after a sixth of them`,
    found.stdout.trim().split('\n').at(-1),
    '< 1 MB',
  );
}
console.log(`\nload ${loadavg()[0].toFixed(1)} at the end`);
