// SPDX-License-Identifier: MIT
// The 3D picture in headless Chromium, drawn by the processor; and what is shown where there is none.
import assert from 'node:assert/strict';
import { after, before, describe, it } from 'node:test';
import { launch } from './browser.mjs';
import { startDrive } from './chicane_drive.mjs';
import { above, DashboardPage, EVERY_SIZE, PHONE } from './dashboard_page.mjs';

let drive;
before(async () => {
  drive = await startDrive();
});
after(() => drive.stop());

/** Counts draw calls, so that a test can see whether anything is drawn. */
const countDrawing = () => {
  globalThis.drawn = 0;
  for (const name of ['drawArrays', 'drawElements', 'drawElementsInstanced']) {
    const draw = WebGL2RenderingContext.prototype[name];
    WebGL2RenderingContext.prototype[name] = function (...rest) {
      ++globalThis.drawn;
      return draw.apply(this, rest);
    };
  }
};

/** The page, 820 pixels wide unless `options` say otherwise; with all that moves. */
async function open(browser, options) {
  const shape = { viewport: { width: 820, height: 560 }, script: countDrawing, ...options };
  const dashboard = await DashboardPage.open(browser, drive.url, shape);
  await dashboard.page.emulateMedia({ reducedMotion: null });
  return dashboard;
}

/** What drivers say of a canvas that is read back for a picture without a graphics card. */
const isOfDriver = (complaint) => complaint.includes('GL Driver Message');

const ready = (page) => page.locator('.map.has-3d canvas.map-3d').waitFor();
const button = (page, name) => page.getByRole('button', { name, exact: true });
const camera = (page) => page.getByLabel('Camera', { exact: true });

/** Waits until nothing is drawn any more; how often it was until then. */
const atRest = (dashboard) => dashboard.settled(() => dashboard.page.evaluate(() => globalThis.drawn));

/** A small copy of the 3D picture, from the moment it is drawn: how many colours it has, and the copy itself. */
const picture = (page) =>
  page.evaluate(async () => {
    const canvas = document.querySelector('canvas.map-3d');
    const copy = Object.assign(document.createElement('canvas'), { width: 64, height: 40 });
    const context = copy.getContext('2d', { willReadFrequently: true });
    let best = { colours: 0, text: '' };
    for (let i = 0; i < 40 && best.colours < 30; ++i) {
      await new Promise(requestAnimationFrame);
      context.drawImage(canvas, 0, 0, 64, 40);
      const { data } = context.getImageData(0, 0, 64, 40);
      const colours = new Set(new Uint32Array(data.buffer)).size;
      if (colours > best.colours) best = { colours, text: copy.toDataURL() };
    }
    return best;
  });

describe('the 3D picture', () => {
  let browser;
  before(async () => {
    browser = await launch();
  });
  after(() => browser.close());

  // One page for several tests: to load the picture anew costs more than what they look at.
  let dashboard;
  let page;

  it('is drawn when chosen, from every camera, and chosen again after a reload', async () => {
    dashboard = await open(browser);
    ({ page } = dashboard);
    // Without a graphics card the track comes first.
    assert.equal(await camera(page).inputValue(), 'track');
    assert.equal(await page.locator('canvas.map-3d').count(), 0);
    await dashboard.camera('Chase');
    await ready(page);
    const seen = new Set();
    for (const name of ['Chase', 'Top', 'Cockpit', 'Free']) {
      await dashboard.camera(name);
      const { text } = await dashboard.until(
        () => picture(page),
        (now) => now.colours >= 30 && !seen.has(now.text),
        `a picture from another camera: ${name}`,
      );
      seen.add(text);
    }
    await page.reload();
    await ready(page);
    assert.equal(await camera(page).inputValue(), 'free');
    dashboard.hadNothingToComplainOf(isOfDriver);
  });

  it('obeys the keyboard: cameras, map, and turning the free camera', async () => {
    await dashboard.camera('Chase');
    await page.evaluate(() => document.activeElement.blur());
    for (const name of ['Chase', 'Top', 'Cockpit', 'Free']) {
      await page.waitForFunction(
        (label) => document.querySelector('select.camera').selectedOptions[0].textContent === label,
        name,
      );
      await page.keyboard.press('c');
    }
    await dashboard.camera('Free');
    await button(page, 'Pause').click();
    await page.getByText('Paused', { exact: true }).waitFor();
    await atRest(dashboard);
    const before = await picture(page);
    await page.locator('canvas.map-3d').focus();
    for (let i = 0; i < 6; ++i) await page.keyboard.press('ArrowLeft');
    await dashboard.until(
      () => picture(page),
      ({ text }) => text !== before.text,
      'another view',
    );
    await dashboard.camera('Map');
    await page.locator('.map:not(.has-3d)').waitFor();
    await dashboard.camera('Free');
    await ready(page);
    await button(page, 'Resume').click();
    dashboard.hadNothingToComplainOf(isOfDriver);
  });

  it('rests while nothing moves, and goes on after a reset', async () => {
    await button(page, 'Pause').click();
    await page.getByText('Paused', { exact: true }).waitFor();
    const still = await atRest(dashboard);
    await page.locator('body').press('r');
    await button(page, 'Resume').click();
    await page.getByText('Live', { exact: true }).waitFor();
    await page.waitForFunction((before) => globalThis.drawn > before, still);
    assert.ok((await picture(page)).colours >= 30);
    dashboard.hadNothingToComplainOf(isOfDriver);
  });

  it('gives way to the map when the browser takes the context, and comes back when asked', async () => {
    await page.evaluate(() =>
      document.querySelector('canvas.map-3d').getContext('webgl2').getExtension('WEBGL_lose_context').loseContext(),
    );
    await page.getByText('The browser stopped the 3D picture').waitFor();
    assert.ok((await page.locator('canvas.map-2d').boundingBox()).width > 300, 'the map fills the place');
    await dashboard.camera('Chase');
    await ready(page);
    assert.ok((await picture(page)).colours >= 30);
    dashboard.complaints.length = 0; // of the context that was taken
  });

  // Each load of the picture takes four seconds of processor time: still and on a phone with CHICANE_SLOW_TESTS.
  it('has nothing that axe objects to, in the light, in the dark, still, and on a phone', async () => {
    const isGood = async (shown, name, ...which) => {
      await ready(shown.page);
      assert.ok((await picture(shown.page)).colours >= 30, name);
      assert.deepEqual(await shown.accessibilityFindings(...which), [], name);
      assert.ok((await shown.overflow()).across <= 0, `${name}: wider than the window`);
    };
    await dashboard.camera('Free');
    await isGood(dashboard, 'in the light');
    await page.emulateMedia({ colorScheme: 'dark' });
    await isGood(dashboard, 'in the dark', '.stage', ['color-contrast']);
    if (!EVERY_SIZE) return dashboard.hadNothingToComplainOf(isOfDriver);
    await page.emulateMedia({ reducedMotion: 'reduce' });
    await page.reload();
    await isGood(dashboard, 'for readers who want little motion');
    await dashboard.close(isOfDriver);
    const phone = await open(browser, PHONE);
    await phone.camera('Free');
    await isGood(phone, 'on a phone');
    await phone.close(isOfDriver);
  });

  it('comes without the page standing still for it', async (test) => {
    const smooth = await open(browser, { fluent: true });
    const { page: moving } = smooth;
    await smooth.until(() => smooth.colours('canvas.map-2d'), above(20), 'the map');
    await moving.evaluate(() => {
      let last = performance.now();
      globalThis.longest = 0;
      setInterval(() => {
        const now = performance.now();
        globalThis.longest = Math.max(globalThis.longest, now - last);
        last = now;
      }, 10);
    });
    const begin = performance.now();
    await smooth.camera('Chase');
    await ready(moving);
    const took = performance.now() - begin;
    assert.ok((await picture(moving)).colours >= 30, 'there is something to see as soon as the map has made room');
    const drawn = await moving.evaluate(() => globalThis.drawn);
    await moving.waitForFunction((before) => globalThis.drawn > before, drawn);
    const longest = await moving.evaluate(() => globalThis.longest);
    test.diagnostic(
      `first picture after ${took.toFixed(0)} ms, the page answered at least every ${longest.toFixed(0)} ms`,
    );
    // Measured: 200 to 550 ms; 4600 to 8400, nearly all of the wait, with a blurred sky and awaited shaders. A share of
    // the wait holds on a busy machine too.
    assert.ok(longest < Math.max(1000, took / 2), `${longest} ms without an answer, of ${took} ms`);
    await smooth.close(isOfDriver);
  });

  it('works where the browser keeps nothing', { skip: !EVERY_SIZE && 'with CHICANE_SLOW_TESTS' }, async () => {
    const script = () =>
      Object.defineProperty(window, 'localStorage', {
        get: () => {
          throw new DOMException('denied', 'SecurityError');
        },
      });
    const opened = await open(browser, { script });
    await opened.camera('Chase');
    await ready(opened.page);
    assert.ok((await picture(opened.page)).colours >= 30);
    await opened.close(isOfDriver);
  });
});

it('is replaced by the map, with a note, where there is no WebGL', async (test) => {
  const browser = await launch('--disable-3d-apis');
  test.after(() => browser.close());
  const dashboard = await open(browser);
  const { page } = dashboard;
  await page.getByText('This browser offers no WebGL 2').waitFor();
  await dashboard.until(() => dashboard.colours('canvas.map-2d'), above(20), 'the map shows road and car');
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  await dashboard.camera('Chase'); // in vain, and says so again
  await page.getByText('This browser offers no WebGL 2').waitFor();
  await dashboard.camera('Map');
  await page.getByText('This browser offers no WebGL 2').waitFor({ state: 'detached' });
  dashboard.hadNothingToComplainOf(isOfDriver);
});
