// SPDX-License-Identifier: MIT
// The stage: nothing lies over the car and its plan, the strip says what happens, and little stands on the first
// screen.
import assert from 'node:assert/strict';
import { after, afterEach, describe, it } from 'node:test';
import { above, DashboardPage, EVERY_SIZE, LAPTOP, MODES, PHONE } from './dashboard_page.mjs';
import { misfits } from './fit.mjs';
import { browserAndDrive } from './here.mjs';

let shared = null;
after(() => shared?.close(isAboutGraphics)); // before the browser ends
const here = browserAndDrive(['--track', 'hairpins', '--pace', '3']);
/** What drivers say of a canvas that is drawn by the processor. */
const isAboutGraphics = (text) => /GPU|WebGL|GL Driver/i.test(text);

/** The page that the tests have in common. */
async function open({ mode = 'watch' } = {}) {
  shared ??= await DashboardPage.open(here.browser, here.drive.url, { mode });
  await shared.beginAt(mode);
  return shared;
}
afterEach(() => shared?.hadNothingToComplainOf(isAboutGraphics));

const box = (dashboard, selector) => dashboard.page.locator(selector).first().boundingBox();
const background = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);

/** Those that leave the least room, then the others, which the slow tests look at. */
const LEAST = [
  [1366, 768],
  [390, 844],
  [844, 390],
];
const SIZES = EVERY_SIZE ? [...LEAST, [1920, 1080], [1100, 800], [820, 1180], [1180, 820]] : LEAST;
const MOMENTS = EVERY_SIZE ? 4 : 2;
const CARDS = ['.head', '.modes', '.corner', '.small-map', '.strip', '.tour', '.note'];

/**
 * Runs in the page: what is over the car's box and the plan, or outside the picture, at this moment; null until the
 * last picture is of the size and the camera of now.
 */
function overlaps(cards) {
  const canvas = [...document.querySelectorAll('.map-3d, .map-2d')].find((each) => each.checkVisibility());
  const asked = new CustomEvent('geometry');
  canvas.dispatchEvent(asked);
  const picture = canvas.getBoundingClientRect();
  const { camera, aspect } = asked.geometry?.picture ?? {};
  const isOfNow = camera === document.querySelector('[aria-label="Camera"]').value;
  if (!isOfNow || Math.abs(aspect - picture.width / picture.height) > 0.01) return null;
  const { corners, plan, horizon } = asked.geometry;
  const [xs, ys] = [corners.map(([x]) => x), corners.map(([, y]) => y)];
  const edges = [Math.min(...xs), Math.max(...xs)].flatMap((x) =>
    [Math.min(...ys), Math.max(...ys)].map((y) => [x, y]),
  );
  const points = [...edges, ...plan].map(([x, y]) => [x + picture.left, y + picture.top]);
  const found = [];
  for (const selector of cards)
    for (const card of document.querySelectorAll(selector)) {
      const { left, right, top, bottom, width } = card.getBoundingClientRect();
      const isIn = ([x, y]) => width > 0 && x > left && x < right && y > top && y < bottom;
      if (card.checkVisibility() && points.some(isIn))
        found.push(`${selector} over ${points.filter(isIn).length} points`);
    }
  const isOut = ([x, y]) => !(x >= picture.left && x <= picture.right && y >= picture.top && y <= picture.bottom);
  if (points.some(isOut)) found.push(`${points.filter(isOut).length} points of ${points.length} outside the picture`);
  const map = document.querySelector('.small-map')?.getBoundingClientRect();
  if (map && map.bottom - picture.top > horizon) found.push('the small map is on the road');
  return { found, plan: plan.length };
}

/** Looks again and again while the car drives: some moments of a lap with its hairpins. */
async function lookAtDriving(dashboard, what, moments) {
  for (let i = 0; i < moments; ++i) {
    const look = () => dashboard.until(() => dashboard.page.evaluate(overlaps, CARDS), Boolean, 'a picture of now');
    const first = await look();
    await dashboard.page.waitForTimeout(300);
    // A card may have moved since the picture was drawn: what lies over the next one, too, counts.
    if (first.found.length > 0) assert.deepEqual((await look()).found, [], what);
  }
}

describe('nothing lies over the car and its plan', () => {
  it('on the track and on the map, at any size', async () => {
    const dashboard = await open();
    await dashboard.until(dashboard.speed, above(30), 'a car that drives');
    for (const [width, height] of SIZES) {
      await dashboard.page.setViewportSize({ width, height });
      for (const camera of ['Map', 'Track']) {
        await dashboard.camera(camera);
        await lookAtDriving(dashboard, `${camera} at ${width} x ${height}`, MOMENTS);
      }
      await dashboard.show('try');
      await lookAtDriving(dashboard, `Try at ${width} x ${height}`, MOMENTS);
      await dashboard.show('watch');
      const { across, down } = await dashboard.overflow();
      assert.ok(across <= 0 && down <= 0, `${across} ${down} at ${width} x ${height}`);
      const strip = (await box(dashboard, '.strip')).height;
      if (width > 599 && height > 480) assert.equal(Math.round(strip), 72, `the strip at ${width}`);
    }
    await dashboard.page.setViewportSize(LAPTOP.viewport);
  });

  it('from behind the car and from above it, in three dimensions', async () => {
    const dashboard = await open();
    await dashboard.camera('Chase');
    await dashboard.page.locator('.map.has-3d').waitFor();
    for (const [width, height] of SIZES) {
      await dashboard.page.setViewportSize({ width, height });
      for (const camera of ['Chase', 'Top']) {
        await dashboard.camera(camera);
        await lookAtDriving(dashboard, `${camera} at ${width} x ${height}`, MOMENTS);
      }
    }
    await dashboard.page.setViewportSize(LAPTOP.viewport);
    await dashboard.camera('Track');
  });
});

describe('the first screen', () => {
  it('has at most twelve numbers, eight controls and forty words', async () => {
    const dashboard = await open();
    const { page } = dashboard;
    const seen = await page.evaluate(() => {
      const isSeen = (each) => each.checkVisibility() && !each.closest('.sr-only');
      const own = [...document.querySelectorAll('#app *')].filter((each) => isSeen(each) && !each.closest('option'));
      const texts = own.flatMap((each) =>
        [...each.childNodes].filter((node) => node.nodeType === 3).map((n) => n.data),
      );
      const text = texts.join(' ');
      return {
        numbers: (text.match(/[+−]?\d[\d:.]*/g) ?? []).length,
        words: (text.match(/\p{L}+/gu) ?? []).length,
        controls: own.filter((each) => each.matches('button, select, input, a')).length,
      };
    });
    assert.ok(seen.numbers <= 12 && seen.controls <= 8 && seen.words <= 40, JSON.stringify(seen));
    assert.deepEqual(await page.evaluate(misfits), []);
  });

  it('gives the picture four fifths of a laptop, and nothing moves with its digits', async () => {
    const dashboard = await open();
    await dashboard.page.setViewportSize(LAPTOP.viewport);
    const { width, height } = await box(dashboard, '.stage');
    assert.ok(width * height >= 0.8 * 1366 * 768, `${width} x ${height}`);
    const places = () =>
      dashboard.page.locator('.strip > *').evaluateAll((all) => all.map((each) => Math.round(each.offsetLeft)));
    const [first, speed] = [await places(), await dashboard.text('speed')];
    await dashboard.until('speed', (now) => now.length !== speed.length || now !== speed, 'another speed');
    assert.deepEqual(await places(), first);
  });
});

describe('the page', () => {
  it('changes between light and dark, remembers it, and is fine for axe in both', async () => {
    const dashboard = await open();
    const { page } = dashboard;
    const light = await background(page);
    await page.locator('body').press('t');
    const dark = await background(page);
    assert.notEqual(dark, light);
    await page.reload();
    await page.getByText('Live', { exact: true }).waitFor();
    assert.equal(await background(page), dark);
    for (const mode of ['watch', 'try']) {
      await dashboard.show(mode);
      assert.deepEqual(await dashboard.accessibilityFindings(undefined, 'all'), [], `${mode}, dark`);
    }
    await dashboard.fromMenu('Light colours');
    assert.equal(await background(page), light);
    for (const mode of ['watch', 'try']) {
      await dashboard.show(mode);
      assert.deepEqual(await dashboard.accessibilityFindings(undefined, 'all'), [], `${mode}, light`);
    }
  });

  it('is for fingers on a phone: nothing under 44 px', async () => {
    const dashboard = await DashboardPage.open(here.browser, here.drive.url, PHONE);
    const { page } = dashboard;
    for (const mode of MODES) {
      await dashboard.show(mode);
      const small = await page.locator('button, select, input[type="range"]').evaluateAll((all) =>
        all
          .filter((each) => each.checkVisibility())
          .map((each) => ({ each, height: Math.round(each.getBoundingClientRect().height) }))
          .filter(({ height }) => height > 0 && height < 44)
          .map(({ each, height }) => `${each.textContent || each.ariaLabel}: ${height}`),
      );
      assert.deepEqual(small, [], mode);
    }
    await dashboard.show('watch');
    await dashboard.fromMenu('Keys and help');
    await page.getByRole('dialog').waitFor();
    await dashboard.button('Close').click();
    await dashboard.close(isAboutGraphics);
  });
});
