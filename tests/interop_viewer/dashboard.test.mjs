// SPDX-License-Identifier: MIT
// The dashboard as a reader meets it: headless Chromium and a run of the program.
import assert from 'node:assert/strict';
import { after, afterEach, before, beforeEach, describe, it } from 'node:test';
import { startDrive } from './chicane_drive.mjs';
import { above, DashboardPage, differentFrom, MODES } from './dashboard_page.mjs';
import { browserAndDrive } from './here.mjs';

const here = browserAndDrive([]);
let dashboard;
let page;

async function open(options) {
  dashboard = await DashboardPage.open(here.browser, here.drive.url, options);
  page = dashboard.page;
}

describe('the dashboard', () => {
  before(() => open());
  beforeEach(() => dashboard.beginAt('try'));
  afterEach(() => dashboard.hadNothingToComplainOf());
  after(() => dashboard.close());

  it('loads and says what runs', async () => {
    assert.equal(await page.locator('html').getAttribute('lang'), 'en');
    assert.equal(await page.locator('main').count(), 1);
    assert.match(await page.locator('.name').innerText(), /chicane/);
    assert.equal(await page.locator('h1').count(), 1);
    assert.match(await dashboard.summary(), /tracking-mpc · default · udacity · lakeside · 100 ms latency/);
    await page.getByText('Controller, car and road').click();
    await dashboard.until('rung', /^(Grip|Brakes|Full throttle|Part throttle|Rolls)/, 'what the car does');
    assert.match(
      await dashboard.text('status'),
      /^The solver (converged|stopped at its limit, close enough to the optimum), \d+ iterations?$/,
    );
    assert.match(await dashboard.text('gate'), /^(Passed the command unchanged|Changed the command)$/);
    assert.equal(await dashboard.text('road'), 'On the road, never left it');
  });

  it('shows a car that moves and numbers that change', async () => {
    await dashboard.show('watch');
    const picture = () => page.locator('canvas.map-2d').evaluate((canvas) => canvas.toDataURL());
    const [firstPicture, firstTime, firstSteer] = [
      await picture(),
      await dashboard.seconds(),
      await dashboard.text('wheels'),
    ];
    await dashboard.until(dashboard.seconds, above(firstTime + 0.5), 'lap time');
    await dashboard.until(picture, differentFrom(firstPicture), 'the track');
    await dashboard.until(() => dashboard.text('wheels'), differentFrom(firstSteer), 'the wheels');
    await dashboard.until(dashboard.speed, above(5), 'speed in mph');
    assert.ok((await dashboard.colours('canvas.map-2d')) > 20, 'the picture shows road, car and plan');
  });

  it('pauses, steps, resumes and resets by its buttons', async () => {
    await dashboard.show('watch');
    await dashboard.pause();
    const paused = await dashboard.seconds();
    await dashboard.page.locator('body').press('.');
    const stepped = await dashboard.until(() => dashboard.seconds(), differentFrom(paused), 'lap time after a step');
    assert.equal(stepped.toFixed(2), (paused + 0.04).toFixed(2));
    await dashboard.startAgain();
    await dashboard.until(dashboard.seconds, 0, 'lap time after a reset');
    await dashboard.resume();
    await dashboard.until(dashboard.seconds, above(0.2), 'lap time after going on');
    await page.locator('.name').click();
    assert.ok(await page.locator('#menu').getByRole('button', { name: 'One step' }).isDisabled());
    await page.keyboard.press('Escape');
  });

  it('takes what is typed after the key of the search, however late the next picture comes', async () => {
    await dashboard.show('try');
    await page.locator('#search').waitFor(); // the settings are there
    await dashboard.show('watch');
    await page.evaluate(() => {
      globalThis.requestAnimationFrame = () => 0;
    });
    await page.keyboard.press('/');
    await page.keyboard.type('squared rust');
    assert.equal(await page.locator('#search').inputValue(), 'squared rust');
    await page.reload();
    await page.getByText('Live', { exact: true }).waitFor();
  });

  it('holds plots while the run goes on, and zooms by dragging', async () => {
    await dashboard.showEngineer();
    const plot = page.locator('.plot[aria-label="Lateral error"]');
    await plot.scrollIntoViewIfNeeded();
    const ticks = () => plot.locator('canvas').evaluate((canvas) => canvas.toDataURL());
    await dashboard.button('Hold plots').click();
    const still = await dashboard.settled(ticks);
    await page.waitForTimeout(1000); // the run goes on
    assert.equal(await ticks(), still);
    await dashboard.button('Follow').click();
    await dashboard.until(ticks, differentFrom(still), 'plots that follow');

    const box = await plot.locator('.plot-over').boundingBox();
    await page.mouse.move(box.x + box.width * 0.5, box.y + 20);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.9, box.y + 30, { steps: 4 });
    await page.mouse.up();
    await dashboard.button('Reset zoom').waitFor();
    const zoomed = await plot.locator('.plot-over').boundingBox(); // the button may have taken a row above the plots
    await page.mouse.dblclick(zoomed.x + zoomed.width * 0.5, zoomed.y + 20);
    await dashboard.button('Reset zoom').waitFor({ state: 'detached' });
    await dashboard.button('Hold plots').waitFor();
  });

  it('shows differences from a mark, the second cursor', async () => {
    await dashboard.show('watch');
    await dashboard.until(dashboard.seconds, above(1), 'some data');
    await dashboard.pause();
    await dashboard.showEngineer();
    await page.locator('.plot[aria-label="Lateral error"]').scrollIntoViewIfNeeded();
    const place = () => page.locator('.plot[aria-label="Lateral error"] .plot-over').boundingBox();
    const box = await place();
    const at = (back) => [box.x + box.width - back, box.y + 20];
    await page.mouse.click(...at(10));
    const mark = page.getByRole('button', { name: /^Remove the mark/ });
    await mark.waitFor();
    assert.deepEqual(await place(), box, 'the plot stays under the mouse');
    await page.mouse.move(...at(30));
    await dashboard.until(
      () => page.locator('.plot[aria-label="Heading error"] .key b').innerText(),
      /\(Δ [+−]?\d+\.\d+\)/,
      'the difference in another plot',
    );
    await dashboard.until(() => mark.innerText(), /Δt −\d+\.\d\d s/, 'the time between both');
    assert.deepEqual(await dashboard.accessibilityFindings(), []);
    await page.keyboard.press('x');
    await mark.waitFor({ state: 'detached' });
    await dashboard.resume();
  });

  it('can be used without a mouse', async () => {
    const chosen = () => page.locator('.modes [aria-current="page"]').innerText();
    for (const [i, mode] of MODES.entries()) {
      await page.keyboard.press(String(i + 1));
      assert.equal((await chosen()).toLowerCase(), mode);
    }
    await page.keyboard.press('1');
    const camera = () => page.getByLabel('Camera', { exact: true }).inputValue();
    const first = await camera();
    await page.keyboard.press('c');
    await dashboard.until(camera, differentFrom(first), 'another camera');
    await dashboard.camera('Track');
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press('?');
    await page.getByRole('dialog', { name: 'Keys' }).waitFor();
    assert.ok((await page.locator('kbd').count()) > 15);
    await page.keyboard.press('Escape');
    await page.getByRole('dialog').waitFor({ state: 'detached' });
  });
});

it('is dark for readers who like it dark', async () => {
  await open({ colorScheme: 'dark' });
  const ground = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = Math.max(...ground.match(/\d+/g).map(Number));
  assert.ok(light < 40, ground);
  await page.emulateMedia({ colorScheme: 'light' });
  const corner = () =>
    page.locator('canvas.map-2d').evaluate((canvas) => {
      // From a copy: browsers complain of a canvas that is read again and again.
      const pixel = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
      pixel.drawImage(canvas, -2, 2 - canvas.height);
      return [...pixel.getImageData(0, 0, 1, 1).data];
    });
  await dashboard.until(corner, ([red]) => red > 200, 'the map turns light with the page');
  await dashboard.close();
});

it('says when the connection is lost, and comes back by itself', async () => {
  await open();
  const { port } = here.drive;
  await here.drive.stop('SIGKILL');
  await page.getByTestId('banner').waitFor();
  assert.match(await dashboard.text('banner'), /Connection lost/);
  assert.deepEqual(await dashboard.accessibilityFindings('[data-testid="banner"]', 'all'), []);
  here.drive = await startDrive([], port);
  await page.getByTestId('banner').waitFor({ state: 'detached' });
  const first = await dashboard.seconds();
  await dashboard.until(() => dashboard.seconds(), differentFrom(first), 'lap time after coming back');
  // What browsers always say of a socket that cannot connect is the only complaint.
  await dashboard.close((each) => each.startsWith('WebSocket connection to'));
});
