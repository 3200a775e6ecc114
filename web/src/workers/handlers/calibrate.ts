import { BeadGrid, fitDistortion } from '../../pkg/core/fluoropose_wasm.js';
import type { MeasuredDistortion } from '../../document/measuring';
import type { CalibrateProtocol, FoundGrid } from '../protocol/calibrate';
import { loadCore } from './core_module';
import { serve } from './serve';

/** Finds bead grids, away from the page: a large picture takes a second. */
const ready = loadCore();

type Numbers = Float64Array<ArrayBuffer>;

serve<CalibrateProtocol>({
  find: async ({ pixels, width, height, radius, bright }) => {
    await ready;
    const grid =
      pixels instanceof Uint8Array
        ? BeadGrid.inEightBit(pixels, width, height, radius, bright)
        : BeadGrid.inSixteenBit(pixels, width, height, radius, bright);
    const { beads, marks, radiusPx } = grid;
    grid.free();
    return { beads: beads as Numbers, marks, radius: radiusPx, ...distortionOf(beads as Numbers, width, height) };
  },
});

function distortionOf(beads: Numbers, width: number, height: number): Pick<FoundGrid, 'distortion' | 'refusal'> {
  try {
    const fit = fitDistortion(beads, width, height);
    const { numbers, quality, residuals } = fit;
    fit.free();
    const distortion = { numbers, quality, residuals } as MeasuredDistortion;
    return { distortion, refusal: null };
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) throw error;
    return { distortion: null, refusal: error instanceof Error ? error.message : String(error) };
  }
}
