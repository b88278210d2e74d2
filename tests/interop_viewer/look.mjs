// SPDX-License-Identifier: MIT
// A picture of every view at every size in both themes, to be looked at:
//   CHICANE=/path/to/chicane node look.mjs FOLDER [only this size] [only this theme]
import { mkdirSync } from 'node:fs';
import { argv } from 'node:process';
import { launch } from './browser.mjs';
import { SIZES, startScenes, THEMES, walk } from './views.mjs';

const [folder = 'views', onlySize, onlyTheme] = argv.slice(2);
mkdirSync(folder, { recursive: true });
const browser = await launch();
const scenes = await startScenes();
for (const [size, shape] of Object.entries(SIZES)) {
  if (onlySize && size !== onlySize) continue;
  for (const colorScheme of THEMES) {
    if (onlyTheme && colorScheme !== onlyTheme) continue;
    for (const group of scenes.groups) {
      await walk(browser, group, { ...shape, colorScheme }, async ({ page }, name) => {
        await page.waitForTimeout(700); // plots and map are painted a moment later
        await page.screenshot({ path: `${folder}/${name.replaceAll(' ', '_')}.${size}.${colorScheme}.png` });
      });
    }
    console.log(`${size} ${colorScheme}`);
  }
}
await scenes.stop();
await browser.close();
