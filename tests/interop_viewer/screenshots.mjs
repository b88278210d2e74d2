// SPDX-License-Identifier: MIT
// Pictures of a running dashboard for the documentation:
//   node screenshots.mjs http://127.0.0.1:4567/ ../../docs/figures [seconds to wait] [only these names]
import { argv } from 'node:process';
import { launch } from './browser.mjs';

const [url = 'http://127.0.0.1:4567/', folder = '.', wait = '20', ...names] = argv.slice(2);
const isWanted = ({ name }) => names.length === 0 || names.includes(name);

/** The workbench, all pages watching the same run; `prepare` is done just before the picture, `undo` after it. */
const LAPTOP = [1440, 900];
const PICTURES = [
  { name: 'dashboard', mode: 'watch', size: LAPTOP, colorScheme: 'light' },
  {
    name: 'dashboard_explain',
    mode: 'understand',
    size: LAPTOP,
    colorScheme: 'dark',
    prepare: (page) => engineer(page, '.engineer-parts .blocks'),
  },
  { name: 'dashboard_laps', mode: 'understand', size: LAPTOP, colorScheme: 'light' },
  {
    name: 'dashboard_plots',
    mode: 'understand',
    size: LAPTOP,
    colorScheme: 'dark',
    prepare: (page) => engineer(page, '.plots-view'),
  },
  { name: 'dashboard_what_if', mode: 'try', size: [1366, 900], colorScheme: 'light', prepare: whatIf },
  {
    name: 'dashboard_phone',
    mode: 'watch',
    size: [390, 844],
    colorScheme: 'light',
    deviceScaleFactor: 2,
    isMobile: true,
    hasTouch: true,
    prepare: (page) => page.keyboard.press('m'),
    undo: (page) => page.keyboard.press('Escape'),
  },
];

/** What solver and controller did, from a part of it on. */
async function engineer(page, part) {
  await page.keyboard.press('e');
  await page.locator(part).evaluate((each) => each.scrollIntoView());
}

async function whatIf(page) {
  await page.getByRole('button', { name: 'A second car' }).click();
  const box = page.locator('.sliders [data-key="latency_ms"] .number-box');
  await box.fill('250');
  await box.press('Enter');
  await page.getByText('Drive both', { exact: true }).click();
  await page.getByTestId('what-if-verdict').waitFor();
}

const browser = await launch();
const pages = [];
for (const { name, mode, size, prepare, undo, ...options } of PICTURES.filter(isWanted)) {
  const context = await browser.newContext({ viewport: { width: size[0], height: size[1] }, ...options });
  const page = await context.newPage();
  await page.addInitScript(() => localStorage.setItem('chicane.camera', '"track"'));
  await page.goto(`${url}#${mode}`);
  pages.push({ name, page, prepare, undo });
}
await pages[0]?.page.locator('.speed').waitFor();
await pages[0]?.page.keyboard.press('r');
await pages[0]?.page.waitForTimeout(Number(wait) * 1000);
for (const { name, page, prepare, undo } of pages) {
  await page.bringToFront();
  await prepare?.(page);
  await page.waitForTimeout(prepare ? 1200 : 300);
  await page.screenshot({ path: `${folder}/${name}.png` });
  await undo?.(page);
}
for (const { page } of pages) await page.close();

/** In three dimensions, one after another: the processor draws. */
const SCENES = [
  { name: 'scene3d', camera: 'chase', colorScheme: 'light' },
  { name: 'scene3d_cockpit', camera: 'cockpit', colorScheme: 'light', part: '.map' },
  { name: 'scene3d_dark', camera: 'free', colorScheme: 'dark', part: '.map' },
];

/** The picture as a graphics card would draw it: slowly here, but in full. */
const pretendCard = () => {
  const ask = WebGL2RenderingContext.prototype.getParameter;
  WebGL2RenderingContext.prototype.getParameter = function (name) {
    return name === 0x9246 ? 'graphics card' : ask.call(this, name); // UNMASKED_RENDERER_WEBGL
  };
};

for (const { name, camera, colorScheme, part = 'body' } of SCENES.filter(isWanted)) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, colorScheme });
  await context.addInitScript(pretendCard);
  await context.addInitScript((value) => localStorage.setItem('chicane.camera', JSON.stringify(value)), camera);
  const page = await context.newPage();
  await page.goto(url);
  await page.locator('.map.has-3d').waitFor({ timeout: 120_000 });
  await page.waitForTimeout(8000);
  const clip = await page.locator(part).boundingBox();
  await page.screenshot({ path: `${folder}/${name}.png`, clip, timeout: 120_000 });
  await context.close();
}
await browser.close();
