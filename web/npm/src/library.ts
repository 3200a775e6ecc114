import { LibraryBuilder, LibraryViews } from './pkg/core/fluoropose_wasm.js';
import type { ImplantOptions, Mesh, Size, Views } from './types.js';

/** Of a window: those of Walker et al. 1996. */
const USUAL = { nominal: [0, 0], x: [-15, 15, 1], y: [-20, 20, 1] } as const;

/** Pixels that a canonical silhouette of a window has. */
const CANONICAL_AREA = 15_000;

/** About this long between two breaths, ms: a page stays usable while a library is rendered on its thread. */
const SLICE = 30;
/** Views between two looks at the clock. */
const STEP = 4;

/** Renders the views of a model. */
export async function buildLibrary(mesh: Mesh, options: ImplantOptions): Promise<Uint8Array> {
  const { calibration, frame, onProgress, signal } = options;
  const builder = planned(mesh, calibration, frame, options.views ?? {});
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

function planned(mesh: Mesh, calibration: string, { width, height }: Size, wanted: Views): LibraryBuilder {
  const views = viewsOf(wanted);
  try {
    return new LibraryBuilder(mesh.vertices, mesh.triangles, calibration, width, height, views);
  } finally {
    views.free();
  }
}

function viewsOf({ nominal, x, y, distance }: Views): LibraryViews {
  if (!nominal && !x && !y) return LibraryViews.everywhere(distance);
  const [middle, across, down] = [nominal ?? USUAL.nominal, x ?? USUAL.x, y ?? USUAL.y].map((values) => Float64Array.from(values));
  return new LibraryViews(middle!, across!, down!, distance, CANONICAL_AREA);
}

/** Lets other work in. */
function breath(): Promise<void> {
  return new Promise((resolve) => {
    setTimeout(resolve);
  });
}
