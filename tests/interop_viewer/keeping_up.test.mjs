// SPDX-License-Identifier: MIT
// The dashboard keeps up with sixty frames a second. What that costs is measured by measure.mjs, not asserted here.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { atLeast, DashboardPage, EVERY_SIZE } from './dashboard_page.mjs';
import { browserAndDrive } from './here.mjs';
import { arrivals, meter, notePaints, SIXTY_A_SECOND } from './paints.mjs';

const FRAMES = 200;

const here = browserAndDrive(SIXTY_A_SECOND);

for (const mode of EVERY_SIZE ? ['watch', 'understand'] : ['understand']) {
  it(`paints the newest of many frames, in bounded memory: ${mode}`, async () => {
    const options = { mode, fluent: true, script: notePaints };
    const dashboard = await DashboardPage.open(here.browser, here.drive.url, options);
    const { page } = dashboard;
    const paints = () => page.evaluate(() => [...globalThis.paints.keys()]);
    const read = await meter(page);
    await dashboard.until(paints, ({ length }) => length > 60, 'first pictures'); // code is compiled
    const { heap } = await read();

    const other = await arrivals(here.drive.url);
    await dashboard.until(() => other.times.size, atLeast(FRAMES), 'frames at another viewer');
    const newest = BigInt([...other.times.keys()].at(-1));
    const painted = await dashboard.until(
      paints,
      (stamps) => stamps.some((stamp) => BigInt(stamp) >= newest),
      'the picture of the newest frame',
    );
    assert.ok(
      painted.some((stamp) => other.times.has(stamp)),
      'the page paints what the other viewer gets',
    );
    const growth = ((await read()).heap - heap) / 1e6;
    other.close();
    await dashboard.close();
    assert.ok(growth < 3, `${growth} MB more after ${FRAMES} frames`); // what is kept has its memory from the start
  });
}
