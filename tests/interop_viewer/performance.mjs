// SPDX-License-Identifier: MIT
// What the dashboard costs at sixty frames a second: processor time of its main thread, memory, and how old a picture
// is.
//   CHICANE=/path/to/chicane node performance.mjs [seconds, 8] [times, 1]
import { argv } from 'node:process';
import { launch } from './browser.mjs';
import { startDrive } from './chicane_drive.mjs';
import { DashboardPage } from './dashboard_page.mjs';
import { arrivals, meter, notePaints, SIXTY_A_SECOND } from './paints.mjs';

const SECONDS = Number(argv[2] ?? 8);
const TIMES = Number(argv[3] ?? 1);

const quantile = (values, share) =>
  values.sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];

async function measure(browser, url, tab) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  const page = await context.newPage();
  await page.addInitScript(() => localStorage.setItem('chicane.dimension', '"2d"'));
  await page.addInitScript(notePaints);
  await page.goto(`${url}#${tab}`);
  await page.getByText('Live', { exact: true }).waitFor();
  const dashboard = new DashboardPage(page, []);
  await dashboard.until(
    () => dashboard.number('speed'),
    (mph) => mph > 5,
    'a car that drives',
  );
  const read = await meter(page);
  await page.waitForTimeout(3000); // the history fills, code is compiled
  const other = await arrivals(url);
  const first = await read();
  const [begin, paintsBefore] = [performance.now(), await page.evaluate(() => globalThis.paints.size)];
  await page.waitForTimeout(SECONDS * 1000);
  const elapsed = (performance.now() - begin) / 1000;
  const paints = new Map(await page.evaluate(() => [...globalThis.paints]));
  const arrived = other.times.size;
  const last = await read();
  other.close();
  await context.close();
  const ages = [...other.times].flatMap(([stamp, time]) => (paints.has(stamp) ? [paints.get(stamp) - time] : []));
  const columns = [
    tab,
    (arrived / elapsed).toFixed(0),
    ((paints.size - paintsBefore) / elapsed).toFixed(0),
    ((100 * (last.busy - first.busy)) / elapsed).toFixed(0),
    quantile(ages, 0.5)?.toFixed(0),
    quantile(ages, 0.95)?.toFixed(0),
    (last.heap / 1e6).toFixed(1),
    ((last.heap - first.heap) / 1e6).toFixed(2),
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
