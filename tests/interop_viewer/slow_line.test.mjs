// SPDX-License-Identifier: MIT
// A page that is opened late over a slow line: the present first, the past behind it, and "Live" only when it is.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { watch } from './chicane_drive.mjs';
import { DashboardPage } from './dashboard_page.mjs';
import { browserAndDrive } from './here.mjs';
import { slowLine } from './slow_line.mjs';

const PACE = 5;
const here = browserAndDrive(['--track', 'oval', '--pace', String(PACE)]);
const RATE = 64_000; // [byte/s]
const DELAY = 200; // each way [ms]

it('shows the newest frame within three seconds, and the past behind it', async (test) => {
  const other = await watch(here.drive.url);
  const line = await slowLine(here.drive.port, { rate: RATE, delay: DELAY });
  test.after(() => {
    other.close();
    line.stop();
  });
  while (!(Number(other.newest?.time_s) > 50)) await new Promise((resolve) => setTimeout(resolve, 100));
  // The page itself comes from the program: what is measured is the run.
  const dashboard = await DashboardPage.open(here.browser, line.url, { mode: 'try', state: 'Live' });
  const opened = performance.now();
  /** Of what the page shows, by the clock [s]. */
  const age = async () => {
    const asked = Number(other.newest.lap_time_s);
    const shown = await dashboard.seconds();
    const { lap_time_s: answered, last_lap_time_s: lap } = other.newest;
    // The page was read between both.
    const now = answered < asked ? Number(answered) : (asked + Number(answered)) / 2;
    const behind = now - shown;
    return (behind < -PACE ? behind + Number(lap) : behind) / PACE; // the line may be between them
  };
  // The text is renewed ten times a second.
  await dashboard.until(age, (seconds) => seconds <= 1.1, 'a frame of the last second');
  assert.ok(performance.now() - opened < 3000, `after ${performance.now() - opened} ms`);
  const before = line.carried.bytes;
  const from = performance.now();
  const ages = [];
  while (performance.now() - from < 5000) {
    ages.push(await age());
    await dashboard.page.waitForTimeout(250);
  }
  ages.sort((a, b) => a - b);
  const told = ages.map((each) => each.toFixed(2)).join(' ');
  assert.ok(ages[Math.floor(ages.length / 2)] <= 1, `of the last second, half of the time and more: ${told}`);
  assert.ok(ages.at(-1) <= 3, `and not much older beside busy programs: ${told}`);
  const used = (line.carried.bytes - before) / (RATE * ((performance.now() - from) / 1000));
  assert.ok(used > 0.3, `the past uses the line: ${used.toFixed(2)} of it`);
  assert.equal(await dashboard.page.getByText('Live', { exact: true }).count(), 1);
  await dashboard.close();
});
