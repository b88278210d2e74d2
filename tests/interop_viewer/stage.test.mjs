// SPDX-License-Identifier: MIT
// The picture and what lies on it: speed, why, alerts, the cursor; and how the page fits windows, fingers and eyes.
import assert from 'node:assert/strict';
import { after, afterEach, describe, it } from 'node:test';
import { DashboardPage, differentFrom, LAPTOP, PHONE, TABS } from './dashboard_page.mjs';
import { misfits } from './fit.mjs';
import { browserAndDrive } from './here.mjs';

let shared = null;
after(() => shared?.close()); // before the browser ends
const here = browserAndDrive(['--track', 'oval', '--pace', '3']);

/** The page that the tests have in common, at a tab. */
async function open({ tab = 'laps' } = {}) {
  shared ??= await DashboardPage.open(here.browser, here.drive.url, { tab });
  await shared.beginAt(tab);
  return shared;
}
afterEach(() => shared?.hadNothingToComplainOf());

const box = (dashboard, selector) => dashboard.page.locator(selector).first().boundingBox();
const background = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);

describe('on the picture', () => {
  it('stand the speed and the sentence why, whatever tab is open; nothing moves at 100', async () => {
    const dashboard = await open();
    const { page } = dashboard;
    await page.getByTestId('why').waitFor();
    assert.match(await dashboard.text('why'), /^(Grip|Brakes|Full|Rolls|Part|The car stands).*\.$/);
    const unit = async () => (await box(dashboard, '.hud .big .unit')).x;
    await dashboard.pause(); // a busy machine may look away for as long as the car is slow
    await dashboard.button('Reset').click();
    await dashboard.until(
      () => dashboard.number('speed'),
      (mph) => mph < 30,
      'a car at the start',
    );
    const scale = await page.locator('.legend').innerText();
    const first = await unit();
    await dashboard.resume();
    await dashboard.until(
      () => dashboard.number('speed'),
      (mph) => mph >= 100,
      'three digits',
    );
    assert.equal(await unit(), first);
    const colours = /plan 0.*?(\d+ mph)/s;
    assert.equal(
      colours.exec(await page.locator('.legend').innerText())[1],
      colours.exec(scale)[1],
      'the same colours at every speed',
    );
  });

  it('stands who drives, and how far the car is off the road', async () => {
    const dashboard = await open({ tab: 'explain' });
    const { page } = dashboard;
    await page.locator('body').press('m');
    await page
      .getByTestId('why')
      .getByText(/A person drives\./)
      .first()
      .waitFor();
    await page.locator('.rows dd', { hasText: 'A person drives' }).waitFor();
    await page.keyboard.down('ArrowUp');
    await page.keyboard.down('ArrowLeft');
    await page
      .getByTestId('why')
      .getByText(/Off the road by \d+(\.\d)? m\./)
      .waitFor();
    await page.locator('[data-testid="edge-distance"].bad').waitFor();
    assert.deepEqual(await dashboard.accessibilityFindings('.stage', 'all'), []);
    await page.keyboard.up('ArrowUp');
    await page.keyboard.up('ArrowLeft');
    await page.keyboard.press('Escape');
    await dashboard.button('Reset').click();
    await dashboard.until(() => dashboard.text('why'), differentFrom(''), 'a sentence');
  });
});

describe('the cursor', () => {
  it('is the same in plots, on the map and in the explanation; a click on the road moves it there', async () => {
    const dashboard = await open({ tab: 'plots' });
    const { page } = dashboard;
    const pink = () =>
      page.locator('canvas.map-2d').evaluate((canvas) => {
        const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height });
        const context = copy.getContext('2d', { willReadFrequently: true });
        context.drawImage(canvas, 0, 0);
        const { data } = context.getImageData(0, 0, copy.width, copy.height);
        let count = 0;
        for (let i = 0; i < data.length; i += 4)
          count += data[i] - data[i + 1] > 60 && data[i + 2] - data[i + 1] > 40 ? 1 : 0;
        return count;
      });
    await dashboard.until(
      () => dashboard.number('speed'),
      (mph) => mph > 60,
      'a car that drives',
    );
    await dashboard.until(
      () => dashboard.seconds(),
      (now) => now > 6,
      'a stretch behind the car to point at',
    );
    await dashboard.pause();
    await dashboard.button('Whole track').click();
    assert.equal(await pink(), 0);
    const plot = await box(dashboard, '.plot[aria-label="Lateral error"] .u-over');
    await page.mouse.move(plot.x + plot.width - 12, plot.y + plot.height / 2);
    await dashboard.until(pink, (count) => count > 20, 'a ring where the car was then');
    await page.mouse.move(5, 5);
    await dashboard.until(pink, (count) => count === 0, 'no ring without a cursor');
    await dashboard.button('Chase').click();
    const map = await box(dashboard, 'canvas.map-2d');
    await page.mouse.click(map.x + map.width / 2, map.y + map.height - 235 + 15); // just behind the car
    await dashboard.until(pink, (count) => count > 20, 'a ring where the road was clicked');
    await dashboard.button('Follow').waitFor();
    await dashboard.button('Follow').click();
    await dashboard.until(pink, (count) => count === 0, 'no ring when the plots follow again');
    await dashboard.resume();
  });
});

it('plots this lap against the track, with the best lap and the limit behind it', async () => {
  const dashboard = await open({ tab: 'plots' });
  const { page } = dashboard;
  await dashboard.button('Track').click();
  assert.equal(await page.locator('.track-plots .plot').count(), 3);
  await dashboard.until(
    () => dashboard.colours('.track-plots .plot[aria-label="Speed along the track"] canvas'),
    (colours) => colours > 20,
    'curves',
  );
  assert.equal(await page.locator('.plot[aria-label="Cost"]').isVisible(), false);
  await dashboard.button('Time').click();
  await page.locator('.plot[aria-label="Cost"]').waitFor();
});

describe('the page', () => {
  it('changes between light and dark, and remembers it', async () => {
    const dashboard = await open();
    const { page } = dashboard;
    const light = await background(page);
    await page.locator('body').press('t');
    const dark = await background(page);
    assert.notEqual(dark, light);
    await page.reload();
    await page.getByText('Live', { exact: true }).waitFor();
    assert.equal(await background(page), dark);
    await page.getByLabel('Change to light colours').click();
    assert.equal(await background(page), light);
  });

  it('gives the picture three fifths of a common screen, and no number moves when the reason changes', async () => {
    const dashboard = await open();
    const { page } = dashboard;
    const { width, height } = await box(dashboard, 'canvas.map-2d');
    const share = (width * height) / (1366 * 768);
    assert.ok(share >= 0.6, `${(100 * share).toFixed(1)} % of the screen`);
    assert.deepEqual(await page.evaluate(misfits), []);
    // The car stands in the middle of the picture, above what lies over its foot.
    const map = await box(dashboard, '.map');
    const foot = await box(dashboard, '.map-foot');
    assert.ok(foot.y > map.y + map.height - 235 + 20, `${map.y + map.height - foot.y} px of the foot are covered`);
    const clock = async () => (await box(dashboard, '.instruments .clock')).x;
    const first = await clock();
    const why = await dashboard.text('why');
    await dashboard.until(() => dashboard.text('why'), differentFrom(why), 'another reason');
    assert.equal(await clock(), first);
  });

  it('shows the picture alone to an audience, and comes back', async () => {
    const dashboard = await open();
    const { page } = dashboard;
    const before = await box(dashboard, '.map');
    await page.locator('body').press('g');
    await page.locator('.workbench.stage-alone').waitFor();
    const alone = await box(dashboard, '.map');
    assert.ok(alone.width > 1.5 * before.width, `${before.width}, then ${alone.width}`);
    assert.equal(await page.locator('.tabs').isVisible(), false);
    assert.ok((await dashboard.number('speed')) >= 0);
    await page.locator('body').press('g');
    await page.locator('.tabs').waitFor();
  });

  it('shows the buttons of the lap table in a small window', async () => {
    const dashboard = await open();
    const { page } = dashboard;
    await page.setViewportSize({ width: 1280, height: 720 });
    await dashboard.until(
      () => page.locator('.lap-table .picks').count(),
      (count) => count >= 1,
      'a row to choose',
    );
    const panel = await box(dashboard, '.table-scroll');
    for (const radio of await page.locator('.lap-table .picks input').all()) {
      const { x, width } = await radio.boundingBox();
      assert.ok(x >= panel.x && x + width <= panel.x + panel.width, `${x} of ${panel.x} + ${panel.width}`);
    }
    await page.setViewportSize(LAPTOP.viewport);
  });

  it('is for fingers on a phone: nothing under 44 px but what stands on the picture', async () => {
    const dashboard = await DashboardPage.open(here.browser, here.drive.url, { ...PHONE, tab: 'drive' });
    const { page } = dashboard;
    for (const tab of TABS) {
      await dashboard.show(tab);
      const small = await page.locator('button, select, input[type="range"]').evaluateAll((all) =>
        all
          .filter((each) => each.offsetParent !== null && !each.closest('.legend, .bar-row'))
          .map((each) => ({ each, height: Math.round(each.getBoundingClientRect().height) }))
          .filter(({ height }) => height < 44)
          .map(({ each, height }) => `${each.textContent || each.ariaLabel}: ${height}`),
      );
      assert.deepEqual(small, [], tab);
    }
    await page.getByLabel('Keys and help').click();
    await page.getByRole('dialog').waitFor();
    await dashboard.button('Close').click();
    await dashboard.close();
  });
});
