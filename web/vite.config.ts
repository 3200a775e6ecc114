import { defineConfig } from 'vitest/config';
import project from './package.json' with { type: 'json' };

export default defineConfig({
  // Relative addresses: the built page works from any folder of any static host.
  base: './',
  define: { __VERSION__: JSON.stringify(project.version) },
  oxc: { jsx: { runtime: 'automatic', importSource: 'preact' } },
  worker: { format: 'es' },
  build: { target: 'es2022', assetsInlineLimit: 0 },
  test: { include: ['tests/**/*.test.ts'], environment: 'node' },
});
