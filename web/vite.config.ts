import { defineConfig } from 'vitest/config';
import project from './package.json' with { type: 'json' };
import { embedded } from './build/embedded.ts';
import { offline } from './build/offline.ts';
import { contentPolicy } from './build/policy.ts';

/** `vite build` makes the page for a host, `vite build --mode embedded` the page that is one file. */
export default defineConfig(({ mode }) => ({
  // Relative addresses: the built page works from any folder of any static host.
  base: './',
  define: { __VERSION__: JSON.stringify(project.version) },
  plugins: mode === 'embedded' ? [embedded()] : [contentPolicy(), offline()],
  oxc: { jsx: { runtime: 'automatic' as const, importSource: 'preact' } },
  ...(mode === 'embedded' ? {} : { worker: { format: 'es' as const } }),
  build: { target: 'es2022', assetsInlineLimit: 0 },
  test: {
    include: ['tests/**/*.test.ts'],
    environment: 'node' as const,
    // Threads begin sooner than processes, and read the page's sources once for all their files, whose order is free: what a test puts in place of something goes with it.
    pool: 'threads' as const,
    isolate: false,
    restoreMocks: true,
    unstubGlobals: true,
  },
}));
