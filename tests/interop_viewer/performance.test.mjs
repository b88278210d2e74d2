// SPDX-License-Identifier: MIT
// What the dashboard costs at sixty frames a second: main thread, memory, and how old a picture is.
//   node --test performance.test.mjs   with CHICANE set to the program; SECONDS=60 measures longer.
import assert from 'node:assert/strict';
import { after, before, it } from 'node:test';
import foxglove from '@foxglove/ws-protocol';
import WebSocket from 'ws';
import { launch } from './browser.mjs';
import { startDrive } from './chicane_drive.mjs';
import { DashboardPage } from './dashboard_page.mjs';

const SECONDS = Number(process.env.SECONDS ?? 8);
const MAIN_THREAD_SHARE = 0.5; // of one core, in processor time: what docs/viewer.md promises
const MESSAGE_TO_SCREEN_MS = 100;

let browser;
let drive;
before(async () => {
  browser = await launch();
  drive = await startDrive(['--set', 'control_period_ms=16', '--set', 'tracking_mpc.horizon_steps=10']);
});
after(async () => {
  await browser.close();
  await drive.stop();
});

/** In the page: the time of the clock at which each message, by its time stamp, was on the screen. */
function notePaints() {
  globalThis.paints = new Map();
  let newest = null;
  globalThis.WebSocket = class extends WebSocket {
    constructor(...options) {
      super(...options);
      this.addEventListener('message', ({ data }) => {
        if (!(data instanceof ArrayBuffer)) return;
        const view = new DataView(data);
        if (view.getUint8(0) !== 1) return;
        const isFirst = newest === null;
        newest = String(view.getBigUint64(5, true));
        if (!isFirst) return;
        requestAnimationFrame(() => {
          const stamp = newest;
          newest = null;
          // After this frame's callbacks, style, layout and paint.
          const { port1, port2 } = new MessageChannel();
          port1.onmessage = () => globalThis.paints.set(stamp, performance.timeOrigin + performance.now());
          port2.postMessage(null);
        });
      });
    }
  };
}

/** When each message reached another client of the same server, by time stamp. */
async function arrivals(url) {
  const socket = new WebSocket(url.replace('http', 'ws'), ['foxglove.sdk.v1']);
  const client = new foxglove.FoxgloveClient({ ws: socket });
  const times = new Map();
  client.on('advertise', (channels) => client.subscribe(channels.find(({ topic }) => topic === '/chicane/frame').id));
  client.on('message', ({ timestamp }) => times.set(String(timestamp), performance.timeOrigin + performance.now()));
  await new Promise((resolve) => client.on('open', resolve));
  return { times, close: () => socket.terminate() };
}

const quantile = (values, share) =>
  values.sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];

for (const tab of ['plots', 'explain']) {
  it(`shows 60 frames a second within bounds, ${tab}`, async (test) => {
    const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
    const page = await context.newPage();
    await page.addInitScript(() => localStorage.setItem('chicane.dimension', '"2d"'));
    await page.addInitScript(notePaints);
    await page.goto(`${drive.url}#${tab}`);
    await page.getByText('Live', { exact: true }).waitFor();
    const dashboard = new DashboardPage(page, []);
    await dashboard.until(
      () => dashboard.number('speed'),
      (mph) => mph > 5,
      'a car that drives',
    );
    const other = await arrivals(drive.url);
    const session = await context.newCDPSession(page);
    await session.send('Performance.enable', { timeDomain: 'threadTicks' });
    const metrics = async () => {
      await session.send('HeapProfiler.collectGarbage');
      const { metrics: all } = await session.send('Performance.getMetrics');
      return Object.fromEntries(all.map(({ name, value }) => [name, value]));
    };
    await page.waitForTimeout(3000); // rings fill, code is compiled
    const first = await metrics();
    const [before, paintsBefore] = [performance.now(), await page.evaluate(() => globalThis.paints.size)];
    await page.waitForTimeout(SECONDS * 1000);
    const elapsed = (performance.now() - before) / 1000;
    const paints = new Map(await page.evaluate(() => [...globalThis.paints]));
    const last = await metrics();
    other.close();
    await context.close();

    const share = (last.TaskDuration - first.TaskDuration) / elapsed;
    const frames = other.times.size / (elapsed + 3);
    const ages = [...other.times].flatMap(([stamp, arrived]) =>
      paints.has(stamp) ? [paints.get(stamp) - arrived] : [],
    );
    const growth = (last.JSHeapUsedSize - first.JSHeapUsedSize) / 1e6;
    test.diagnostic(
      `${tab}: ${frames.toFixed(0)} frames/s arrive, ${((paints.size - paintsBefore) / elapsed).toFixed(0)}/s painted` +
        `, main thread ${(share * 100).toFixed(0)} %, message to screen p50 ${quantile(ages, 0.5)?.toFixed(0)} ms, ` +
        `p95 ${quantile(ages, 0.95)?.toFixed(0)} ms, heap ${(last.JSHeapUsedSize / 1e6).toFixed(1)} MB ` +
        `${growth >= 0 ? '+' : ''}${growth.toFixed(2)} MB`,
    );
    assert.ok(frames > 30, `${frames} frames/s`);
    assert.ok(share < MAIN_THREAD_SHARE, `main thread ${share}`);
    assert.ok(quantile(ages, 0.5) < MESSAGE_TO_SCREEN_MS, `message to screen ${quantile(ages, 0.5)} ms`);
    // The samples of laps and plots are there from the start.
    assert.ok(growth < 3, `${growth} MB more after ${elapsed} s`);
  });
}
