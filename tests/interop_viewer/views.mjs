// SPDX-License-Identifier: MIT
// Every view that the dashboard has, and how to come to it.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as delay } from 'node:timers/promises';
import { pathToFileURL } from 'node:url';
import { change, startDrive, startProgram, watch } from './chicane_drive.mjs';
import { DashboardPage, MODES, PHONE } from './dashboard_page.mjs';

export const SIZES = {
  phone: PHONE,
  tablet: { viewport: { width: 768, height: 1024 }, hasTouch: true },
  laptop: { viewport: { width: 1280, height: 720 } },
  common: { viewport: { width: 1366, height: 768 } },
  screen: { viewport: { width: 1920, height: 1080 } },
  narrow: { ...PHONE, viewport: { width: 320, height: 640 } },
  zoomed: { viewport: { width: 683, height: 384 }, deviceScaleFactor: 2 }, // 1366 x 768 at 200 %
};
export const THEMES = ['light', 'dark'];

/**
 * `part`: what a view changes; the rest of the page was looked at with the first one. `isLong`: it takes seconds of
 * processor time to come to.
 */
const modeView = (name, i) => ({
  name,
  part: i === 0 ? undefined : 'main',
  async show(dashboard) {
    await dashboard.show(name);
    if (name === 'understand') await dashboard.page.locator('.understand h1').waitFor();
  },
});
const overlay = (name, key, selector) => ({
  name,
  part: selector,
  async show({ page }) {
    await page.locator('body').press(key);
    await page.locator(selector).first().waitFor();
  },
  async leave({ page }) {
    await page.locator('body').press(key === '?' ? 'Escape' : key);
  },
});

/** Of a run that goes on. Each begins where the one before it was left. */
const LIVE = [
  ...MODES.map(modeView),
  {
    name: 'engineer',
    part: 'main',
    isLong: true,
    async show(dashboard) {
      await dashboard.show('understand');
      await dashboard.page.locator('body').press('e');
      await dashboard.page.locator('.plot').first().waitFor();
    },
    leave: ({ page }) => page.locator('body').press('e'),
  },
  {
    name: 'what if',
    part: 'main',
    isLong: true,
    async show(dashboard) {
      const { page } = dashboard;
      await dashboard.show('try');
      await dashboard.aimAt('second');
      await dashboard.type('latency_ms', 250);
      await page.getByLabel('For how long').selectOption('10');
      await dashboard.button('Drive both').click();
      await page.getByTestId('what-if-verdict').waitFor();
    },
    async leave(dashboard) {
      await dashboard.button('Forget it').click();
      await dashboard.aimAt('run');
    },
  },
  {
    name: 'share',
    part: 'dialog[open]',
    async show(dashboard) {
      await dashboard.show('try');
      await dashboard.fromMenu('Share this run');
      await dashboard.page.getByLabel('Link', { exact: true }).waitFor();
    },
    leave: (dashboard) => dashboard.button('Close').click(),
  },
  {
    name: 'wanted run',
    part: 'dialog[open]',
    async show({ page }) {
      await page.evaluate(() => {
        location.hash = '#run?track=hairpins&latency_ms=60';
      });
      await page.getByTestId('wanted').waitFor();
    },
    leave: (dashboard) => dashboard.button('Keep this run').click(),
  },
  {
    name: 'tour',
    part: '[data-testid="tour"]',
    async show(dashboard) {
      await dashboard.page.locator('body').press('h');
      await dashboard.page.getByTestId('tour').waitFor();
    },
    leave: (dashboard) => dashboard.button('Leave the tour').click(),
  },
  overlay('help', '?', 'dialog[open]'),
  {
    name: 'by hand',
    async show(dashboard) {
      await dashboard.show('watch');
      await dashboard.page.locator('body').press('m');
      await dashboard.page.locator('.strip.by-hand').waitFor();
    },
    leave: ({ page }) => page.keyboard.press('Escape'),
  },
];

const ENDED = [
  {
    name: 'end card',
    part: '[data-testid="end-card"]',
    isLong: true,
    async show(dashboard) {
      const { page } = dashboard;
      await dashboard.type('run.pace', 20); // not before the page is there: the run must not end earlier
      await dashboard.show('watch');
      await page.getByTestId('end-card').waitFor();
      await page.getByText('Program ended', { exact: true }).waitFor();
    },
  },
];
const RECORDED = [
  { name: 'recording', show: (dashboard) => dashboard.show('watch') },
  { name: 'recorded laps', part: 'main', show: (dashboard) => dashboard.show('understand') },
  { name: 'what if of a recording', part: 'main', show: (dashboard) => dashboard.show('try') },
];
const REPORTED = [{ name: 'report', isLong: true, show: ({ page }) => page.getByTestId('verdict').nth(1).waitFor() }];

/** Runs, recordings and a report to look at; stop() ends and removes them. */
export async function startScenes() {
  const folder = mkdtempSync(join(tmpdir(), 'chicane-views-'));
  const program = process.env.CHICANE ?? 'chicane';
  const [log, other, report] = ['run.mcap', 'slow.mcap', 'report.html'].map((name) => join(folder, name));
  const run = (...words) => execFileSync(program, words, { stdio: 'ignore' });
  run('drive', '--fast', '--track', 'oval', '--laps', '2', '--record', log);
  run('drive', '--fast', '--track', 'oval', '--laps', '2', '--preset', 'pid', '--record', other);
  run('report', log, other, '--output', report);
  const live = await startDrive(['--track', 'oval', '--pace', '20']);
  const viewer = await watch(live.url);
  while (!(viewer.newest?.lap >= 2)) await delay(50); // as many as can be compared
  viewer.close();
  await change(live.url, 'run.pace', 1);
  const replay = await startProgram('replay', [log]);
  const ending = async () => (await startDrive(['--track', 'oval', '--laps', '3'])).url;
  return {
    /** All views, by where they are found. */
    groups: [
      { address: async () => live.url, state: 'Live', views: LIVE },
      { address: ending, state: 'Live', views: ENDED },
      { address: async () => replay.url, state: 'Recording', views: RECORDED },
      { address: async () => pathToFileURL(report).href, state: 'All laps', views: REPORTED },
    ],
    async stop() {
      await live.stop();
      await replay.stop();
      rmSync(folder, { recursive: true });
    },
  };
}

/** What browsers say of software graphics, and of a program that has ended. */
export const isExpected = (text) => /GPU|WebGL|GL Driver|WebSocket connection to|ERR_CONNECTION_REFUSED/i.test(text);

/**
 * Goes through the views of a group that `accept` takes, at one size in one theme; `look` is called at each.
 */
export async function walk(browser, { address, state, views: all }, options, look, accept = () => true) {
  const views = all.filter(accept);
  if (views.length === 0) return;
  const dashboard = await DashboardPage.open(browser, await address(), { state, ...options });
  for (const view of views) {
    await view.show(dashboard);
    await look(dashboard, view.name, view.part);
    await view.leave?.(dashboard);
  }
  await dashboard.close(isExpected);
}
