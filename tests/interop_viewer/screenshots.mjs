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
await browser.close();
