// SPDX-License-Identifier: MIT
// Pages of results: a sweep and an import, from disk, on a phone in the light and on a laptop in the dark.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, it } from 'node:test';
import { pathToFileURL } from 'node:url';
import { DashboardPage } from './dashboard_page.mjs';
import { browserAlone } from './here.mjs';
import { SIZES } from './views.mjs';

const here = browserAlone();
const folder = mkdtempSync(join(tmpdir(), 'chicane-documents-'));
after(() => rmSync(folder, { recursive: true }));
const at = (name) => join(folder, name);
const run = (...words) => execFileSync(process.env.CHICANE ?? 'chicane', words, { stdio: 'pipe' });

const PLAN = `name: a <b>small</b> sweep
settings: {preset: pid, laps: 0, time_limit_s: 0.5}
axes: [{latency_ms: [50, 100]}, {speed_mph: [20, 30]}]
marks: [{latency_ms: 50, speed_mph: 20}]
`;

/** What a page shows that is fine on a phone and a laptop. */
async function look(file, shows) {
  for (const [size, colorScheme] of [
    ['phone', 'light'],
    ['laptop', 'dark'],
  ]) {
    const page = await here.browser.newPage({ ...SIZES[size], colorScheme });
    const complaints = [];
    for (const kind of ['console', 'pageerror', 'request']) page.on(kind, (what) => complaints.push(what));
    await page.goto(pathToFileURL(file).href);
    await page.locator('h1').waitFor();
    assert.equal(complaints.length, 1, 'the page itself is all that is asked for'); // and nothing on the console
    await shows(page);
    const dashboard = new DashboardPage(page, []);
    assert.deepEqual(await dashboard.accessibilityFindings(undefined, 'all'), [], `${size}, ${colorScheme}`);
    assert.ok((await dashboard.overflow()).across <= 0, `fits a ${size}`);
    await page.close();
  }
}

it('shows a sweep, its map and its runs, and nothing of its text as markup', async () => {
  writeFileSync(at('plan.yaml'), PLAN);
  run('sweep', at('plan.yaml'), '-o', at('r.jsonl'));
  run('report', at('r.jsonl'), '-o', at('r.html'));
  await look(at('r.html'), async (page) => {
    assert.equal(await page.locator('h1').innerText(), 'a <b>small</b> sweep');
    assert.equal(await page.locator('.grid .shaded').count(), 4);
    assert.equal(await page.locator('.grid .marked').count(), 1);
    const last = page.locator('table').last().locator('tbody tr').last();
    assert.match(await last.innerText(), /chicane drive --fast .*--latency-ms 100 [\s\S]*open/);
    assert.match(await last.locator('a').getAttribute('href'), /^http:\/\/localhost:4567\//);
    assert.ok((await page.locator('figure svg').count()) > 0);
  });
});

it('shows what an import has recognised', async () => {
  const map = new URL('../data/maps/bean.yaml', import.meta.url).pathname;
  run('import', map, '--preview', at('bean.html'));
  await look(at('bean.html'), async (page) => {
    const legend = await page.locator('figcaption').innerText();
    for (const name of ['wall', 'free', 'edge', 'line', 'start']) assert.match(legend, new RegExp(name));
    assert.ok((await page.locator('figure svg').boundingBox()).height > 100);
  });
});
