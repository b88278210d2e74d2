// SPDX-License-Identifier: MIT
// The workbench on a real run: chicane drive with its controller and simulator, changed, driven and broken from the
// page.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, afterEach, before, beforeEach, describe, it } from 'node:test';
import { watch } from './chicane_drive.mjs';
import { above, atLeast, DashboardPage } from './dashboard_page.mjs';
import { browserAndDrive } from './here.mjs';

const here = browserAndDrive(['--track', 'lakeside']);
let dashboard;
let page;

async function open(mode) {
  dashboard = await DashboardPage.open(here.browser, here.drive.url, { mode });
  page = dashboard.page;
}

const setting = (key) => page.locator(`.sliders [data-key="${key}"]`);
const choice = (label) => page.locator('.choices').getByLabel(label, { exact: true });
const box = (key) => setting(key).locator('.number-box');
/** The settings that the program itself has: the page shows at once what it has only asked for. */
const settingsOfTheRun = async () => (await page.request.get(new URL('preset.yaml', here.drive.url).href)).text();
const equals = (value) => (now) => now === value;
const type = (key, value) => dashboard.type(key, value);
/** The last frame before a pause with much throttle. A busy machine may pause late, at full speed: again, then. */
async function pauseWhileItGathersSpeed(other) {
  for (;;) {
    await dashboard.pause();
    await dashboard.startAgain();
    await dashboard.until(dashboard.speed, 0, 'a car at the start');
    await dashboard.resume();
    await dashboard.until(dashboard.speed, above(15), 'a car that gathers speed');
    await dashboard.pause();
    const last = await dashboard.settled(() => other.newest);
    if (last.throttle_asked > 0.5) return last;
    await dashboard.resume();
  }
}
async function download(name) {
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByText(name, { exact: true }).click()]);
  return { name: file.suggestedFilename(), content: readFileSync(await file.path()) };
}

describe('the workbench', () => {
  before(() => open('try'));
  beforeEach(async () => {
    await dashboard.beginAt('try');
    await page.locator('#search').fill('');
    await page.evaluate(() => document.activeElement.blur());
  });
  afterEach(() => dashboard.hadNothingToComplainOf());
  after(() => dashboard.close());

  it('changes the command from the next control step on', async () => {
    const other = await watch(here.drive.url);
    const before = await pauseWhileItGathersSpeed(other);
    await dashboard.show('try');
    await type('tracking_mpc.speed_limit_mps', 3);
    await dashboard.fromMenu('One step');
    await dashboard.until(
      () => other.newest.cycle,
      (cycle) => cycle > before.cycle,
      'one control step',
    );
    const change = await dashboard.until(
      () => other.changes.find(({ name }) => name === 'tracking_mpc.speed_limit_mps'),
      Boolean,
      'the change',
    );
    assert.equal(change.cycle, before.cycle + 1n, 'applied before the next step');
    assert.equal(other.frames.get(change.cycle).cycle, other.newest.cycle);
    assert.ok(
      other.newest.throttle_asked < before.throttle_asked - 0.2,
      `throttle ${before.throttle_asked}, then ${other.newest.throttle_asked}`,
    );
    assert.match(await dashboard.text('changes'), /tracking_mpc\.speed_limit_mps.*3/s);
    await dashboard.button('Reset all').click();
    await page.getByText('No changes').waitFor();
    await dashboard.resume();
    other.close();
  });

  it('moves sliders with the keyboard, and says what they do', async () => {
    const slider = setting('latency_ms').locator('input[type="range"]');
    const value = async () => Number(await box('latency_ms').inputValue());
    const first = await value();
    const before = await settingsOfTheRun();
    await slider.focus();
    for (let i = 0; i < 10; ++i) await page.keyboard.press('ArrowRight');
    await dashboard.until(value, (now) => now > first, 'latency');
    await setting('latency_ms').getByRole('button', { name: 'Reset Delay' }).click();
    await dashboard.until(value, equals(first), 'latency as it started');
    await dashboard.until(settingsOfTheRun, equals(before), 'the settings as they were');
  });

  it('snaps back what is refused, and shows the sentence', async () => {
    const first = await box('latency_ms').inputValue();
    const before = await settingsOfTheRun();
    await type('latency_ms', 9999);
    await setting('latency_ms').getByRole('alert').waitFor();
    assert.match(
      await setting('latency_ms').getByRole('alert').innerText(),
      /Latency cannot be 9999: choose 0 to 500 ms\./,
    );
    assert.equal(await box('latency_ms').inputValue(), first);
    await type('latency_ms', Number(first) + 1);
    await setting('latency_ms').getByRole('alert').waitFor({ state: 'detached' });
    await type('latency_ms', first);
    await dashboard.until(settingsOfTheRun, equals(before), 'the settings as they were');
  });

  it('finds tunables by words, and saves them as a preset', async () => {
    await dashboard.show('try');
    await page.keyboard.press('/');
    await page.locator('#search:focus').waitFor();
    await page.keyboard.type('squared lateral');
    const found = await page.locator('.sliders .setting').evaluateAll((all) => all.map((each) => each.dataset.key));
    assert.ok(found.includes('tracking_mpc.weight_lateral') && found.every((key) => /weight/.test(key)), found.join());
    const before = await box('tracking_mpc.weight_lateral').inputValue();
    await type('tracking_mpc.weight_lateral', 7);
    await dashboard.until('changes', /1 change/, 'the list of changes');
    await page.locator('.name').click();
    const preset = await download('Keep these settings as a preset');
    await page.keyboard.press('Escape');
    assert.match(preset.content.toString(), /weight_lateral: 7/);
    await type('tracking_mpc.weight_lateral', before);
    await page.getByText('No changes').waitFor();
  });

  it('gives a fault the duration and strength that are asked for, and counts down', async () => {
    await dashboard.show('try');
    await page.getByText(/how long and how strong$/).click();
    const groups = await page.locator('.fault-group h3').allInnerTexts();
    assert.equal(groups.join(', '), 'Sensors, Link, Actuators, Road and wind, Computer');
    const duration = page.getByLabel('Duration of ice patch [s]');
    await duration.fill('300');
    await page.waitForTimeout(600); // the page is drawn again
    assert.equal(await duration.inputValue(), '300', 'what is typed stays while the car drives');
    await page.getByLabel(/^Strength of ice patch/).fill('0.9');
    await page.locator('button[data-key="fault.ice_patch"]').click();
    const badge = page.locator('button.fault[aria-pressed="true"] .left');
    const left = async () => Number(/(\d+\.\d) s left/.exec((await badge.allInnerTexts()).join())?.[1]);
    const first = await dashboard.until(left, (seconds) => seconds > 100 && seconds <= 300, 'a countdown');
    await dashboard.until(left, (seconds) => seconds < first - 1, 'less time left');
    await page.locator('.pill', { hasText: /Ice patch, \d+ s left/ }).waitFor();
    await page.locator('.events li', { hasText: 'Fault' }).first().waitFor();
    assert.match(await dashboard.text('fault-answer'), /What is done about it: \S+/);
    assert.deepEqual(await dashboard.accessibilityFindings('main', 'all'), []); // with the marks of a fault
    await dashboard.button('Clear all').click();
    await page.locator('button.fault[aria-pressed="true"]').waitFor({ state: 'detached' });
    await page.locator('.pill', { hasText: 's left' }).waitFor({ state: 'detached' });
  });

  it('explains what limits the speed', async () => {
    await dashboard.showEngineer();
    await page.locator('.rows dd', { hasText: /^(Grip|Brakes|Full throttle|Rolls|Part throttle)/ }).waitFor();
    assert.ok((await page.locator('.constraints tbody tr').count()) > 3);
  });

  it('shows the plan of a second ago and the path driven since, when asked to', async () => {
    await dashboard.show('watch');
    const line = page.locator('.line-key.past');
    assert.equal(await line.count(), 0);
    await page.locator('body').press('o');
    await line.waitFor();
    assert.deepEqual(await dashboard.accessibilityFindings('.stage'), []);
    await page.locator('body').press('o');
    await line.waitFor({ state: 'detached' });
  });

  it('tells speeds in the unit of the reader, and remembers it', async () => {
    await dashboard.show('watch');
    const unit = page.locator('.speed .unit');
    await dashboard.until(() => unit.innerText(), equals('mph'), 'the first unit');
    await page.locator('body').press('u');
    await dashboard.until(() => unit.innerText(), equals('km/h'), 'the next one');
    await page.reload();
    await dashboard.until(() => unit.innerText(), equals('km/h'), 'the same unit after a reload');
    await page.getByText('Live', { exact: true }).waitFor();
  });

  it('restarts with another track, after asking once', async () => {
    const summary = () => dashboard.summary();
    await choice('Track').selectOption('oval');
    await page.getByRole('dialog').getByText('Keep driving').click();
    assert.match(await summary(), /lakeside/);
    assert.equal(await choice('Track').inputValue(), 'lakeside');
    await choice('Track').selectOption('oval');
    await page.getByRole('dialog').getByText('Restart', { exact: true }).click();
    await dashboard.until(summary, (text) => /oval/.test(text), 'the other track');
    await (await dashboard.setting('controller')).locator('select').selectOption('stanley');
    await dashboard.until(summary, (text) => /stanley/.test(text), 'the other controller');
    await choice('Preset').selectOption('weighted');
    await dashboard.until(summary, (text) => /cubic-mpc · weighted/.test(text), 'the preset');
    await dashboard.until(dashboard.speed, above(10), 'a car that drives');
  });

  it('counts laps, compares two of them and exports', async () => {
    await dashboard.show('try');
    await type('run.pace', 20);
    await dashboard.show('understand');
    await dashboard.until(dashboard.laps, atLeast(2), 'laps');
    await dashboard.show('try'); // before the page has seen more laps than it keeps
    await dashboard.fromMenu('1×');
    await dashboard.show('understand');
    await page.getByText('All laps', { exact: true }).click();
    assert.equal(await page.locator('.lap-rows tr.best').count(), 1);
    await page.locator('.lap-plots path.a').nth(2).waitFor(); // speed, pedal, steer
    const table = await download('Table as CSV');
    assert.match(table.name, /oval.*laps\.csv/);
    assert.match(table.content.toString(), /^lap,lap_time_s,sector_1_s/);
    const lap = await download('This lap as CSV');
    assert.match(lap.content.toString(), /^s_m,time_s,speed_mps/);
    assert.deepEqual(await dashboard.accessibilityFindings('main'), []);
  });
});
