// SPDX-License-Identifier: MIT
// The page in the hands of a reader: keys, tabs, addresses, searches and explanations do what they say.
import assert from 'node:assert/strict';
import { after, afterEach, before, beforeEach, describe, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { DashboardPage, LAPTOP } from './dashboard_page.mjs';
import { browserAndDrive } from './here.mjs';

// A car that `chicane identify` found from a minute of a recording, and another program's road.
const fileOf = (name) => fileURLToPath(new URL(name, import.meta.url));
const FILES = ['--car', fileOf('identified.yaml'), '--track', fileOf('../data/tracks/course.geojson')];
const here = browserAndDrive(FILES);
let dashboard;
let page;

async function open() {
  dashboard = await DashboardPage.open(here.browser, here.drive.url);
  page = dashboard.page;
}

describe('the page', () => {
  before(() => open());
  beforeEach(async () => {
    await page.setViewportSize(LAPTOP.viewport);
    await dashboard.beginAt('try');
    await page.locator('#search').fill('');
    await page.evaluate(() => document.activeElement.blur());
  });
  afterEach(() => dashboard.hadNothingToComplainOf());
  after(() => dashboard.close());

  it('says what a log found of the car and how well, and what the road was read from', async () => {
    await page.getByText('Controller, car and road').click();
    const origin = page.getByTestId('origin');
    assert.match(await origin.innerText(), /road-car, identified from 60 s of run\.mcap/);
    assert.match(await origin.innerText(), /Grip is not known: the tyres were used too little/);
    assert.equal(await origin.locator('.identified tbody tr').count(), 9);
    const row = origin.locator('.identified tr', { hasText: 'brake acceleration' });
    assert.deepEqual(await row.locator('td').allInnerTexts(), ['9.076', '8.99 to 9.16']);
    await origin.getByText('Assumed, because the log does not excite it: steer rate limit, friction, ').waitFor();
    await origin.getByText('Read from a GeoJSON file.').waitFor();
    await origin.getByText(/smoothing: noise of \d\.\d+ m estimated from the points/).waitFor();
    await origin.getByText(/^\d+ points of the file, 0\.\d{3} m from the line \(rms\), \d\.\d{3} m at most$/).waitFor();
    await row.getByRole('button').click();
    await page.locator('.meaning-box:popover-open').waitFor();
    await page.keyboard.press('Escape');
    assert.deepEqual(await dashboard.accessibilityFindings('[data-testid="origin"]'), []);
  });

  it('pauses by Space, whatever was clicked last', async () => {
    await dashboard.show('try');
    await page.getByText(/how long and how strong$/).click();
    const fault = page.locator('button.fault').first();
    await page
      .getByLabel(/^Duration of/)
      .first()
      .fill('600'); // it lasts until it is cleared, however slow the machine is
    await fault.click();
    const name = await fault.innerText();
    await page.keyboard.press('Space');
    await page.getByText('Paused', { exact: true }).waitFor();
    assert.equal(await fault.getAttribute('aria-pressed'), 'true', `${name} goes on`);
    await page.keyboard.press('Space');
    await page.getByText('Live', { exact: true }).waitFor();
    await dashboard.button('Clear all').click();
    await page.locator('button.fault[aria-pressed="true"]').waitFor({ state: 'detached' });
  });

  it('can be used at 200 % and at 320 pixels', async () => {
    for (const viewport of [
      { width: 683, height: 384 },
      { width: 320, height: 640 },
    ]) {
      await page.setViewportSize(viewport);
      await dashboard.show('watch');
      const box = (selector) => page.locator(selector).first().boundingBox();
      const map = await dashboard.until(
        () => box('.map'),
        ({ height }) => height >= 200,
        `a picture that can be seen at ${viewport.width}`,
      );
      const strip = await box('.strip');
      assert.ok(strip.y >= map.y + map.height - 1, 'the strip is below the picture');
      const { across } = await dashboard.overflow();
      assert.ok(across <= 0, `nothing is cut off at ${viewport.width}`);
      assert.deepEqual(await dashboard.accessibilityFindings(), []);
    }
  });

  it('has its mode in the address, for back, forward, reload and links', async () => {
    const chosen = () => page.locator('.modes [aria-current="page"]').innerText();
    const is = (title) => dashboard.until(chosen, (now) => now === title, title);
    await dashboard.show('watch');
    await dashboard.show('understand');
    assert.match(page.url(), /#understand/);
    await page.goBack();
    await is('Watch');
    await page.goBack();
    await is('Try');
    await page.goForward();
    await is('Watch');
    await page.reload();
    await is('Watch');
    await page.evaluate(() => {
      location.hash = 'try';
    });
    await is('Try');
  });

  it('says what a setting means to touch and keyboard', async () => {
    const name = page.locator('.sliders [data-key="latency_ms"] .meaning');
    const note = page.getByRole('note').filter({ hasText: /delay.*0 to 500 ms.*latency_ms/s });
    await name.focus();
    await page.keyboard.press('Enter');
    await note.waitFor();
    assert.deepEqual(await dashboard.accessibilityFindings(), []);
    await page.keyboard.press('Escape');
    await note.waitFor({ state: 'hidden' });
    await name.click();
    await note.waitFor();
    const { x, y, width, height } = await note.boundingBox();
    assert.ok(x >= 0 && y >= 0 && x + width <= 1366 && y + height <= 768, 'inside the window');
    await page.mouse.click(5, 5);
    await note.waitFor({ state: 'hidden' });
  });

  it('brings into sight what a step of the tour is about', async () => {
    await page.evaluate(() => {
      localStorage.setItem('chicane.tour.name', '"dashboard"');
      localStorage.setItem('chicane.tour.step', '4');
    });
    await page.reload();
    await dashboard.fromMenu('Go on with the tour, step 5 of 7');
    const isSeen = (selector) => () =>
      page
        .locator(selector)
        .first()
        .evaluate((element) => {
          const { top, bottom } = element.getBoundingClientRect();
          return top >= 0 && bottom <= innerHeight;
        });
    await dashboard.until(isSeen('[data-key="fault.steering_stuck"]'), Boolean, 'the fault of step 5');
    await dashboard.show('watch');
    await dashboard.button('Skip').click();
    await dashboard.until(isSeen('#search'), Boolean, 'the search of step 6');
    await dashboard.button('Leave the tour').click();
  });
});
