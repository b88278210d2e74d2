// Builds the dashboard into DIST, and, as one script and one style, the page of reports into DOCUMENT:
//   node build.mjs DIST DOCUMENT
// In one process, which takes less time than two.
import { build } from 'vite';

const [dist, document] = process.argv.slice(2);
const output = { inlineDynamicImports: true };
const pages = [
  { outDir: dist },
  { outDir: document, copyPublicDir: false, rollupOptions: { output, input: 'document.html' } },
];
for (const page of pages) await build({ logLevel: 'warn', build: { ...page, emptyOutDir: true } });
