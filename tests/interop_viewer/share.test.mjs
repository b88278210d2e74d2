// SPDX-License-Identifier: MIT
// A link to a run: made on one page, opened on another program.
import assert from 'node:assert/strict';
import { after, before, it } from 'node:test';
import { startDrive } from './chicane_drive.mjs';
import { DashboardPage } from './dashboard_page.mjs';
import { browserAlone } from './here.mjs';

const here = browserAlone();

let from;
let link;
before(async () => {
  from = await startDrive(['--track', 'hairpins', '--car', 'road-car', '--seed', '7', '--set', 'latency_ms=80']);
});
after(() => from.stop());

it('is made by a button, with what was changed on the command line and on the page', async () => {
  const dashboard = await DashboardPage.open(here.browser, from.url);
  const { page } = dashboard;
  await dashboard.type('plant_options.friction_scale', 0.9);
  await dashboard.fromMenu('Share this run');
  link = await page.getByLabel('Link', { exact: true }).inputValue();
  const { hash, pathname, search } = new URL(link);
  assert.equal(pathname + search, '/', 'no token in it');
  assert.match(hash, /^#run\?track=hairpins&car=road-car&preset=default&controller=tracking-mpc&seed=7&latency_ms=80&/);
  assert.match(hash, /&plant_options\.friction_scale=0\.9$/);
  assert.equal(
    await page.getByLabel('Command', { exact: true }).inputValue(),
    'chicane drive --preset default --track hairpins --car road-car --seed 7 --set latency_ms=80 ' +
      '--set plant_options.friction_scale=0.9',
  );
  await page.getByLabel('Copy the link').click();
  await page.getByText(/^(Copied|Selected: Ctrl\+C copies it)$/).waitFor();
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  await dashboard.close();
});

it('asks once on another program, and drives the same from the start there', async (t) => {
  const to = await startDrive(['--track', 'oval', '--set', 'tracking_mpc.speed_limit_mps=20']);
  t.after(() => to.stop());
  const dashboard = await DashboardPage.open(here.browser, to.url, { mode: new URL(link).hash.slice(1) });
  const { page } = dashboard;
  const asked = page.getByTestId('wanted');
  await asked.waitFor();
  const wanted = (await asked.locator('li').allInnerTexts()).map((text) => text.replace(/\s+/g, ' '));
  for (const line of ['track oval → hairpins', 'car udacity → road-car', 'seed 1 → 7', 'latency_ms 100 → 80'])
    assert.ok(wanted.includes(line), `${line} in ${wanted.join(', ')}`);
  assert.match(await dashboard.summary(), /oval/, 'nothing before the answer');
  assert.ok(!page.url().includes('#run'), 'a reload does not ask again');
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  await dashboard.button('Drive it').click();
  await dashboard.until(dashboard.summary, /road-car · hairpins · 80 ms/, 'the run of the link');
  const limit = (await dashboard.setting('tracking_mpc.speed_limit_mps')).locator('.number-box');
  await dashboard.until(() => limit.inputValue(), '60', 'what the link does not mention, as the preset gives it');
  await dashboard.show('try');
  await dashboard.fromMenu('Share this run');
  await dashboard.until(
    () => page.getByLabel('Link', { exact: true }).inputValue(),
    (text) => new URL(text).hash === new URL(link).hash,
    'the same link again',
  );
  assert.equal(await page.getByTestId('notice').count(), 0);
  await dashboard.close();
});

it('names nothing but what the program brings along', async () => {
  const dashboard = await DashboardPage.open(here.browser, from.url);
  const { page } = dashboard;
  const before = await dashboard.summary();
  // Opened in a tab that is there already.
  await page.evaluate(() => {
    location.hash = '#run?track=%2Fetc%2Fpasswd&run.pace=20&laps=1';
  });
  await page.getByText('Left out, since a link cannot set it here: run.pace, laps.').waitFor();
  await dashboard.button('Drive it').click();
  await page.getByTestId('notice').waitFor();
  assert.match(await dashboard.text('notice'), /Track cannot be \/etc\/passwd: choose one of /);
  assert.doesNotMatch(await dashboard.text('notice'), /root:/);
  assert.equal(await dashboard.summary(), before);
  await dashboard.close();
});

it('can be declined', async () => {
  const dashboard = await DashboardPage.open(here.browser, from.url, { mode: 'run?track=oval' });
  await dashboard.button('Keep this run').click();
  await dashboard.page.getByTestId('wanted').waitFor({ state: 'detached' });
  assert.match(await dashboard.summary(), /hairpins/);
  await dashboard.close();
});
