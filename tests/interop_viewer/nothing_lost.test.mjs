// SPDX-License-Identifier: MIT
// What a page knows of a run, whenever it was opened, and when the run is over: laps, plots, changes, settings, end.
import assert from 'node:assert/strict';
import { after, before, describe, it } from 'node:test';
import { startDrive } from './chicane_drive.mjs';
import { above, atLeast, DashboardPage, differentFrom, headline } from './dashboard_page.mjs';
import { browserAlone } from './here.mjs';

const here = browserAlone();

const isAboutSocket = (text) =>
  text.startsWith('WebSocket connection to') || /ERR_CONNECTION_(REFUSED|RESET)/.test(text);
const open = (drive, mode, state = 'Live') => DashboardPage.open(here.browser, drive.url, { mode, state });

describe('a page that is opened late', () => {
  let drive;
  let first;
  before(async () => {
    drive = await startDrive(['--track', 'oval']);
    first = await open(drive, 'try');
    await first.type('latency_ms', 60);
    await first.type('run.pace', 5); // faster, a busy program would leave out too much of a lap to compare it
    await first.show('understand');
    await first.until(first.laps, atLeast(2), 'two laps');
    await first.show('try');
    await first.type('run.pace', 1);
    await first.pause();
  });
  after(async () => {
    await first.close();
    await drive.stop();
  });

  it('shows plots, compares laps that it has not seen, and knows the changes', async () => {
    const late = await open(drive, 'understand', 'Paused');
    await late.showEngineer();
    await late.until(
      () => late.colours('.plot[aria-label="Lateral error"] canvas'),
      above(8),
      'a plot of the last minute',
    );
    await late.page.getByText('60 s', { exact: true }).click();
    await late.until(() => headline(late.page), /^Lap \d.* (lost|won) \d+\.\d\d s/s, 'two laps along the track');
    await late.show('try');
    await late.page.locator('.events li', { hasText: 'latency_ms set to 60' }).waitFor();
    await late.close();
  });

  it('shows the same settings as changed, and how they were at the start', async () => {
    const late = await open(drive, 'try', 'Paused');
    await late.until('changes', /1\s+change.*latency_ms\s+100\s+→\s+60/s, 'the change of before');
    await late.button('Reset latency_ms').click();
    await late.page.getByText('No changes').waitFor();
    await first.show('try');
    await first.page.getByText('No changes').waitFor();
    await late.close();
  });
});

describe('the end of a run', () => {
  it('is told, with all laps, the gap and the last seconds once more', async () => {
    const drive = await startDrive(['--track', 'oval', '--laps', '2']);
    const dashboard = await open(drive, 'try');
    const { page } = dashboard;
    await dashboard.type('run.pace', 20); // not before the page is there: the run must not end earlier
    await dashboard.show('watch');
    await page.getByTestId('end-card').waitFor();
    assert.equal(await dashboard.text('end-title'), 'Finished');
    await dashboard.until('end-laps', '2', 'both laps'); // the table follows its laps a moment later
    await dashboard.show('understand');
    await dashboard.until(dashboard.laps, 2, 'the last lap, too');
    await dashboard.show('watch');
    await page.getByText('Program ended', { exact: true }).waitFor();
    assert.equal(await page.getByTestId('banner').count(), 0, 'nothing is wrong');
    assert.match(await page.locator('.again code').innerText(), /^chicane drive --preset \S+ --track oval/);
    await page.getByText('Replay the last 10 s').click();
    await page.getByText(/^Replay, \d+ s left$/).waitFor();
    const first = await dashboard.seconds();
    await dashboard.until(() => dashboard.seconds(), differentFrom(first), 'the lap clock of the last seconds');
    await page.getByText('End the replay').click();
    await page.getByTestId('end-card').waitFor();
    assert.deepEqual(await dashboard.accessibilityFindings(), []);
    await dashboard.close(isAboutSocket);
    await drive.stop();
  });

  it('tells a stop from a crash', async () => {
    for (const [signal, title] of [
      ['SIGTERM', 'Stopped'],
      ['SIGKILL', 'Connection lost'],
    ]) {
      const drive = await startDrive(['--track', 'oval']);
      const dashboard = await open(drive, 'try');
      await drive.stop(signal);
      await dashboard.until('end-title', title, title);
      await dashboard.close(isAboutSocket);
    }
  });

  it('of the program is not the end of the choice that was driven', async () => {
    let drive = await startDrive(['--track', 'oval', '--car', 'road-car']);
    const dashboard = await open(drive, 'try');
    const { port } = drive;
    await drive.stop();
    drive = await startDrive([], port);
    await dashboard.page.getByTestId('other-run').waitFor();
    assert.match(await dashboard.text('other-run'), /road-car on oval/);
    await dashboard.button('Drive that again').click();
    await dashboard.until(dashboard.summary, /road-car · oval/, 'what was driven before');
    assert.equal(await dashboard.page.getByTestId('other-run').count(), 0);
    await dashboard.close(isAboutSocket);
    await drive.stop();
  });
});
