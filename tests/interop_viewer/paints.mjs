// SPDX-License-Identifier: MIT
// When messages reach a viewer, and when a dashboard has painted them.
import foxglove from '@foxglove/ws-protocol';
import WebSocket from 'ws';

/**
 * An init script for a dashboard's page: `globalThis.paints` has the time of the clock [ms] at which each message, by
 * its time stamp, was on the screen. Of the messages that come between two repaints the newest counts.
 */
export function notePaints() {
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

/** When each frame reached a viewer that does nothing else [ms], by time stamp. */
export async function arrivals(url) {
  const socket = new WebSocket(url.replace('http', 'ws'), ['foxglove.sdk.v1']);
  const client = new foxglove.FoxgloveClient({ ws: socket });
  const times = new Map();
  client.on('advertise', (channels) => client.subscribe(channels.find(({ topic }) => topic === '/chicane/frame').id));
  client.on('message', ({ timestamp }) => times.set(String(timestamp), performance.timeOrigin + performance.now()));
  await new Promise((resolve) => client.on('open', resolve));
  return { times, close: () => socket.terminate() };
}

/**
 * Processor time of a page's main thread [s] and its heap [bytes] after a collection: Chromium's TaskDuration and
 * JSHeapUsedSize.
 */
export async function meter(page) {
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable', { timeDomain: 'threadTicks' });
  return async () => {
    await session.send('HeapProfiler.collectGarbage');
    const { metrics } = await session.send('Performance.getMetrics');
    const { TaskDuration, JSHeapUsedSize } = Object.fromEntries(metrics.map(({ name, value }) => [name, value]));
    return { busy: TaskDuration, heap: JSHeapUsedSize };
  };
}

/** Options of `chicane drive` for sixty frames a second. */
export const SIXTY_A_SECOND = ['--set', 'control_period_ms=16', '--set', 'tracking_mpc.horizon_steps=10'];
