// SPDX-License-Identifier: MIT
// Another future of a live run and of a recording, asked for and compared in the page.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { startDrive, startProgram } from './chicane_drive.mjs';
import { above, DashboardPage, headline, PHONE } from './dashboard_page.mjs';
import { browserAlone } from './here.mjs';

const SPEED = 'tracking_mpc.speed_limit_mps';

const here = browserAlone();

/** Asks for another future with a lower speed limit, and waits for the answer. */
async function askForLess(dashboard, limit = 15) {
  const { page } = dashboard;
  const second = page.getByRole('button', { name: 'A second car' });
  if (await second.count()) await second.click();
  await dashboard.type(SPEED, limit);
  await page.getByText('Drive both', { exact: true }).click();
  await page.getByTestId('what-if-verdict').waitFor();
}
const verdict = (dashboard) => dashboard.text('what-if-verdict');

describe('what if, in a live run', () => {
  let drive;
  let dashboard;
  before(async () => {
    drive = await startDrive(['--track', 'oval', '--pace', '4']);
    dashboard = await DashboardPage.open(here.browser, drive.url, { mode: 'try' });
    await dashboard.until(dashboard.speed, above(60), 'a car that drives');
    await dashboard.pause();
  });
  after(async () => {
    await dashboard.close();
    await drive.stop();
  });

  it('drives both futures from now on, and sets them side by side', async () => {
    const { page } = dashboard;
    await page.getByLabel('For how long').selectOption('30');
    await askForLess(dashboard);
    assert.match(await verdict(dashboard), /^speed limit 15.*: \d+\.\d\d s slower to the same place, .* edge/i);
    assert.deepEqual(await dashboard.accessibilityFindings(), []);
    await dashboard.button('Compare').click();
    await dashboard.until(
      () => headline(page),
      /^(Lap \d+ a|A)s it is won \d+\.\d\d s from (lap \d+ )?with speed limit mps 15[.;]/,
      'both futures along the road',
    );
    assert.equal(await page.locator('.lap-plots path.b').count(), 3, 'speed, pedal and steer of the other future');
    await dashboard.show('try');
  });

  it('shows both cars on the picture', async () => {
    const { page } = dashboard;
    await dashboard.button('Watch both').click();
    await page.getByText(/^Replay, \d+ s left$/).waitFor();
    await page.locator('.line-key', { hasText: 'what if' }).waitFor();
    await dashboard.button('End watching').click();
    await dashboard.button('Watch both').waitFor();
  });

  it('drives the lap from the line with both settings, and says what cannot be', async () => {
    const { page } = dashboard;
    await page.getByLabel('From when').selectOption('line');
    await page.getByLabel('For how long').selectOption('lap');
    await askForLess(dashboard, 25);
    const slower = /^speed limit 25.*: \d+\.\d\d s slower to the same place/i;
    await dashboard.until(() => verdict(dashboard), slower, 'an answer from the line on');
    await dashboard.type(SPEED, 9999);
    await page.getByText('Drive both', { exact: true }).click();
    await page.locator('main [role="alert"]', { hasText: /Speed limit cannot be 9999: choose / }).waitFor();
  });

  it('keeps the winner with one click', async () => {
    const { page } = dashboard;
    await askForLess(dashboard, 25);
    await page.locator('main [role="alert"]').waitFor({ state: 'detached' });
    await dashboard.button('Keep the change').click();
    await dashboard.button('Kept').waitFor();
    await dashboard.aimAt('run');
    await dashboard.until('changes', /1 change.*speed_limit_mps.*25/s, 'the change');
    await dashboard.show('try');
    await dashboard.startAgain();
    await page.getByTestId('what-if-verdict').waitFor({ state: 'detached' });
  });
});

it('another future of a recording begins at the moment that is shown', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'chicane-what-if-'));
  const log = join(folder, 'run.mcap');
  const words = ['drive', '--fast', '--track', 'oval', '--laps', '2', '--record', log];
  execFileSync(process.env.CHICANE, words, { stdio: 'ignore' });
  const replay = await startProgram('replay', [log]);
  const options = { ...PHONE, mode: 'try', state: 'Recording' };
  const dashboard = await DashboardPage.open(here.browser, replay.url, options);
  const { page } = dashboard;
  await page.getByLabel('Position in the recording').evaluate((slider) => {
    slider.value = '10';
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  });
  await dashboard.until(dashboard.speed, above(40), 'the speed of that moment');
  await page.getByLabel('For how long').selectOption('10');
  await askForLess(dashboard);
  assert.match(await verdict(dashboard), /slower/);
  assert.equal(await dashboard.button('Keep the change').count(), 0, 'a recording stays as it is');
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  assert.ok((await dashboard.overflow()).across <= 0);
  await dashboard.close((each) => /GPU|WebGL|GL Driver/i.test(each));
  await replay.stop();
  rmSync(folder, { recursive: true });
});

describe('what if, of a car that another program simulates', () => {
  /** `serve` and a simulator that drives to it. */
  async function startServed(...args) {
    const serve = await startProgram('serve', args);
    const address = `ws://127.0.0.1:${serve.port}/socket.io/?EIO=4&transport=websocket`;
    const words = ['simulate', '--connect', address, '--track', 'oval', '--laps', '0'];
    const simulator = spawn(process.env.CHICANE, words, { stdio: 'ignore' });
    return {
      ...serve,
      async stop() {
        simulator.kill('SIGINT');
        await once(simulator, 'exit');
        await serve.stop();
      },
    };
  }

  it('is driven by our own car, and the answer says so, and how far that is to be trusted', async () => {
    // Slow enough for a controller that a busy machine asks late.
    const served = await startServed('--track', 'oval', '--set', `${SPEED}=20`);
    const dashboard = await DashboardPage.open(here.browser, served.url, { mode: 'try' });
    const { page } = dashboard;
    await dashboard.until(dashboard.speed, above(20), 'a car that drives');
    await dashboard.button('Drive both').waitFor();
    assert.equal(await dashboard.button('Race A against B').count(), 0, 'there is no second car of theirs');
    await page.getByLabel('For how long').selectOption('10');
    await askForLess(dashboard);
    assert.match(await verdict(dashboard), /s slower to the same place/);
    assert.match(
      await page.locator('.answer').innerText(),
      /Both futures are driven by our own car \(udacity\).*from the same place, it came up to \d+\.\d\d m from yours/,
    );
    assert.deepEqual(await dashboard.accessibilityFindings(), []);
    await dashboard.close();
    await served.stop();
  });

  it('is not there without the road, and the page says what would help', async () => {
    const served = await startServed();
    const dashboard = await DashboardPage.open(here.browser, served.url, { mode: 'try' });
    await dashboard.page.getByText('chicane serve --track FILE').waitFor();
    assert.equal(await dashboard.button('Drive both').count(), 0);
    await dashboard.close();
    await served.stop();
  });
});
