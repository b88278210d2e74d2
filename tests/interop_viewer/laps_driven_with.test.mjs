// SPDX-License-Identifier: MIT
// With what laps were driven: told by the program with each lap, in the table, in comparison, in a recording; and
// driving with a gamepad.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { startDrive, watch } from './chicane_drive.mjs';
import { atLeast, DashboardPage } from './dashboard_page.mjs';
import { browserAlone } from './here.mjs';

const here = browserAlone();

async function laps(dashboard, count) {
  await dashboard.until(dashboard.laps, atLeast(count), `${count} laps`);
}

describe('a lap', () => {
  const folder = mkdtempSync(join(tmpdir(), 'chicane-laps-'));
  const recording = join(folder, 'laps.mcap');
  let drive;
  before(async () => {
    drive = await startDrive(['--track', 'oval', '--pace', '20', '--record', recording]);
  });
  after(async () => {
    await drive.stop();
    rmSync(folder, { recursive: true });
  });

  it('remembers the settings it was driven with, for whoever looks', async () => {
    const dashboard = await DashboardPage.open(here.browser, drive.url, { mode: 'understand' });
    const { page } = dashboard;
    await laps(dashboard, 1);
    assert.equal(await page.locator('.lap-rows th', { hasText: 'Driven with' }).count(), 0, 'nothing to tell yet');
    await dashboard.show('try');
    await dashboard.type('latency_ms', 60);
    await dashboard.show('understand');
    const before = await dashboard.lapRows().count();
    await laps(dashboard, before + 2);
    await page.getByText('All laps', { exact: true }).click();
    await dashboard.lapRows().last().locator('.setup', { hasText: 'latency ms 60' }).waitFor();
    await dashboard.lapRows().last().getByRole('button').click(); // A
    await page.getByLabel('B', { exact: true }).selectOption('lap 1');
    await dashboard.until('lap-difference', /latency_ms\s+60\s+\|\s+100/, 'what differed');
    assert.deepEqual(await dashboard.accessibilityFindings(), []);
    await dashboard.close();
    const late = await DashboardPage.open(here.browser, drive.url, { mode: 'understand' });
    await laps(late, before + 2);
    await late.lapRows().last().locator('.setup', { hasText: 'latency ms 60' }).waitFor({ state: 'attached' });
    await late.close();
  });

  it('remembers them in the recording, too', async () => {
    await drive.stop();
    const page = join(folder, 'report.html');
    execFileSync(process.env.CHICANE ?? 'chicane', ['report', recording, '-o', page], { stdio: 'pipe' });
    const shown = await here.browser.newPage();
    await shown.goto(`file://${page}`);
    await shown.locator('.lap-rows .setup', { hasText: 'latency ms 60' }).first().waitFor();
    await shown.close();
  });
});

describe('a gamepad', () => {
  it('takes the wheel, drives, and hands back', async (t) => {
    const drive = await startDrive(['--track', 'oval']);
    t.after(() => drive.stop());
    const other = await watch(drive.url);
    const dashboard = await DashboardPage.open(here.browser, drive.url);
    const { page } = dashboard;
    await page.locator('#menu button:enabled', { hasText: 'Take the wheel' }).waitFor({ state: 'attached' });
    await page.evaluate(() => {
      const button = () => ({ value: 0, pressed: false, touched: false });
      const pad = { id: 'A pad', mapping: 'standard', connected: true, axes: [0, 0, 0, 0] };
      pad.buttons = Array.from({ length: 17 }, button);
      globalThis.pad = pad;
      navigator.getGamepads = () => [pad];
      dispatchEvent(new Event('gamepadconnected'));
    });
    const press = (index, value) =>
      page.evaluate(
        ([at, how]) => {
          globalThis.pad.buttons[at] = { value: how, pressed: how > 0.5, touched: how > 0 };
        },
        [index, value],
      );
    await press(9, 1);
    await page.getByText('By hand', { exact: true }).waitFor();
    await press(9, 0);
    await press(7, 1);
    await page.evaluate(() => {
      globalThis.pad.axes[0] = -1;
    });
    await dashboard.until(
      () => other.newest,
      ({ steer_applied_rad: steer, throttle_applied: throttle }) => steer > 0.005 && throttle > 0.5,
      'wheels to the left, and throttle',
    );
    await press(9, 1);
    await page.getByText('By hand', { exact: true }).waitFor({ state: 'detached' });
    other.close();
    await dashboard.close();
  });
});
