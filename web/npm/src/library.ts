import { LibraryBuilder, LibraryViews } from './pkg/core/fluoropose_wasm.js';
import type { ImplantOptions, Mesh, Size, Views } from './types.js';

const USUAL: Views = { nominal: [0, 0], x: [-15, 15, 1], y: [-20, 20, 1] };

/** Pixels that a canonical silhouette has. */
const CANONICAL_AREA = 15_000;

/** About this long between two breaths, ms: a page stays usable while a library is rendered on its thread. */
const SLICE = 30;
/** Views between two looks at the clock. */
const STEP = 4;

/** Renders the views of a model. */
export async function buildLibrary(mesh: Mesh, options: ImplantOptions): Promise<Uint8Array> {
  const { calibration, frame, onProgress, signal } = options;
  const builder = planned(mesh, calibration, frame, { ...USUAL, ...options.views });
  const total = builder.views;
  try {
    for (let done = 0; done < total; ) {
      const until = performance.now() + SLICE;
      for (; done < total && performance.now() < until; done += STEP) builder.add(builder.pack(done, STEP));
      onProgress?.(Math.min(done, total), total);
      await breath();
      signal?.throwIfAborted();
    }
  } catch (error) {
    builder.free();
    throw error;
  }
  return builder.finish();
}

function planned(mesh: Mesh, calibration: string, { width, height }: Size, { nominal, x, y, distance }: Views): LibraryBuilder {
  const [middle, across, down] = [nominal, x, y].map((values) => Float64Array.from(values)) as [Float64Array, Float64Array, Float64Array];
  const views = new LibraryViews(middle, across, down, distance, CANONICAL_AREA);
  try {
    return new LibraryBuilder(mesh.vertices, mesh.triangles, calibration, width, height, views);
  } finally {
    views.free();
  }
}

/** Lets other work in. */
function breath(): Promise<void> {
  return new Promise((resolve) => {
    setTimeout(resolve);
  });
}
