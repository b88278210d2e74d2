// SPDX-License-Identifier: MIT
// Every view on a phone or a laptop, which leave the least room: nothing that axe objects to, nothing cut off, covered
// or printed over, and nothing on the browser's console. On the phone, in the light, those that are soon reached; on
// the laptop, in the dark, the others and the modes; with CHICANE_SLOW_TESTS all, in both themes, at every size.
import assert from 'node:assert/strict';
import { after, before, it } from 'node:test';
import { EVERY_SIZE, MODES } from './dashboard_page.mjs';
import { misfits } from './fit.mjs';
import { browserAlone } from './here.mjs';
import { SIZES, startScenes, walk } from './views.mjs';

const here = browserAlone();
let scenes;
before(async () => {
  scenes = await startScenes();
});
after(() => scenes?.stop());

/** The sizes of text that tokens.css has [px]; the map of lost time has units of its own. */
const SIZES_OF_TEXT = ['12px', '14px', '18px', '28px', '44px'];
/** Runs in the page: the sizes that it uses. */
const sizesOfText = () => {
  const all = [...document.querySelectorAll('#app :not(.loss-map *)')].filter((each) => each.checkVisibility());
  return [...new Set(all.map((each) => getComputedStyle(each).fontSize))];
};

const COLOURS = 'color-contrast';
/** Themes and rules to look at. The theme changes colours alone, and those of a theme are the same at every size. */
function themesAndRules(size) {
  if (EVERY_SIZE) return { light: 'all', dark: [COLOURS] };
  return size === 'phone' ? { light: 'all' } : { dark: 'all' };
}

const sizes = EVERY_SIZE ? Object.keys(SIZES) : ['phone', 'laptop'];
for (const size of sizes) {
  const shape = SIZES[size];
  it(`shows every view well at ${shape.viewport.width} x ${shape.viewport.height}, a ${size}`, async () => {
    const findings = {};
    const note = (name, found) => {
      if (found.length > 0) findings[name] = found;
    };
    for (const group of scenes.groups) {
      await walk(
        here.browser,
        group,
        shape,
        async (dashboard, name, part) => {
          const { page } = dashboard;
          const { across, down } = await dashboard.overflow();
          assert.ok(across <= 0 && (down <= 0 || name === 'report'), `${name} fits the window: ${across}, ${down}`);
          const others = (await page.evaluate(sizesOfText)).filter((each) => !SIZES_OF_TEXT.includes(each));
          note(`${name}, sizes of text`, others);
          note(name, await page.evaluate(misfits));
          for (const [colorScheme, rules] of Object.entries(themesAndRules(size))) {
            await page.emulateMedia({ colorScheme });
            note(`${name}, ${colorScheme}`, await dashboard.accessibilityFindings(part, rules));
          }
        },
        ({ name, isLong }) => EVERY_SIZE || (size === 'phone' ? !isLong : isLong || MODES.includes(name)),
      );
    }
    assert.deepEqual(findings, {});
  });
}
