// SPDX-License-Identifier: MIT
// A recorded run in the page: served by chicane replay with a second future beside it, and alone in a report.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, afterEach, before, describe, it } from 'node:test';
import { pathToFileURL } from 'node:url';
import { launch } from './browser.mjs';
import { startDrive, startProgram } from './chicane_drive.mjs';
import { above, atLeast, below, DashboardPage, headline } from './dashboard_page.mjs';

const program = process.env.CHICANE ?? 'chicane';
const folder = mkdtempSync(join(tmpdir(), 'chicane-recording-'));
const log = join(folder, 'run.mcap');
const future = join(folder, 'branch.mcap');
const report = join(folder, 'report.html');

let browser;
let server;
let dashboard;

before(async () => {
  const run = (...words) => execFileSync(program, words, { stdio: 'ignore' });
  run('drive', '--fast', '--laps', '2', '--record', log);
  run('replay', log, '--branch-at', '40', '--set', 'tracking_mpc.speed_limit_mps=20', '--output', future, '--json');
  run('report', log, future, '--output', report);
  server = await startProgram('replay', [log, future]);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  assert.equal(await server?.stop('SIGINT'), 0, 'Ctrl-C ends it well');
  rmSync(folder, { recursive: true });
});

/** The page once its recording is read to the end. */
async function open(address, options = {}) {
  dashboard = await DashboardPage.open(browser, address, { mode: 'understand', state: 'Recording', ...options });
  await dashboard.page.getByLabel('Looking for landmarks').waitFor({ state: 'detached' });
  return dashboard.page;
}
/** 3D drawn by the processor is said to be slow. */
const isAboutGraphics = (text) => /GPU|WebGL|GL Driver/i.test(text);
const scrub = (page, seconds) =>
  page.getByLabel('Position in the recording').evaluate((slider, value) => {
    slider.value = String(value);
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  }, seconds);
const time = (page) => page.locator('.timeline-time').innerText();

describe('a recording in the page', () => {
  let page;
  before(async () => {
    page = await open(server.url);
  });
  afterEach(() => dashboard.hadNothingToComplainOf(isAboutGraphics));
  after(() => dashboard.close(isAboutGraphics));

  it('is scrubbed, played and stepped', async () => {
    await dashboard.lapRows().nth(1).waitFor({ state: 'attached' }); // both laps, though we stand at the start
    await dashboard.show('watch');
    await scrub(page, 30);
    await dashboard.until(dashboard.speed, above(50), 'the speed of that moment');
    assert.match(await time(page), /^0:30\.00/);
    const there = await dashboard.number('speed');
    await scrub(page, 0);
    await dashboard.until(dashboard.speed, below(1), 'standstill at the start');
    await scrub(page, 30);
    await dashboard.until(dashboard.speed, there, 'the same moment again');
    await dashboard.page.locator('body').press('.');
    await dashboard.until(() => time(page), /^0:30\.0[1-9]/, 'the next control step');
    await dashboard.button('Play').click();
    await dashboard.until(() => time(page), /^0:3[2-9]/, 'it plays');
    await page.keyboard.press('Space');
    await page.getByText('Recording', { exact: true }).waitFor();
    await dashboard.button('Next landmark').click();
    await dashboard.until(() => time(page), /^0:3[4-9]|^1:/, 'the end of a lap');
  });

  it('shows both futures, each in turn', async () => {
    await scrub(page, 55);
    await dashboard.until(dashboard.speed, above(60), 'as it was driven');
    await page.getByText('branch.mcap', { exact: true }).first().waitFor({ state: 'attached' });
    await page.getByLabel('Recording shown').selectOption({ label: 'branch.mcap' });
    await dashboard.until(dashboard.speed, (mph) => mph > 20 && mph < 50, 'slower since the branch');
    assert.match(await time(page), /^0:55/);
    await page.getByLabel('Recording shown').selectOption({ label: 'run.mcap' });
    await dashboard.until(dashboard.speed, above(60), 'as it was driven, again');
  });

  it('draws laps of the other recording, and says where they lose time', async () => {
    await dashboard.show('understand');
    const choice = page.getByLabel('A', { exact: true });
    const other = 'lap 1 of branch.mcap'; // the second one was not driven to its end
    await choice.locator(`option[value="${other}"]`).waitFor({ state: 'attached' });
    await choice.selectOption(other);
    await page.getByLabel('B', { exact: true }).selectOption('lap 2');
    await dashboard.until(
      () => headline(page),
      /^Lap 1 of branch\.mcap, from standstill, lost \d+\.\d\d s to\s+lap 2\s*; T\d cost most, \d/,
      'where it loses',
    );
    assert.match(await page.getByTestId('corner-costs').locator('tr').nth(1).innerText(), /^T\d\s+\+\d+\.\d\d\s+\S/);
    assert.equal(await page.locator('.lap-plots path.b').count(), 3, 'speed, pedal and steer of the other lap');
    assert.deepEqual(await dashboard.accessibilityFindings('main'), []);
  });

  it('says what belongs to the recording and cannot be changed', async () => {
    await dashboard.show('try');
    await page.getByText('Both drive from').waitFor();
    assert.equal(await dashboard.button('This run').count(), 0);
    assert.equal(await page.locator('.choices').count(), 0);
  });
});

it('is shown when its file is dropped on a page that watches a run; what is none, is refused in words', async () => {
  const drive = await startDrive(['--track', 'oval']);
  dashboard = await DashboardPage.open(browser, drive.url, { mode: 'understand' });
  const { page } = dashboard;
  /** By a box for files, which takes a path: the bytes need not be sent to the browser. */
  async function drop(path) {
    const box = await page.evaluateHandle(() => Object.assign(document.createElement('input'), { type: 'file' }));
    await box.asElement().setInputFiles(path);
    await box.evaluate(({ files }) => {
      const data = new DataTransfer();
      data.items.add(files[0]);
      const options = { dataTransfer: data, bubbles: true, cancelable: true };
      document.body.dispatchEvent(new DragEvent('dragover', options));
      document.body.dispatchEvent(new DragEvent('drop', options));
    });
  }
  const broken = join(folder, 'broken.mcap');
  writeFileSync(broken, 'this is none');
  await drop(broken);
  await page.getByTestId('notice').waitFor();
  await page.getByText('Live', { exact: true }).waitFor();
  await drop(log);
  await page.getByText('Recording', { exact: true }).waitFor();
  await page.locator('.timeline-name', { hasText: 'run.mcap' }).waitFor();
  await dashboard.until(dashboard.laps, 2, 'both of its laps');
  assert.match(await page.locator('.run').getAttribute('title'), /lakeside/, 'not the oval of the run');
  await dashboard.close(isAboutGraphics);
  await drive.stop();
});

describe('a report', () => {
  let page;
  afterEach(() => page?.close());

  it('opens from disk, alone, small, with one sentence for each run', async () => {
    const failures = [];
    page = await browser.newPage({ viewport: { width: 1366, height: 768 } });
    page.on('pageerror', (error) => failures.push(String(error)));
    await page.goto(pathToFileURL(report).href);
    await page.getByTestId('verdict').nth(1).waitFor();
    assert.match(
      await page.getByTestId('verdict').first().innerText(),
      /^Two clean laps of lakeside\. The best took \d:\d\d\.\d{3}/,
    );
    assert.match(await headline(page), /^Lap \d.* (lost|won) \d+\.\d\d s/);
    const rows = page.getByTestId('corner-costs').locator('tbody tr');
    const most = (await rows.first().innerText()).match(/(T\d+)\s+[+−](\d+\.\d\d)/);
    assert.match(await headline(page), new RegExp(`${most[1]} (cost|gave) most, ${most[2]} s`));
    await page.getByLabel('B', { exact: true }).selectOption('lap 1');
    assert.match(await headline(page), /won .* from\s+lap 1; T\d+ gave most/s);
    const place = page.getByRole('slider', { name: 'Place along the lap' });
    const before = Number(await place.getAttribute('aria-valuenow'));
    await place.press('ArrowRight');
    assert.equal(Number(await place.getAttribute('aria-valuenow')), before + 2);
    assert.equal(await page.getByTestId('lap-rows').first().locator('tbody tr:not(.limit)').count(), 2);
    assert.match(await page.locator('pre').first().textContent(), /track: "?lakeside/);
    await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
    assert.equal(await page.locator('details:not([open])').count(), 0, 'on paper nothing is closed');
    await page.evaluate(() => dispatchEvent(new Event('afterprint')));
    assert.equal(await page.locator('details[open]').count(), 0);
    const ink = (await page.pdf()).length;
    assert.ok(ink > 30_000, `${ink} bytes of print`);
    assert.ok(statSync(report).size <= 800_000, `${statSync(report).size} bytes of two runs`);
    const fetched = /(src|href)="(?!data:|#)/; // by its reader
    assert.doesNotMatch(readFileSync(report, 'utf8').replace(/<script[\s\S]*?<\/script>/g, ''), fetched);
    assert.deepEqual(failures, []);
  });
});

it('keeps the laps of several runs in a recording apart', async () => {
  const file = join(folder, 'several.mcap');
  const drive = await startDrive(['--track', 'oval', '--pace', '20', '--record', file]);
  const live = await DashboardPage.open(browser, drive.url, { mode: 'understand' });
  await live.until(live.laps, atLeast(3), 'laps on the oval');
  await live.show('try');
  await live.page.locator('.choices').getByLabel('Track', { exact: true }).selectOption('hairpins');
  await live.page.getByRole('dialog').getByText('Restart', { exact: true }).click();
  await live.until(live.summary, /hairpins/, 'the other track');
  await live.show('understand');
  await live.until(live.laps, 1, 'a lap on the other track');
  await live.close();
  await drive.stop();
  const replay = await startProgram('replay', [file]);
  const page = await open(replay.url);
  const first = await dashboard.lapRows().count();
  assert.ok(first >= 3, `${first} laps on the oval`);
  const runs = page.getByLabel('Run of the recording');
  assert.equal(await runs.locator('option').count(), 2);
  await runs.selectOption('1');
  await dashboard.until(dashboard.summary, /hairpins/, 'the other run');
  const second = await dashboard.until(dashboard.laps, (count) => count < first && count >= 1, 'its laps only');
  assert.ok(second < first);
  await dashboard.close(isAboutGraphics);
  await replay.stop();
});
