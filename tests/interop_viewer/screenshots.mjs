// SPDX-License-Identifier: MIT
// Pictures of a running dashboard for the documentation:
//   node screenshots.mjs http://127.0.0.1:4567/ ../../docs/figures [seconds to wait]
import { argv } from 'node:process';
import { launch } from './browser.mjs';

const [url = 'http://127.0.0.1:4567/', folder = '.', wait = '20'] = argv.slice(2);

const PICTURES = [
  { name: 'dashboard', size: [1440, 900], colorScheme: 'light' },
  { name: 'dashboard_dark', size: [1440, 900], colorScheme: 'dark', keys: ['c', 'c'] },
  { name: 'dashboard_phone', size: [390, 844], colorScheme: 'light', deviceScaleFactor: 2 },
];

const browser = await launch();
const pages = [];
for (const { name, size, keys = [], ...options } of PICTURES) {
  const context = await browser.newContext({ viewport: { width: size[0], height: size[1] }, ...options });
  const page = await context.newPage();
  await page.goto(url);
  for (const key of keys) await page.keyboard.press(key);
  pages.push({ name, page });
}
await pages[0].page.waitForTimeout(Number(wait) * 1000);
for (const { name, page } of pages) {
  await page.bringToFront();
  await page.waitForTimeout(300);
  await page.screenshot({ path: `${folder}/${name}.png` });
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

for (const { name, camera, colorScheme, part = 'body' } of SCENES) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, colorScheme });
  await context.addInitScript(pretendCard);
  await context.addInitScript((value) => localStorage.setItem('chicane.camera', JSON.stringify(value)), camera);
  const page = await context.newPage();
  await page.goto(url);
  await page.locator('.map.has-3d').waitFor();
  await page.waitForTimeout(8000);
  await page.locator(part).screenshot({ path: `${folder}/${name}.png` });
  await context.close();
}
await browser.close();
