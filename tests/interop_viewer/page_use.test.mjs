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
    await dashboard.beginAt('drive');
  });
  afterEach(() => dashboard.hadNothingToComplainOf());
  after(() => dashboard.close());

  it('says what a log found of the car and how well, and what the road was read from', async () => {
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
    await dashboard.show('faults');
    const fault = page.locator('.panel-body button[aria-pressed]').first();
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
    await page.locator('.panel-body button[aria-pressed="true"]').waitFor({ state: 'detached' });
  });

  it('gives the stage three fifths of a laptop', async () => {
    const { width, height } = await page.locator('.stage').boundingBox();
    assert.ok(width * height >= 0.6 * 1366 * 768 * 0.93, `${width} x ${height}, beside a header of 7 %`);
  });

  it('can be used at 200 % and at 320 pixels', async () => {
    for (const viewport of [
      { width: 683, height: 384 },
      { width: 320, height: 640 },
    ]) {
      await page.setViewportSize(viewport);
      const box = (selector) => page.locator(selector).first().boundingBox();
      const map = await dashboard.until(
        () => box('.map'),
        ({ height }) => height >= 200,
        `a picture that can be seen at ${viewport.width}`,
      );
      const [hud, controls] = [await box('.hud'), await box('.map-controls')];
      assert.ok(hud.y >= controls.y + controls.height, 'the speed is below the buttons');
      assert.ok(hud.y + hud.height <= map.y + map.height, 'and on the picture');
      const { across } = await dashboard.overflow();
      assert.ok(across <= 0, `nothing is cut off at ${viewport.width}`);
      assert.deepEqual(await dashboard.accessibilityFindings(), []);
    }
  });

  it('keeps how far each panel was scrolled', async () => {
    const body = page.locator('#panel');
    const scrolled = () => body.evaluate((element) => element.scrollTop);
    await dashboard.show('tune');
    await page.locator('#tune-search').waitFor();
    await body.evaluate((element) => element.scrollTo(0, 400));
    await dashboard.show('faults');
    await page.locator('.fault-card').first().waitFor();
    assert.equal(await scrolled(), 0);
    await dashboard.show('tune');
    await dashboard.until(scrolled, (now) => now === 400, 'the settings as they were scrolled');
  });

  it('has its tab in the address, for back, forward, reload and links', async () => {
    const chosen = () => page.locator('[role="tab"][aria-selected="true"]').innerText();
    const is = (title) => dashboard.until(chosen, (now) => now === title, title);
    await dashboard.show('tune');
    await dashboard.show('laps');
    assert.match(page.url(), /#laps$/);
    await page.goBack();
    await is('Tune');
    await page.goBack();
    await is('Drive');
    await page.goForward();
    await is('Tune');
    await page.reload();
    await is('Tune');
    await page.evaluate(() => {
      location.hash = 'faults';
    });
    await is('Faults');
  });

  it('says what a setting means to touch and keyboard', async () => {
    const name = page.locator('[data-key="latency_ms"] .meaning');
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
    await dashboard.button('Go on with the tour, step 5 of 7').click();
    const card = page.locator('[data-key="fault.steering_stuck"]');
    const isSeen = () =>
      card.evaluate((element) => {
        const panel = document.getElementById('panel').getBoundingClientRect();
        const { top, bottom } = element.getBoundingClientRect();
        return top >= panel.top && bottom <= panel.bottom;
      });
    await dashboard.until(isSeen, Boolean, 'the card of step 5');
    await page.locator('#panel').evaluate((element) => element.scrollTo(0, 0));
    await dashboard.show('tune');
    await page.locator('#panel').evaluate((element) => element.scrollTo(0, 600));
    await dashboard.button('Skip').click();
    const search = () =>
      page.locator('#tune-search').evaluate((element) => {
        const panel = document.getElementById('panel').getBoundingClientRect();
        return element.getBoundingClientRect().top >= panel.top;
      });
    await dashboard.until(search, Boolean, 'the search of step 6');
  });
});
