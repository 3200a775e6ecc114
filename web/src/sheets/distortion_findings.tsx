import type { MeasuredDistortion, MeasuredGrid } from '../document/measuring';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';

const said = { ...texts.calibrate, ...later.calibrate };

/** What the beads say of the distortion, and what to do about it. */
export function DistortionFindings({ grid }: { grid: MeasuredGrid }) {
  const { calibrator } = useApp();
  const { distortion } = grid;
  if (!distortion) return <p class="sheet-text">{said.noDistortion(grid.refusal ?? '')}</p>;
  const [, dropped = 0, before = 0, after = 0, three = NaN, four = NaN, five = NaN, largest = 0] = distortion.quality;
  const orders = [three, four, five].map((residual, at) => said.orderResidual(at + 3, Number.isNaN(residual) ? null : residual.toFixed(3)));
  return (
    <>
      <p class="sheet-text">
        {said.fitted(before.toFixed(2), after.toFixed(3), distortion.numbers[0] ?? 3, dropped)} {said.validated(texts.listed(orders))}
      </p>
      <ResidualMap grid={grid} distortion={distortion} />
      <p class="sheet-text quiet">
        {said.largest(largest.toFixed(1))} {before < 2 * after ? said.small : ''}
      </p>
      <div class="sheet-buttons">
        <button type="button" class="button primary" title={said.toFramesTitle} onClick={() => calibrator.useFit(grid, distortion, 'frames')}>
          {said.toFrames}
        </button>
        <button type="button" class="button" title={said.toOutlinesTitle} onClick={() => calibrator.useFit(grid, distortion, 'outlines')}>
          {said.toOutlines}
        </button>
      </div>
    </>
  );
}

/** Numbers of a bead's residual. */
const PER_BEAD = 6;
/** The longest line of the map, as a part of the frame's width. */
const LONGEST = 0.09;

/** A line for each bead: how far it lies off the regular lattice before and after. */
function ResidualMap({ grid: { width, height }, distortion: { residuals } }: { grid: MeasuredGrid; distortion: MeasuredDistortion }) {
  const beads = Array.from({ length: residuals.length / PER_BEAD }, (_, at) => residuals.subarray(PER_BEAD * at, PER_BEAD * (at + 1)));
  const longest = Math.max(1e-6, ...beads.map(([, , right = 0, down = 0]) => Math.hypot(right, down)));
  const times = niceFactor((LONGEST * width) / longest);
  const lines = (from: number) =>
    beads.map(([column = 0, row = 0, ...offsets]) => {
      const [right = 0, down = 0] = offsets.slice(from);
      return `M${column.toFixed(1)} ${row.toFixed(1)}l${(times * right).toFixed(1)} ${(times * down).toFixed(1)}`;
    });
  return (
    <figure class="residual-map">
      <svg viewBox={`0 0 ${width} ${height}`} role="img" aria-label={said.map(times)}>
        <rect x="0" y="0" width={width} height={height} />
        <path class="before" d={lines(0).join('')} stroke-width={width / 220} />
        <path class="after" d={lines(2).join('')} stroke-width={width / 110} />
      </svg>
      <figcaption class="sheet-text quiet">{said.map(times)}</figcaption>
    </figure>
  );
}

/** 1, 2 or 5 times a power of ten, not above the value but at least 1. */
function niceFactor(value: number): number {
  const power = 10 ** Math.floor(Math.log10(Math.max(1, value)));
  const mantissa = Math.max(1, value) / power;
  return power * (mantissa >= 5 ? 5 : mantissa >= 2 ? 2 : 1);
}
