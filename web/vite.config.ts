import { defineConfig } from 'vitest/config';

// The dashboard's files are embedded in the program, so few and small ones are better than many; three.js comes in a
// file of its own, when 3D is shown.
export default defineConfig({
  base: './',
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact' },
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    reportCompressedSize: false,
    modulePreload: false,
    chunkSizeWarningLimit: 700,
    // One script for `chicane report`, whose page stands alone.
    rollupOptions: process.env.CHICANE_REPORT ? { output: { inlineDynamicImports: true } } : {},
  },
  server: {
    // `npm run dev` beside `chicane drive`: the page is Vite's, the data the program's.
    proxy: {
      '^/(schema.json|preset.yaml|mode.json|log/)': 'http://127.0.0.1:4567',
      '/viewer': {
        target: 'ws://127.0.0.1:4567',
        ws: true,
        changeOrigin: true,
        headers: { origin: 'http://127.0.0.1:4567' },
      },
    },
  },
  test: { include: ['src/**/*.test.ts'], testTimeout: 60_000 }, // a busy machine is slow but not wrong
});
