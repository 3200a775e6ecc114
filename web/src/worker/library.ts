import { LibraryBuilder, LibraryViews } from '../pkg/core/fluoropose_wasm.js';
import type { LibrarySpec } from '../document/types';
import type { LibraryProtocol } from '../engine/protocol';
import { loadCore } from './core_module';
import { serve, Transferred } from './serve';

/** Builds one library, some views at a time, so that it can report and be stopped. */
const ready = loadCore();

/** About this long between two reports. */
const SLICE_MILLISECONDS = 40;

serve<LibraryProtocol>({
  build: async ({ mesh, camera, spec }, context) => {
    await ready;
    const { text, width, height } = camera;
    const views = viewsOf(spec);
    const builder = new LibraryBuilder(mesh.vertices, mesh.triangles, text, width, height, views);
    const total = builder.views;
    for (let done = 0; done < total; ) {
      const until = performance.now() + SLICE_MILLISECONDS;
      while (done < total && performance.now() < until) done = builder.step(4);
      context.report({ done, total });
      await context.breathe();
    }
    const bytes = builder.finish() as Uint8Array<ArrayBuffer>;
    return new Transferred(bytes, [bytes.buffer]);
  },
});

function viewsOf(spec: LibrarySpec): LibraryViews {
  return new LibraryViews(
    Float64Array.of(spec.nominalX, spec.nominalY),
    Float64Array.of(spec.xFrom, spec.xTo, spec.xStep),
    Float64Array.of(spec.yFrom, spec.yTo, spec.yStep),
    spec.distance ?? undefined,
    Math.round(spec.area),
  );
}
