import { LibraryBuilder, LibraryViews } from '../../pkg/core/fluoropose_wasm.js';
import type { LibrarySpec } from '../../document/types';
import type { LibraryProtocol } from '../protocol/library';
import { loadCore } from './core_module';
import { serve } from './serve';

/** Draws some views of one library, for whoever puts them together. */
const ready = loadCore();

let builder: LibraryBuilder | null = null;

serve<LibraryProtocol>({
  plan: async ({ mesh, camera, spec }) => {
    await ready;
    const { text, width, height } = camera;
    builder?.free();
    builder = null;
    builder = new LibraryBuilder(mesh.vertices, mesh.triangles, text, width, height, viewsOf(spec));
    return builder.views;
  },
  pack: ({ first, count }) => planned().pack(first, count) as Uint8Array<ArrayBuffer>,
  assemble: ({ parts }) => {
    const whole = planned();
    for (const part of parts) whole.add(part);
    // It is used up, whether that succeeds or not.
    builder = null;
    return whole.finish() as Uint8Array<ArrayBuffer>;
  },
});

function planned(): LibraryBuilder {
  if (!builder) throw new Error('no library is planned');
  return builder;
}

function viewsOf(spec: LibrarySpec): LibraryViews {
  if (spec.views === 'all directions') return LibraryViews.everywhere(spec.distance ?? undefined);
  return new LibraryViews(
    Float64Array.of(spec.nominalX, spec.nominalY),
    Float64Array.of(spec.xFrom, spec.xTo, spec.xStep),
    Float64Array.of(spec.yFrom, spec.yTo, spec.yStep),
    spec.distance ?? undefined,
    Math.round(spec.area),
  );
}
