// SPDX-License-Identifier: MIT
// A page that is opened late over a slow line: the present first, the past behind it, and "Live" only when it is.
import assert from 'node:assert/strict';
import { after, before, it } from 'node:test';
import { watch } from './chicane_drive.mjs';
import { DashboardPage } from './dashboard_page.mjs';
import { browserAndDrive } from './here.mjs';
import { slowLine } from './slow_line.mjs';

const here = browserAndDrive(['--track', 'oval', '--pace', '20']);
const RATE = 64_000; // [byte/s]
const DELAY = 200; // each way [ms]
let line;
let other;

before(async () => {
  other = await watch(here.drive.url);
  line = await slowLine(here.drive.port, { rate: RATE, delay: DELAY });
});
after(() => {
  other.close();
  line.stop();
});

it('shows the newest frame within three seconds, and the past behind it', async () => {
  while (!(Number(other.newest?.time_s) > 100)) await new Promise((resolve) => setTimeout(resolve, 100));
  other.set('run.pace', 1);
  // The page itself comes from the program: what is measured is the run.
  const dashboard = await DashboardPage.open(here.browser, line.url, { tab: 'drive', state: 'Live' });
  const opened = performance.now();
  const age = async () => {
    const shown = await dashboard.seconds();
    const behind = Number(other.newest.lap_time_s) - shown;
    return behind < -1 ? 0 : behind; // the line is between them
  };
  await dashboard.until(age, (seconds) => seconds <= 1.1, 'a frame of the last second'); // the text is renewed each 0.1 s
  assert.ok(performance.now() - opened < 3000, `after ${performance.now() - opened} ms`);
  const before = line.carried.bytes;
  const from = performance.now();
  const ages = [];
  while (performance.now() - from < 5000) {
    ages.push(await age());
    await dashboard.page.waitForTimeout(250);
  }
  ages.sort((a, b) => a - b);
  assert.ok(ages.at(-2) <= 1.1, `stays there: ${ages.map((each) => each.toFixed(2)).join(' ')}`);
  const used = (line.carried.bytes - before) / (RATE * ((performance.now() - from) / 1000));
  assert.ok(used > 0.6, `the past uses the line: ${used.toFixed(2)} of it`);
  assert.equal(await dashboard.page.getByText('Live', { exact: true }).count(), 1);
  await dashboard.close();
});
