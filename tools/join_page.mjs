// SPDX-License-Identifier: MIT
// node join_page.mjs DIST WORKER.js PAGE.html: one file of Vite's page, which has one script and one style, and of the worker's script,
// so that a browser can open it from a disk.
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';

const [dist, worker, page] = process.argv.slice(2);
if (page === undefined) {
  process.stdout.write('node tools/join_page.mjs DIST WORKER.js PAGE.html: one file of a page and of its worker\n');
  process.exit(dist === '--help' ? 0 : 2);
}
const assets = join(dist, 'assets');
const only = (ending) => {
  const found = readdirSync(assets).filter((name) => name.endsWith(ending));
  if (found.length !== 1) throw new Error(`${assets}: got ${found.length} *${ending}, expected one`);
  return readFileSync(join(assets, found[0]), 'utf8');
};
const head = readFileSync(join(dist, 'index.html'), 'utf8')
  .replace(/<script type="module"[^>]*><\/script>/, '')
  .replace(/<link rel="stylesheet"[^>]*>/, '')
  .replace(/href="[^"]*favicon.svg"/, () => {
    const icon = readFileSync(join(dist, 'favicon.svg')).toString('base64');
    return `href="data:image/svg+xml;base64,${icon}"`;
  });
const parts = [
  `<style>${only('.css').replaceAll('</style', '<\\/style')}</style>`,
  `<script type="text/plain" id="chicane-worker">${gzipSync(readFileSync(worker), { level: 9 }).toString('base64')}</script>`,
  `<script type="module">${only('.js').replaceAll('</script', '<\\/script')}</script>`,
];
// A function: text of a replacement has signs of its own.
writeFileSync(
  page,
  head.replace('</body>', () => `${parts.join('\n')}\n</body>`),
);
