// SPDX-License-Identifier: MIT
// Two settings as two cars on one stage: begun, followed, and the winner kept with one click.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { DashboardPage, headline } from './dashboard_page.mjs';
import { browserAndDrive } from './here.mjs';

const here = browserAndDrive(['--track', 'oval', '--preset', 'pid', '--set', 'pid.speed_reference_mps=20']);

const race = async () => (await fetch(new URL('rival.json', here.drive.url))).json();

it('drives a second car with other settings beside the run, tells where it gains, and keeps the winner', async () => {
  const dashboard = await DashboardPage.open(here.browser, here.drive.url, { mode: 'try' });
  const { page } = dashboard;
  await dashboard.type('run.pace', 20);
  assert.ok(await dashboard.button('Race A against B').isDisabled(), 'nothing to race with');
  await dashboard.aimAt('second');
  await dashboard.type('pid.speed_reference_mps', 24);
  await dashboard.button('Race A against B').click();
  await dashboard.until(
    async () => (await page.getByTestId('race-verdict').count()) === 1 && dashboard.text('race-verdict'),
    /^Lap ([2-9]|\d\d): B is \d+\.\d{3} s faster\.$/,
    'two laps of both cars',
  );
  await dashboard.button('Pause').click(); // of each car the newest 16 laps are kept: few seconds at this pace
  await page.locator('.line-key', { hasText: /^B$/ }).waitFor(); // the ghost on the picture
  await dashboard.show('understand');
  await page.getByLabel('B', { exact: true }).selectOption('lap 2 of B, the ghost');
  await dashboard.until(() => headline(page), /lost \d+\.\d\d s to\s+lap 2 of B, the ghost\s*;/, 'where B gains');
  await dashboard.show('try');
  await dashboard.resume();
  const { run, rival } = await race();
  assert.ok(rival[0].lap_time_s < run[0].lap_time_s - 1);
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  // A page that comes later shows the race, too.
  const late = await DashboardPage.open(here.browser, here.drive.url, { mode: 'try' });
  await late.page.getByTestId('race').waitFor();
  await late.close();
  await page.getByRole('button', { name: 'Keep B, the winner' }).click();
  await page.getByTestId('race').waitFor({ state: 'detached' });
  assert.equal((await race()).state, 'none');
  await dashboard.aimAt('run');
  await dashboard.until('changes', /pid\.speed_reference_mps\s+20\s+→\s+24/, 'the setting of the winner');
  await dashboard.close();
});

it('says why a setting cannot be raced with', async () => {
  const dashboard = await DashboardPage.open(here.browser, here.drive.url, { mode: 'try' });
  await dashboard.aimAt('second');
  await dashboard.type('latency_ms', 60);
  await dashboard.button('Race A against B').click();
  await dashboard.page.getByRole('alert').filter({ hasText: 'a setting of the controller or its car' }).waitFor();
  await dashboard.close();
});
