// SPDX-License-Identifier: MIT
// The line of the fastest lap, as the page draws it: on the map and in three dimensions, for who wants it.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { above, atLeast, below, DashboardPage } from './dashboard_page.mjs';
import { browserAndDrive } from './here.mjs';

const here = browserAndDrive(['--track', 'oval']); // whose limit takes a second of work

const line = (page) => page.locator('.line-key', { hasText: "the limit's line" });
const isOn = async (page) => String((await line(page).count()) > 0);

let state = 'Live';
/** The page with a run that stands still, once the program has found the line. */
async function open() {
  const dashboard = await DashboardPage.open(here.browser, here.drive.url, { state });
  const { page } = dashboard;
  await line(page).waitFor();
  if (state === 'Paused') return dashboard;
  await dashboard.until(dashboard.speed, above(60), 'a car that drives');
  await dashboard.pause();
  state = 'Paused';
  return dashboard;
}

/** What drivers say of a canvas that is read back for a picture without a graphics card is the only complaint. */
const close = (dashboard) => dashboard.close((each) => each.includes('GL Driver Message'));

/**
 * How many pixels of a canvas are violet, and how many of its 16 × 16 fields have one: nothing else in the picture has
 * that colour.
 */
const violet = (page, selector) =>
  page.locator(selector).evaluate(async (canvas) => {
    const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height });
    const context = copy.getContext('2d', { willReadFrequently: true });
    await new Promise(requestAnimationFrame);
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    const fields = new Set();
    let pixels = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [red, green, blue] = [data[i], data[i + 1], data[i + 2]];
      if (red - green < 20 || blue - green < 35 || blue < 150) continue;
      ++pixels;
      const [x, y] = [(i / 4) % copy.width, Math.floor(i / 4 / copy.width)];
      fields.add(Math.floor((16 * x) / copy.width) + 16 * Math.floor((16 * y) / copy.height));
    }
    return { pixels, fields: fields.size };
  });

/** Off by the key and on again, seen on a canvas each time. */
async function toggles(dashboard, selector, fields) {
  const { page } = dashboard;
  const seen = () => violet(page, selector);
  assert.equal(await isOn(page), 'true');
  await dashboard.until(async () => (await seen()).fields, atLeast(fields), 'the racing line');
  const { pixels } = await seen();
  await page.locator('body').press('l');
  assert.equal(await isOn(page), 'false');
  await dashboard.until(
    async () => (await seen()).pixels,
    below(0.2 * pixels),
    `the picture without it, after ${pixels} pixels`,
  );
  await page.locator('body').press('l');
  assert.equal(await isOn(page), 'true');
  await dashboard.until(async () => (await seen()).fields, atLeast(fields), 'the racing line again');
}

it('is drawn on the map, round the whole track, and left away', async () => {
  const dashboard = await open();
  const { page } = dashboard;
  await dashboard.camera('Track');
  await toggles(dashboard, 'canvas.map-2d', 40);
  await page.locator('body').press('l');
  await page.reload();
  await page.getByText('Paused', { exact: true }).waitFor();
  assert.equal(await isOn(page), 'false', 'kept by the browser');
  await page.locator('body').press('l');
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  await close(dashboard);
});

it('is drawn in three dimensions, and left away', async () => {
  const dashboard = await open();
  const { page } = dashboard;
  await dashboard.camera('Top'); // no sky in the picture
  await page.locator('.map.has-3d').waitFor();
  await toggles(dashboard, 'canvas.map-3d', 5);
  assert.deepEqual(await dashboard.accessibilityFindings('.stage'), []);
  await close(dashboard);
});
