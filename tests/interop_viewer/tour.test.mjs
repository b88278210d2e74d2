// SPDX-License-Identifier: MIT
// The tours as a newcomer takes them: a step done on a real run, left and gone on with, by keyboard and on a phone.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { atLeast, DashboardPage, PHONE } from './dashboard_page.mjs';
import { browserAndDrive } from './here.mjs';

const here = browserAndDrive(['--track', 'lakeside', '--pace', '3']);

const tour = ({ page }) => page.getByTestId('tour');
const heading = (dashboard) => tour(dashboard).getByRole('heading').innerText();
const tasksDone = (dashboard) => tour(dashboard).locator('.tour-tasks .done').count();
const isDone = (dashboard, count, what) => dashboard.until(() => tasksDone(dashboard), atLeast(count), what);
const EFFECTS = 'What N, dt, weights and latency do';
const DASHBOARD = 'What the dashboard can do';
const choose = (dashboard, title) => tour(dashboard).getByRole('button', { name: title }).click();
/** On to the next step, which has this heading. */
async function next(dashboard, title) {
  await dashboard.button('Next').click();
  assert.equal(await heading(dashboard), title);
  assert.equal(await tasksDone(dashboard), 0);
  assert.ok(await dashboard.button('Next').isDisabled(), 'not before it is done');
}

it('goes on when the thing was done, from the first step to the last', async () => {
  let dashboard = await DashboardPage.open(here.browser, here.drive.url, { mode: 'understand' });
  let { page } = dashboard;
  await dashboard.fromMenu('Tour');
  assert.equal(await heading(dashboard), 'Tours');
  assert.match(
    await tour(dashboard).getByRole('listitem').first().innerText(),
    new RegExp(EFFECTS),
    'before all others',
  );
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  await choose(dashboard, DASHBOARD);
  assert.equal(await heading(dashboard), '1 of 7: Drive it yourself');
  assert.equal(await page.locator('#mode-watch').getAttribute('aria-current'), 'page', 'in the mode of the step');
  assert.ok(await dashboard.button('Next').isDisabled());
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  await page.keyboard.press('m');
  await page.keyboard.down('ArrowUp');
  await isDone(dashboard, 2, 'thirty metres by hand');
  await page.keyboard.up('ArrowUp');
  assert.match(await dashboard.text('why'), /^A person drives/m, 'beside the speed'); // or off the road, and so
  assert.match(await tour(dashboard).getByRole('status').innerText(), /All done/);

  await next(dashboard, '2 of 7: Let it drive');
  await page.keyboard.press('Escape');
  await isDone(dashboard, 1, 'the controller drives');
  await dashboard.startAgain();
  await isDone(dashboard, 2, 'a car that drives by itself');

  await next(dashboard, '3 of 7: Slow it');
  await dashboard.fromMenu('0.25×');
  await isDone(dashboard, 1, 'slow motion');
  assert.match(await tour(dashboard).getByRole('status').innerText(), /^Done: .*Next: Back/);
  await dashboard.fromMenu('1×');
  await isDone(dashboard, 2, 'the pace of before');

  await next(dashboard, '4 of 7: Blind it');
  for (const key of [']', ']', ']', '[']) await page.locator('body').press(key); // four times as fast
  await page.locator('[data-key="fault.link_lost"]').click();
  await isDone(dashboard, 2, 'a controller that sees again');

  await next(dashboard, '5 of 7: Break it');
  await dashboard.button('Leave the tour').click();
  await tour(dashboard).waitFor({ state: 'detached' });
  await page.reload();
  await dashboard.fromMenu('Go on with the tour, step 5 of 7');
  assert.equal(await heading(dashboard), '5 of 7: Break it');
  const stuck = page.locator('[data-key="fault.steering_stuck"]');
  await dashboard.until(
    async () => {
      if ((await stuck.getAttribute('aria-pressed')) === 'false') await stuck.click();
      return tasksDone(dashboard);
    },
    (done) => done >= 1,
    'a car off the road',
  );
  await dashboard.startAgain();
  await isDone(dashboard, 2, 'a car that drives again');

  await next(dashboard, '6 of 7: Tune it');
  await dashboard.type('tracking_mpc.speed_limit_mps', 15);
  await isDone(dashboard, 2, 'a changed setting');

  await next(dashboard, '7 of 7: Compare');
  await dashboard.aimAt('second');
  await dashboard.type('tracking_mpc.speed_limit_mps', 60);
  await page.getByText('Drive both', { exact: true }).click();
  await isDone(dashboard, 1, 'two futures');

  await dashboard.button('Next').click();
  assert.equal(await heading(dashboard), 'The tour is over');
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  await dashboard.button('Put everything back').click();
  await dashboard.show('try');
  await dashboard.aimAt('run');
  await page.getByText('No changes').waitFor();
  await dashboard.button('Close').click();
  await page.locator('.name').waitFor();
  await dashboard.close();
  dashboard = await DashboardPage.open(here.browser, here.drive.url, { mode: 'try' });
  ({ page } = dashboard);
  await page.getByText('No changes').waitFor();
  await dashboard.close();
});

it('can be taken with the keyboard alone, and says what was left out', async () => {
  const dashboard = await DashboardPage.open(here.browser, here.drive.url, { mode: 'understand' });
  const { page } = dashboard;
  await page.locator('.name').waitFor();
  // A car that drives meanwhile would finish "Let it drive", which then offers Next instead of Skip.
  await page.keyboard.press('Space');
  await page.getByText('Paused', { exact: true }).waitFor();
  await page.keyboard.press('h');
  const focused = () => page.evaluate(() => document.activeElement.textContent);
  await dashboard.until(focused, (text) => text === 'Tours', 'the list');
  for (let i = 0; i < 3; ++i) await page.keyboard.press('Tab'); // Leave, the first tour, the second
  assert.match(await focused(), new RegExp(DASHBOARD));
  await page.keyboard.press('Enter');
  for (const title of ['Drive', 'Let', 'Slow', 'Blind', 'Break', 'Tune', 'Compare']) {
    await dashboard.until(focused, (text) => text.match(/^\d of 7: (\w+)/)?.[1] === title, `the heading of ${title}`);
    for (let i = 0; i < 3; ++i) await page.keyboard.press('Tab'); // Tours, Leave
    assert.equal(await focused(), 'Skip');
    await page.keyboard.press('Enter');
  }
  await dashboard.until(focused, (text) => text === 'The tour is over', 'the end');
  assert.match(await tour(dashboard).innerText(), /Left out: Drive it yourself, .*, Compare\./);
  await page.keyboard.press('h');
  await tour(dashboard).waitFor({ state: 'detached' });
  await page.keyboard.press('Space');
  await page.getByText('Live', { exact: true }).waitFor();
  await dashboard.close();
});

it('changes N, dt, a weight and the latency, and sees what each does', async () => {
  const dashboard = await DashboardPage.open(here.browser, here.drive.url, { mode: 'understand' });
  const { page } = dashboard;
  await dashboard.fromMenu('Tour');
  await choose(dashboard, EFFECTS);
  assert.equal(await heading(dashboard), '1 of 6: Choose a controller to change');
  await page.getByLabel('Preset', { exact: true }).selectOption('fast-short-step');
  await dashboard.button('Restart').click();
  await isDone(dashboard, 2, 'the preset drives');
  for (let i = 0; i < 3; ++i) await page.locator('body').press(']'); // eight times as fast

  const effects = [
    ['2 of 6: N: look further ahead', 'cubic_mpc.horizon_steps', '40', '25'],
    ['3 of 6: dt: longer steps', 'cubic_mpc.step_length_s', '0.1', '0.025'],
    ['4 of 6: A weight: the cost of the pedal', 'cubic_mpc.weight_throttle', '160', '80'],
    ['5 of 6: Latency: more than it counts on', 'latency_ms', '300', '100'],
  ];
  for (const [title, key, value, start] of effects) {
    await next(dashboard, title);
    const box = page.locator(`.sliders [data-key="${key}"] .number-box`);
    assert.equal(await box.inputValue(), start, 'the value that the text names');
    await box.fill(value);
    await box.press('Enter');
    await isDone(dashboard, 2, `the effect of ${key}`);
    await box.fill(start);
    await box.press('Enter');
    await isDone(dashboard, 3, `${key} as it was`);
    await dashboard.startAgain();
  }

  await next(dashboard, '6 of 6: Compare: without the roll-forward');
  await dashboard.aimAt('second');
  await (await dashboard.setting('cubic_mpc.latency_handling')).locator('select').selectOption('none');
  await page.getByText('Drive both', { exact: true }).click();
  await isDone(dashboard, 1, 'two futures');
  await dashboard.button('Next').click();
  assert.equal(await heading(dashboard), 'The tour is over');
  assert.match(await tour(dashboard).innerText(), /docs\/effects\.md/);
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  await tour(dashboard).getByRole('button', { name: 'Tours' }).click();
  assert.equal(await heading(dashboard), 'Tours');
  await dashboard.close();
});

it('shows where it is done, and fits a phone', async () => {
  const dashboard = await DashboardPage.open(here.browser, here.drive.url, { mode: 'understand', ...PHONE });
  const { page } = dashboard;
  await dashboard.fromMenu('Tour');
  await choose(dashboard, DASHBOARD);
  await dashboard.show('understand');
  await dashboard.button('Show me where').click();
  assert.equal(await page.locator('#mode-watch').getAttribute('aria-current'), 'page', 'in the mode of the step');
  const { across, down } = await dashboard.overflow();
  assert.ok(across <= 0 && down <= 0, `${across} ${down}`);
  assert.deepEqual(await dashboard.accessibilityFindings(), []);
  await dashboard.close();
});
