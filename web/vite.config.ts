import { defineConfig } from 'vitest/config';

// The files are embedded in the program: few and small ones. three.js is in a file of its own, loaded when 3D is shown.
export default defineConfig({
  base: './',
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact' },
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    reportCompressedSize: false,
    modulePreload: false,
    chunkSizeWarningLimit: 700,
    // `chicane report` writes a page with a single script.
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
  test: { include: ['src/**/*.test.ts'], testTimeout: 60_000 }, // for busy machines
});
