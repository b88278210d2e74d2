// SPDX-License-Identifier: MIT
// How soon the page answers while it shows a run: how late its timers come, beside repaints, pictures in three
// dimensions, and the processor time of its thread.
//   CHICANE=/path/to/chicane node responsiveness.mjs [seconds, 10] [times, 3]
import { argv } from 'node:process';
import { launch } from './browser.mjs';
import { startDrive } from './chicane_drive.mjs';

const SECONDS = Number(argv[2] ?? 10);
const TIMES = Number(argv[3] ?? 3);
const TIMER_MS = 10;

/** In the page: counts. */
function count({ timer, dimension }) {
  localStorage.setItem('chicane.camera', JSON.stringify(dimension === '3d' ? 'chase' : 'track'));
  globalThis.counts = { repaints: 0, pictures: 0, late: [] };
  const { clear } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.clear = function (bits) {
    ++globalThis.counts.pictures; // every picture begins so
    return clear.call(this, bits);
  };
  const repaint = () => {
    ++globalThis.counts.repaints;
    requestAnimationFrame(repaint);
  };
  requestAnimationFrame(repaint);
  let last = performance.now();
  setInterval(() => {
    const now = performance.now();
    globalThis.counts.late.push(Math.max(0, now - last - timer));
    last = now;
  }, timer);
}

const quantile = (values, share) =>
  [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];

async function measure(browser, url, dimension) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  const page = await context.newPage();
  await page.addInitScript(count, { timer: TIMER_MS, dimension });
  await page.goto(`${url}#plots`);
  await page.locator(dimension === '3d' ? '.map.has-3d' : '.map:not(.has-3d)').waitFor({ timeout: 60_000 });
  await page.waitForTimeout(8000); // shaders are compiled, a level of quality is found
  const session = await context.newCDPSession(page);
  await session.send('Performance.enable', { timeDomain: 'threadTicks' });
  const busy = async () =>
    (await session.send('Performance.getMetrics')).metrics.find(({ name }) => name === 'TaskDuration').value;
  const [first, begin] = [await busy(), performance.now()];
  await page.evaluate(() => Object.assign(globalThis.counts, { repaints: 0, pictures: 0, late: [] }));
  await page.waitForTimeout(SECONDS * 1000);
  const { repaints, pictures, late } = await page.evaluate(() => globalThis.counts);
  const elapsed = (performance.now() - begin) / 1000;
  const share = ((await busy()) - first) / elapsed;
  await context.close();
  const columns = [
    dimension,
    pictures / elapsed,
    repaints / elapsed,
    quantile(late, 0.5),
    quantile(late, 0.95),
    100 * share,
  ];
  console.log(`| ${columns.map((each) => (typeof each === 'number' ? each.toFixed(0) : each)).join(' | ')} |`);
}

const browser = await launch();
const drive = await startDrive();
console.log(
  '| shown | 3D pictures a second | repaints a second | timers late, median [ms] | 95 of 100 [ms] ' +
    '| main thread, of one core [%] |\n|---|--:|--:|--:|--:|--:|',
);
for (let i = 0; i < TIMES; ++i) for (const dimension of ['2d', '3d']) await measure(browser, drive.url, dimension);
await browser.close();
await drive.stop();
