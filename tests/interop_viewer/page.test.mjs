// SPDX-License-Identifier: MIT
// The page that needs no program (CHICANE_PAGE: the file that tools/build_page.sh wrote), opened from the disk.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { describe, it } from 'node:test';
import { pathToFileURL } from 'node:url';
import { promisify } from 'node:util';
import { above, below, DashboardPage, PHONE } from './dashboard_page.mjs';
import { browserAlone } from './here.mjs';

const url = pathToFileURL(process.env.CHICANE_PAGE ?? 'index.html').href;
const here = browserAlone();

/** What the program's own run gives with the arithmetic that WebAssembly has. */
async function programHash(...args) {
  const { stdout } = await promisify(execFile)(process.env.CHICANE, ['drive', '--fast', '--json', ...args], {
    env: { ...process.env, CHICANE_SIMD: 'baseline' },
  });
  return JSON.parse(stdout).state_hash;
}

describe('the page that needs no program', () => {
  it('drives the run of the program, bit for bit, at twenty times the pace', async () => {
    const dashboard = await DashboardPage.open(here.browser, url);
    await dashboard.type('run.pace', 20);
    await dashboard.show('watch');
    const card = dashboard.page.getByTestId('end-card');
    await card.waitFor();
    assert.equal(await dashboard.text('end-title'), 'Finished');
    assert.equal(await dashboard.text('end-laps'), '3');
    assert.equal(await dashboard.text('state-hash'), await programHash());
    await dashboard.close();
  });

  it('takes another track and other settings, and gives that run', async () => {
    const dashboard = await DashboardPage.open(here.browser, url, { mode: 'try' });
    await dashboard.page.locator('.choices').getByLabel('Track', { exact: true }).selectOption('oval');
    await dashboard.button('Restart').click();
    await dashboard.type('run.pace', 20);
    await dashboard.show('watch');
    await dashboard.page.getByTestId('end-card').waitFor();
    assert.equal(await dashboard.text('state-hash'), await programHash('--track', 'oval'));
    await dashboard.close();
  });

  it('pauses, steps, begins again, breaks and mends', async () => {
    const dashboard = await DashboardPage.open(here.browser, url, { mode: 'try' });
    await dashboard.until(dashboard.seconds, above(1), 'it drives');
    await dashboard.pause();
    const time = await dashboard.seconds();
    await dashboard.page.locator('body').press('.');
    await dashboard.until(dashboard.seconds, above(time), 'a step');
    await dashboard.startAgain();
    await dashboard.until(dashboard.seconds, below(time), 'the start');
    await dashboard.resume();
    await dashboard.show('try');
    await dashboard.page.locator('.fault').first().click();
    await dashboard.page.locator('.events li').first().waitFor();
    await dashboard.close();
  });

  it('shows a phone the same, with nothing beyond its edge and nothing for axe', async () => {
    const dashboard = await DashboardPage.open(here.browser, url, PHONE);
    assert.deepEqual(await dashboard.accessibilityFindings(), []);
    assert.ok((await dashboard.overflow()).across <= 0);
    await dashboard.close();
  });
});
