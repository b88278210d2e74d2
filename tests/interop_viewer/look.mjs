// SPDX-License-Identifier: MIT
// A picture of every view at every size in both themes, to be looked at:
//   CHICANE=/path/to/chicane node look.mjs FOLDER [only these sizes, with commas] [only this theme]
import { mkdirSync } from 'node:fs';
import { argv } from 'node:process';
import { launch } from './browser.mjs';
import { SIZES, startScenes, THEMES, walk } from './views.mjs';

const [folder = 'views', onlySizes, onlyTheme] = argv.slice(2);
mkdirSync(folder, { recursive: true });
const browser = await launch();
const scenes = await startScenes();
for (const [size, shape] of Object.entries(SIZES)) {
  if (onlySizes && !onlySizes.split(',').includes(size)) continue;
  for (const group of scenes.groups) {
    await walk(browser, group, shape, async ({ page }, name) => {
      for (const colorScheme of THEMES) {
        if (onlyTheme && colorScheme !== onlyTheme) continue;
        await page.emulateMedia({ colorScheme });
        await page.waitForTimeout(700); // plots and map are painted a moment later
        await page.screenshot({ path: `${folder}/${name.replaceAll(' ', '_')}.${size}.${colorScheme}.png` });
      }
    });
  }
  console.log(size);
}
await scenes.stop();
await browser.close();
