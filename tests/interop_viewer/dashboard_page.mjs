// SPDX-License-Identifier: MIT
// A dashboard in a headless browser, with what its tests ask of it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { PATIENCE } from './patience.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

export const LAPTOP = { viewport: { width: 1366, height: 768 }, colorScheme: 'light' };
export const PHONE = {
  viewport: { width: 390, height: 844 },
  colorScheme: 'light',
  deviceScaleFactor: 2,
  isMobile: true,
  hasTouch: true,
};
/** The panels that the dashboard has. */
const workbench = readFileSync(new URL('../../web/src/views/workbench_view.tsx', import.meta.url), 'utf8');
export const TABS = [...workbench.matchAll(/^ {2}\{ name: '(\w+)', title: /gm)].map((row) => row[1]);
assert.ok(TABS.length >= 6, 'workbench_view.tsx lists its panels otherwise than these tests read them');

/** An init script: the page draws ten times a second. Drawing costs much without a graphics card. */
function repaintSeldom() {
  globalThis.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 100);
  globalThis.cancelAnimationFrame = clearTimeout;
}

export const differentFrom = (before) => (now) => now !== before;

export class DashboardPage {
  /**
   * Opens the page at a tab and waits until it says that it is live, or in another `state`. What the browser complains
   * of is kept in `complaints`. The page draws ten times a second, or with `fluent` as often as the browser repaints.
   */
  static async open(browser, url, { tab = 'drive', state = 'Live', fluent = false, ...options } = {}) {
    const context = await browser.newContext({ ...LAPTOP, ...options });
    context.setDefaultTimeout(PATIENCE);
    const page = await context.newPage();
    if (!fluent) await page.addInitScript(repaintSeldom);
    const complaints = [];
    page.on('console', (message) => {
      if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
    });
    page.on('pageerror', (error) => complaints.push(String(error)));
    page.on('response', (response) => {
      if (response.status() >= 400) complaints.push(`${response.status()} ${response.url()}`);
    });
    await page.goto(`${url}#${tab}`);
    const dashboard = new DashboardPage(page, complaints);
    await page.getByText(state, { exact: true }).waitFor();
    return dashboard;
  }

  constructor(page, complaints) {
    this.page = page;
    this.complaints = complaints;
  }

  /** Ends with the assertion that the browser had nothing to complain of, but for `expected`. */
  async close(expected = () => false) {
    const complaints = this.complaints.filter((each) => !expected(each));
    await this.page.context().close();
    assert.deepEqual(complaints, []);
  }

  text(id) {
    return this.page.getByTestId(id).innerText();
  }

  async number(id) {
    return Number((await this.text(id)).replace('−', '-'));
  }

  /** The lap clock. */
  async seconds() {
    const [minutes, rest] = (await this.text('lap-time')).split(':').map(Number);
    return 60 * minutes + rest;
  }

  show(tab) {
    return this.page.locator(`#tab-${tab}`).click();
  }

  button(name) {
    return this.page.getByRole('button', { name, exact: true });
  }

  /** Stops the car and waits until the page has nothing new to show: the last frame may come after the answer. */
  async pause() {
    await this.button('Pause').click();
    await this.page.getByText('Paused', { exact: true }).waitFor();
    await this.settled(() => this.seconds());
  }

  /** Waits until `read` has given the same for half a second, and gives that. */
  async settled(read) {
    let last;
    const isSame = async () => {
      const before = last;
      last = await read();
      await this.page.waitForTimeout(500);
      return last === before;
    };
    await this.until(isSame, Boolean, 'is it still?');
    return last;
  }

  /**
   * Lets the car drive on, and waits until the program says that it does: a page that closes at once may not have
   * asked.
   */
  async resume() {
    await this.button('Resume').click();
    await this.button('Pause').waitFor();
  }

  /** Waits until `read` gives something that `accept` accepts. */
  async until(read, accept, what) {
    const end = Date.now() + PATIENCE;
    for (;;) {
      const value = await read();
      if (accept(value)) return value;
      assert.ok(Date.now() < end, `${what}: still ${value}`);
      await this.page.waitForTimeout(50);
    }
  }

  /** How many different colours a canvas shows. */
  colours(selector) {
    return this.page
      .locator(selector)
      .first()
      .evaluate((canvas) => {
        // From a copy: browsers complain of a canvas that is read again and again.
        const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height });
        const context = copy.getContext('2d', { willReadFrequently: true });
        context.drawImage(canvas, 0, 0);
        const { data } = context.getImageData(0, 0, copy.width, copy.height);
        return new Set(new Uint32Array(data.buffer)).size;
      });
  }

  /** What axe objects to; `rules`: only these. */
  async accessibilityFindings(rules) {
    if (!(await this.page.evaluate(() => 'axe' in globalThis))) await this.page.evaluate(axe);
    // Limits what axe describes of elements without findings; the findings are the same.
    const options = { resultTypes: ['violations'], ...(rules && { runOnly: rules }) };
    const { violations } = await this.page.evaluate((given) => globalThis.axe.run(given), options);
    return violations.map(
      ({ id, nodes }) =>
        `${id}: ${nodes.map(({ target, failureSummary }) => `${target} ${failureSummary}`).join(', ')}`,
    );
  }

  /** What lies beyond the window's right and lower edge [px]. */
  overflow() {
    return this.page.evaluate(() => ({
      across: document.documentElement.scrollWidth - innerWidth,
      down: document.documentElement.scrollHeight - innerHeight,
    }));
  }
}
