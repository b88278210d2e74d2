import { defineConfig } from 'vitest/config';

// CHICANE_PAGE: the page that needs no program (apps/page).
const { CHICANE_PAGE } = process.env;

// The files are embedded in the program: few and small ones. three.js is in a file of its own, loaded when 3D is shown.
export default defineConfig({
  base: './',
  define: { __PAGE__: JSON.stringify(CHICANE_PAGE !== undefined) },
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact' },
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    reportCompressedSize: false,
    modulePreload: false,
    chunkSizeWarningLimit: 700,
    rollupOptions: {
      // Without three.js' warnings to its own developers; its errors stay. 2 kB of the page.
      treeshake: { manualPureFunctions: ['warn', 'warnOnce'], propertyReadSideEffects: false },
      // Small scripts join those that load them; for the page without a program all are one.
      output: CHICANE_PAGE ? { inlineDynamicImports: true } : { experimentalMinChunkSize: 10_000 },
    },
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
  test: {
    include: ['src/**/*.test.ts'],
    testTimeout: 60_000, // for busy machines
    // Test files share the loaded modules: loading them for each file takes six times the processor time. A file that
    // needs fresh ones calls vi.resetModules().
    pool: 'threads',
    isolate: false,
  },
});
