import { currentCell, type State } from '../document/store';
import { chosenCandidate } from '../document/types';
import type { ConvergenceStep } from '../workers/protocol/pose';
import { useApp } from '../commands/app';
import { formatNumber } from '../texts/numbers';
import { later } from '../texts/later';

/** How refinement came to the pose on view: what remains between the outlines, drawing by drawing. */
export function ConvergenceSheet({ state }: { state: State }) {
  const { convergence, poser } = useApp();
  const cell = currentCell(state);
  const candidate = chosenCandidate(cell);
  const trace = convergence.of(candidate);
  if (candidate?.residual == null) return <p class="sheet-body">{later.convergence.none}</p>;
  if (!trace) {
    const started = poser.detail(cell.outline, candidate)?.start ?? null;
    return <p class="sheet-body">{started ? later.convergence.following : later.convergence.refining}</p>;
  }
  if ('refusal' in trace) return <p class="sheet-body">{later.convergence.refused(trace.refusal)}</p>;
  return <Trace steps={trace.steps} />;
}

function Trace({ steps }: { steps: readonly ConvergenceStep[] }) {
  const last = steps.at(-1);
  if (!last) return <p class="sheet-body">{later.convergence.noStep}</p>;
  return (
    <div class="sheet-body">
      <p class="sheet-text">{later.convergence.summary(steps.length, last.renders)}</p>
      <Chart steps={steps} />
      <div class="trace-scroll" tabIndex={0} role="region" aria-label={later.convergence.region}>
        <table class="trace" aria-label={later.convergence.table}>
          <thead>
            <tr>
              {later.convergence.columns.map((text) => (
                <th key={text} scope="col">
                  {text}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {steps.map((step) => (
              <tr key={step.renders}>
                {cellsOf(step).map((text, at) => (
                  <td key={later.convergence.columns[at]}>{text}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </div>
  );
}

function cellsOf({ stage, renders, residual, pose }: ConvergenceStep): string[] {
  const { x, y, z, zRot, xRot, yRot } = pose;
  const numbers = [x, y, z, zRot, xRot, yRot].map((value) => formatNumber(value, 3));
  return [String(stage + 1), String(renders), residual.toFixed(4), ...numbers];
}

const CHART = { width: 560, height: 120, left: 44, bottom: 16 };

/** Residual over drawings, on a logarithmic scale. */
function Chart({ steps }: { steps: readonly ConvergenceStep[] }) {
  const logs = steps.map(({ residual }) => Math.log10(Math.max(residual, LEAST)));
  const [low, high] = [Math.floor(Math.min(...logs)), Math.max(Math.floor(Math.min(...logs)) + 1, Math.ceil(Math.max(...logs)))];
  const most = steps.at(-1)?.renders ?? 1;
  const x = (renders: number) => CHART.left + ((CHART.width - CHART.left - 6) * renders) / Math.max(1, most);
  const y = (log: number) => 6 + ((CHART.height - CHART.bottom - 6) * (high - log)) / (high - low);
  const points = steps.map(({ renders }, at) => [x(renders), y(logs[at] ?? low)] as const);
  const decades = Array.from({ length: high - low + 1 }, (_, at) => low + at);
  const [first, last] = [steps[0]?.residual ?? 0, steps.at(-1)?.residual ?? 0];
  return (
    <svg class="trace-chart" viewBox={`0 0 ${CHART.width} ${CHART.height}`} role="img" aria-label={later.convergence.chart(first.toFixed(2), last.toFixed(3), most)}>
      {decades.map((decade) => (
        <g key={decade}>
          <line x1={CHART.left} x2={CHART.width - 6} y1={y(decade)} y2={y(decade)} />
          <text x={CHART.left - 6} y={y(decade) + 4} text-anchor="end">
            {later.convergence.pixels(10 ** decade)}
          </text>
        </g>
      ))}
      <text x={CHART.width - 6} y={CHART.height - 2} text-anchor="end">
        {later.convergence.drawings(most)}
      </text>
      <polyline points={points.map((point) => point.join(',')).join(' ')} />
      {points.map(([cx, cy]) => (
        <circle key={cx} cx={cx} cy={cy} r={2.5} />
      ))}
    </svg>
  );
}

/** What remains of a drawing of the model itself is nothing, which no logarithm shows. */
const LEAST = 1e-4;
