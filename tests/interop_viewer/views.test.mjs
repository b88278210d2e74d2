// SPDX-License-Identifier: MIT
// Every view on a phone and a laptop, which leave the least room (CHICANE_EVERY_SIZE=1: at every size), in both
// themes: nothing that axe objects to, nothing cut off, covered or printed over, and nothing on the browser's console.
import assert from 'node:assert/strict';
import { after, before, it } from 'node:test';
import { misfits } from './fit.mjs';
import { browserAlone } from './here.mjs';
import { SIZES, startScenes, THEMES, walk } from './views.mjs';

const here = browserAlone();
let scenes;
before(async () => {
  scenes = await startScenes();
});
after(() => scenes?.stop());

/** Runs in the page: of what is printed [px]. */
const smallestText = () =>
  Math.min(
    ...[...document.querySelectorAll('p, dd, dt, button, td, th, label')].map((each) =>
      parseFloat(getComputedStyle(each).fontSize),
    ),
  );

const sizes = process.env.CHICANE_EVERY_SIZE ? Object.keys(SIZES) : ['phone', 'laptop'];
for (const size of sizes) {
  const shape = SIZES[size];
  // The colours of a theme are the same at every size.
  const themes = size === 'phone' && !process.env.CHICANE_EVERY_SIZE ? THEMES.slice(0, 1) : THEMES;
  it(`shows every view well at ${shape.viewport.width} x ${shape.viewport.height}, a ${size}`, async () => {
    const findings = {};
    const note = (name, found) => {
      if (found.length > 0) findings[name] = found;
    };
    for (const group of scenes.groups) {
      await walk(here.browser, group, shape, async (dashboard, name, part) => {
        const { page } = dashboard;
        const { across, down } = await dashboard.overflow();
        assert.ok(across <= 0 && (down <= 0 || name === 'report'), `${name} fits the window: ${across}, ${down}`);
        if (size === 'phone') {
          const smallest = await page.evaluate(smallestText);
          assert.ok(smallest >= 12, `${name}: smallest text ${smallest} px`);
        }
        note(name, await page.evaluate(misfits));
        for (const theme of themes) {
          await page.emulateMedia({ colorScheme: theme });
          // The theme changes colours alone: all rules once, those of colours in both.
          const rules = theme === THEMES[0] ? undefined : ['color-contrast'];
          note(`${name}, ${theme}`, await dashboard.accessibilityFindings(rules, part));
        }
      });
    }
    assert.deepEqual(findings, {});
  });
}
