// SPDX-License-Identifier: MIT
// A dashboard in a headless browser, with what its tests ask of it.
import assert from 'node:assert/strict';
import { once } from 'node:events';
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { setTimeout as sleep } from 'node:timers/promises';
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
/** The modes that the dashboard has. */
const listed = readFileSync(new URL('../../web/src/state/mode.ts', import.meta.url), 'utf8');
export const MODES = [.../MODES = \[(.*)\]/.exec(listed)[1].matchAll(/\w+/g)].map(String);
assert.equal(MODES.length, 3, 'mode.ts lists its modes otherwise than these tests read them');
/** What stands in the strip, which Watch alone has. */
const IN_STRIP = 'speed lap lap-time wheels pedal delta-limit why end-title end-laps'.split(' ');

/** Every size, theme and colour is looked at: a campaign (./test.sh --all). */
export const EVERY_SIZE = Boolean(process.env.CHICANE_SLOW_TESTS);

/** Between two repaints of a page [ms]: drawing costs much without a graphics card. */
const REPAINT_MS = 250;

/** An init script: the page draws once in `interval` [ms], and not while `isHeld`. */
function repaintSeldom(interval) {
  const due = new Map();
  let last = 0;
  globalThis.requestAnimationFrame = (draw) => {
    due.set(++last, draw);
    return last;
  };
  globalThis.cancelAnimationFrame = (which) => due.delete(which);
  setInterval(() => {
    if (globalThis.isHeld) return;
    const drawings = [...due.values()];
    due.clear();
    for (const draw of drawings) draw(performance.now());
  }, interval);
}

/**
 * Pages that tests have left, by the browser and the options that a page keeps for life. To load the page anew in one
 * of them takes a quarter of the processor time of a context of its own.
 */
const left = new WeakMap();
/** What they show meanwhile: a page of the same site as the program's, for which the browser keeps its process. */
let restingPlace = null;
async function rest() {
  if (restingPlace === null) {
    restingPlace = createServer((_, response) => response.end()).listen(0, '127.0.0.1');
    await once(restingPlace, 'listening');
    restingPlace.unref();
  }
  return `http://127.0.0.1:${restingPlace.address().port}/`;
}

/** The sentence above a comparison, without what its words can be chosen from. */
export const headline = (page) =>
  page.getByTestId('headline').evaluate((heading) => {
    const copy = heading.cloneNode(true);
    for (const choice of copy.querySelectorAll('select')) choice.remove();
    return copy.textContent;
  });

export const differentFrom = (before) => (now) => now !== before;
export const atLeast = (least) => (now) => now >= least;
export const above = (bound) => (now) => now > bound;
export const below = (bound) => (now) => now < bound;

export class DashboardPage {
  /**
   * Opens the page in a mode and waits until it says that it is live, or in another `state`; the browser keeps nothing
   * of tests before. What the browser complains of is kept in `complaints`. The page draws four times a second without
   * moving parts, or with `fluent` as often as the browser repaints and with all that moves. It runs `script` first.
   */
  static async open(browser, url, { mode = 'watch', state = 'Live', fluent = false, script, ...options } = {}) {
    const shape = { ...LAPTOP, ...options };
    const { viewport, colorScheme, ...kept } = shape;
    const key = JSON.stringify([fluent, `${script}`, kept]);
    const shelf = left.get(browser) ?? left.set(browser, new Map()).get(browser);
    const dashboard = shelf.get(key) ?? (await DashboardPage.#fresh(browser, shape, fluent, script));
    shelf.delete(key);
    await dashboard.page.setViewportSize(viewport);
    await dashboard.page.emulateMedia({ colorScheme, reducedMotion: fluent ? null : 'reduce' });
    dashboard.leave = async () => {
      const { page } = dashboard;
      for (const other of page.context().pages()) if (other !== page) await other.close();
      await page.evaluate(() => localStorage.clear()).catch(() => undefined); // a file has none
      dashboard.home = null;
      await page.goto(await rest());
      await page.emulateMedia({ media: null, reducedMotion: null });
      shelf.set(key, dashboard);
    };
    dashboard.complaints.length = 0;
    dashboard.home = new URL(url).origin;
    await dashboard.page.goto(`${url}#${mode}`);
    await dashboard.page.getByText(state, { exact: true }).first().waitFor();
    return dashboard;
  }

  static async #fresh(browser, shape, fluent, script) {
    const context = await browser.newContext(shape);
    context.setDefaultTimeout(PATIENCE);
    const page = await context.newPage();
    if (!fluent) await page.addInitScript(repaintSeldom, REPAINT_MS);
    if (script) await page.addInitScript(script);
    const complaints = [];
    page.on('console', (message) => {
      if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
    });
    page.on('pageerror', (error) => complaints.push(String(error)));
    page.on('response', (response) => {
      if (response.status() >= 400) complaints.push(`${response.status()} ${response.url()}`);
    });
    const dashboard = new DashboardPage(page, complaints);
    page.on('request', (request) => {
      const isElsewhere = /^(https?|wss?):/.test(request.url()) && new URL(request.url()).origin !== dashboard.home;
      if (dashboard.home !== null && isElsewhere) complaints.push(`asked for ${request.url()}`);
    });
    return dashboard;
  }

  constructor(page, complaints) {
    this.page = page;
    this.complaints = complaints;
    this.home = null; // of the page: it may ask for nothing elsewhere
    this.leave = () => page.context().close();
  }

  /** Asserts that the browser had nothing to complain of, but for `expected`. */
  hadNothingToComplainOf(expected = () => false) {
    assert.deepEqual(
      this.complaints.filter((each) => !expected(each)),
      [],
    );
  }

  /** Ends with that assertion. */
  async close(expected) {
    await this.leave();
    this.hadNothingToComplainOf(expected);
  }

  /** A text by its test id; for one of the strip, another mode is left as long as it is read. */
  async text(id) {
    const read = () => this.page.getByTestId(id).innerText();
    const mode = await this.page.locator('main[data-mode]').getAttribute('data-mode');
    if (mode === 'watch' || !IN_STRIP.includes(id)) return read();
    await this.show('watch');
    const text = await read();
    await this.show(mode);
    return text;
  }

  async number(id) {
    return Number((await this.text(id)).replace('−', '-'));
  }
  /** What the strip says of the speed, in the reader's unit. */
  speed = () => this.number('speed');

  /** The lap clock. */
  seconds = async () => {
    const [minutes, rest] = (await this.text('lap-time')).split(':').map(Number);
    return 60 * minutes + rest;
  };

  async show(mode) {
    if (await this.page.locator('#menu:popover-open').count()) await this.page.keyboard.press('Escape');
    await this.page.locator(`#mode-${mode}`).click();
  }

  /** Of a page that several tests use: a mode as it is after loading, with nothing focused. */
  async beginAt(mode) {
    await this.show(mode);
    await this.page.evaluate(() => document.activeElement.blur());
  }

  /** Understand, with what solver and controller did. */
  async showEngineer() {
    await this.show('understand');
    const choice = this.page.getByRole('switch', { name: 'Engineer' });
    if (!(await choice.isChecked())) await this.page.locator('body').press('e');
    await this.page.locator('.plot').first().waitFor();
  }

  /** The rows of the table of all laps in Understand, without the limit; the table is folded. */
  lapRows() {
    return this.page.getByTestId('lap-rows').locator('tbody tr:not(.limit)');
  }
  laps = () => this.lapRows().count();

  /** Chooses what the menu has, and leaves it: after a pace it stays open, over what is below. */
  async fromMenu(name) {
    if ((await this.page.locator('#menu:popover-open').count()) === 0) await this.page.locator('.name').click();
    await this.page.locator('#menu').getByRole('button', { name }).click();
    await this.page.evaluate(() => document.querySelector('#menu:popover-open')?.hidePopover());
  }

  /** Puts the car to the start, whatever box was typed into last. */
  async startAgain() {
    await this.page.evaluate(() => document.activeElement.blur());
    await this.page.locator('body').press('r');
  }

  /** Chooses a camera by its name. */
  camera(label) {
    return this.page.getByLabel('Camera', { exact: true }).selectOption({ label });
  }

  /** What is driven: controller, preset, car, track, latency, guard. */
  summary = () => this.page.locator('.run').getAttribute('title');

  /** The row of a setting in Try: what is searched for is found. */
  async setting(key) {
    await this.show('try');
    await this.page.locator('#search').fill(key);
    return this.page.locator(`.sliders [data-key="${key}"]`);
  }

  /** Types a value of a setting, as a reader would. */
  async type(key, value) {
    const box = (await this.setting(key)).locator('.number-box');
    await box.fill(String(value));
    await box.press('Enter');
  }

  /** Lets what is typed belong to the run, or to the second car. */
  aimAt(target) {
    return this.button(target === 'run' ? 'This run' : 'A second car').click();
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
      await sleep(500);
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

  /**
   * Waits until `read`, a function or a test id, gives something that `accept`, a function, an expression or a value,
   * accepts: looks soon again at first, then ever less often.
   */
  async until(read, accept, what) {
    const end = Date.now() + PATIENCE;
    const isGood = accept instanceof RegExp ? (text) => accept.test(text) : (value) => value === accept;
    for (let pause = 50; ; pause = Math.min(1.5 * pause, 400)) {
      const value = await (typeof read === 'string' ? this.text(read) : read());
      if (typeof accept === 'function' ? accept(value) : isGood(value)) return value;
      assert.ok(Date.now() < end, `${what}: still ${value}`);
      await sleep(pause);
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

  /**
   * What axe objects to; `part`: a selector of the only part that is looked at; `rules`: only these, or 'all'. Without
   * it, the rule of contrast is used with CHICANE_SLOW_TESTS alone: it takes two thirds of the time, and
   * views.test.mjs uses it at every view.
   */
  async accessibilityFindings(part, rules) {
    if (!(await this.page.evaluate(() => 'axe' in globalThis))) await this.page.evaluate(axe);
    // Limits what axe describes of elements without findings, and what it loads; the findings are the same.
    const options = { resultTypes: ['violations'], preload: false };
    if (Array.isArray(rules)) options.runOnly = rules;
    else if (rules !== 'all' && !EVERY_SIZE) options.rules = { 'color-contrast': { enabled: false } };
    const { violations } = await this.page.evaluate(
      async ([within, given]) => {
        globalThis.isHeld = true;
        const result = await globalThis.axe.run(within ?? document, given);
        globalThis.isHeld = false;
        return result;
      },
      [part, options],
    );
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
