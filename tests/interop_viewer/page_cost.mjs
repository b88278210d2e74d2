// SPDX-License-Identifier: MIT
// What a page costs while it shows a run, and how old its picture is.
import { above, DashboardPage } from './dashboard_page.mjs';
import { arrivals, meter, notePaints } from './paints.mjs';

export const quantile = (values, share) =>
  [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];

/** A page of the run at `url` for so many seconds, the map shown. `meanwhile` is awaited beside. */
export async function pageCost(browser, url, tab, seconds, meanwhile = async () => undefined) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  const page = await context.newPage();
  await page.addInitScript(() => localStorage.setItem('chicane.camera', '"track"'));
  await page.addInitScript(notePaints);
  await page.goto(`${url}#${tab}`);
  await page.getByText('Live', { exact: true }).waitFor();
  const dashboard = new DashboardPage(page, []);
  await dashboard.until(dashboard.speed, above(5), 'a car that drives');
  const read = await meter(page);
  await page.waitForTimeout(3000); // the history fills, code is compiled
  const other = await arrivals(url);
  const first = await read();
  const [begin, paintsBefore] = [performance.now(), await page.evaluate(() => globalThis.paints.size)];
  await Promise.all([page.waitForTimeout(seconds * 1000), meanwhile()]);
  const elapsed = (performance.now() - begin) / 1000;
  const paints = new Map(await page.evaluate(() => [...globalThis.paints]));
  const arrived = other.times.size;
  const last = await read();
  other.close();
  await context.close();
  const ages = [...other.times].flatMap(([stamp, time]) => (paints.has(stamp) ? [paints.get(stamp) - time] : []));
  return {
    tab,
    framesPerSecond: arrived / elapsed,
    paintsPerSecond: (paints.size - paintsBefore) / elapsed,
    mainThread: (last.busy - first.busy) / elapsed, // of one core
    median: quantile(ages, 0.5), // from message to screen [ms]
    p95: quantile(ages, 0.95),
    heap: last.heap / 1e6, // [MB]
    growth: (last.heap - first.heap) / 1e6,
  };
}
