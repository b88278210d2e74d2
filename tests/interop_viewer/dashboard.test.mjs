// SPDX-License-Identifier: MIT
// The dashboard as a reader meets it: headless Chromium, the program's own server, a car on rails.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { after, afterEach, before, beforeEach, describe, it } from 'node:test';
import { launch } from './browser.mjs';
import { startDemo } from './viewer_demo.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

let browser;
let demo;
let context;
let page;
let complaints; // of the browser's console

before(async () => {
  browser = await launch();
  demo = await startDemo();
});
after(async () => {
  await browser.close();
  await demo.stop();
});

async function open(options = {}) {
  context = await browser.newContext({ viewport: { width: 1366, height: 768 }, colorScheme: 'light', ...options });
  page = await context.newPage();
  complaints = [];
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('response', (response) => {
    if (response.status() >= 400) complaints.push(`${response.status()} ${response.url()}`);
  });
  await page.goto(demo.url);
  await page.getByText('Live', { exact: true }).waitFor();
}

const text = (id) => page.getByTestId(id).innerText();
const seconds = async () => {
  const [minutes, rest] = (await text('lap-time')).split(':').map(Number);
  return 60 * minutes + rest;
};
/** Waits until `read` gives something that `accept` accepts. */
async function until(read, accept, what) {
  const end = Date.now() + 8000;
  for (;;) {
    const value = await read();
    if (accept(value)) return value;
    assert.ok(Date.now() < end, `${what}: still ${value}`);
    await page.waitForTimeout(50);
  }
}
const differentFrom = (before) => (now) => now !== before;
/** How many different colours a canvas shows. */
const colours = (selector) =>
  page.locator(selector).first().evaluate((canvas) => {
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(data.buffer)).size;
  });
async function accessibilityFindings() {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => globalThis.axe.run());
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target).join(', ')}`);
}

describe('the dashboard', () => {
  beforeEach(() => open());
  afterEach(async () => {
    assert.deepEqual(complaints, []);
    await context.close();
  });

  it('loads and says what runs', async () => {
    assert.equal(await page.locator('html').getAttribute('lang'), 'en');
    assert.equal(await page.locator('main').count(), 1);
    assert.match(await page.locator('h1').innerText(), /chicane/);
    assert.match(await page.locator('.summary').innerText(), /tracking-mpc · udacity · demo road · 100 ms latency/);
    assert.equal(await text('rung'), 'The controller drives');
    assert.equal(await text('status'), 'Optimal, 3 iterations');
    assert.equal(await text('gate'), 'Passed the command unchanged');
    assert.equal(await text('road'), 'On the road, never off it');
  });

  it('shows a car that moves and numbers that change', async () => {
    const picture = () => page.locator('.map canvas').evaluate((canvas) => canvas.toDataURL());
    const [firstPicture, firstTime, firstError] = [await picture(), await seconds(), await text('lateral-error')];
    await until(seconds, (now) => now > firstTime + 0.5, 'lap time');
    await until(picture, differentFrom(firstPicture), 'map');
    await until(() => text('lateral-error'), differentFrom(firstError), 'lateral error');
    await until(async () => Number(await text('speed')), (speed) => speed > 5, 'speed in mph');
    assert.ok((await colours('.map canvas')) > 20, 'the map shows road, car and plan');
    assert.equal(await page.locator('.plot canvas').count(), 4);
    assert.ok((await colours('.plot canvas')) > 5, 'the plots show lines');
  });

  it('pauses, steps, resumes and resets by its buttons', async () => {
    await page.getByRole('button', { name: 'Pause' }).click();
    await page.getByText('Paused', { exact: true }).waitFor();
    await page.waitForTimeout(300); // the last frame before the pause, and the text's own pace
    const paused = await seconds();
    await page.waitForTimeout(300);
    assert.equal(await seconds(), paused);
    await page.getByRole('button', { name: 'Step' }).click();
    const stepped = await until(seconds, differentFrom(paused), 'lap time after a step');
    assert.equal(stepped.toFixed(2), (paused + 0.04).toFixed(2));
    await page.getByRole('button', { name: 'Reset' }).click();
    await until(seconds, (now) => now === 0, 'lap time after a reset');
    await page.getByRole('button', { name: 'Resume' }).click();
    await until(seconds, (now) => now > 0.2, 'lap time after going on');
    assert.equal(await page.getByRole('button', { name: 'Step' }).isDisabled(), true);
  });

  it('obeys the keyboard', async () => {
    const pressed = () => page.locator('[aria-label="View"] [aria-pressed="true"]').innerText();
    assert.equal(await pressed(), 'Chase');
    await page.keyboard.press('c');
    await until(pressed, (name) => name === 'North up', 'view');
    await page.keyboard.press('c');
    await until(pressed, (name) => name === 'Whole track', 'view');
    await page.keyboard.press('Space');
    await page.getByText('Paused', { exact: true }).waitFor();
    await page.keyboard.press('Space');
    await page.getByText('Live', { exact: true }).waitFor();
    await page.keyboard.press('Tab');
    assert.equal(await page.evaluate(() => document.activeElement?.textContent), 'Pause');
    await page.keyboard.press('Space'); // presses the button, once
    await page.getByText('Paused', { exact: true }).waitFor();
    await page.keyboard.press('Enter');
    await page.getByText('Live', { exact: true }).waitFor();
  });

  it('lets a pause of one viewer be seen by another', async () => {
    const other = await context.newPage();
    await other.goto(demo.url);
    await other.getByText('Live', { exact: true }).waitFor();
    await page.getByRole('button', { name: 'Pause' }).click();
    await other.getByText('Paused', { exact: true }).waitFor();
    await other.getByRole('button', { name: 'Resume' }).click();
    await page.getByText('Live', { exact: true }).waitFor();
  });

  it('has nothing that axe objects to', async () => {
    assert.deepEqual(await accessibilityFindings(), []);
  });
});

it('is dark for readers who like it dark, with nothing that axe objects to', async () => {
  await open({ colorScheme: 'dark' });
  const ground = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = Math.max(...ground.match(/\d+/g).map(Number));
  assert.ok(light < 40, ground);
  assert.deepEqual(await accessibilityFindings(), []);
  await page.emulateMedia({ colorScheme: 'light' });
  const corner = () =>
    page.locator('.map canvas').evaluate((canvas) => [...canvas.getContext('2d').getImageData(2, canvas.height - 2, 1, 1).data]);
  await until(corner, ([red]) => red > 200, 'the map turns light with the page');
  assert.deepEqual(complaints, []);
  await context.close();
});

it('fits a phone', async () => {
  await open({ viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
  const { width, content } = await page.evaluate(() => ({ width: innerWidth, content: document.documentElement.scrollWidth }));
  assert.ok(content <= width, `${content} px of content on ${width} px`);
  const sizes = await page.locator('p, dd, dt, button').evaluateAll((all) => all.map((each) => parseFloat(getComputedStyle(each).fontSize)));
  assert.ok(Math.min(...sizes) >= 12, `smallest text ${Math.min(...sizes)} px`);
  assert.deepEqual(await accessibilityFindings(), []);
  assert.deepEqual(complaints, []);
  await context.close();
});

it('says when the connection is lost, and comes back by itself', async () => {
  await open();
  const { port } = demo;
  await demo.stop();
  await page.getByTestId('banner').waitFor();
  assert.match(await text('banner'), /Connection lost/);
  assert.deepEqual(await accessibilityFindings(), []);
  demo = await startDemo(port);
  await page.getByTestId('banner').waitFor({ state: 'detached' });
  const first = await seconds();
  await until(seconds, (now) => now > first || now < first, 'lap time after coming back');
  assert.equal(await page.locator('.plot canvas').count(), 4);
  // What browsers always say of a socket that cannot connect is the only complaint.
  assert.deepEqual(complaints.filter((each) => !each.startsWith('WebSocket connection to')), []);
  await context.close();
});
