import type { Findings } from '../engine/poser';
import { useApp } from './app';
import { isRefined, type Candidate, type Cell, type Posed } from '../document/types';

const CANONICAL_AREA = '15 000';

/** The score, and the rival pose where there is one: ambiguity is a visible choice. */
export function Candidates({ cell }: { cell: Cell }) {
  const { actions, poser } = useApp();
  const result = cell.result?.kind === 'posed' ? cell.result : null;
  const findings = poser.findings(cell.outline);
  const area = findings?.canonicalArea ?? 0;
  const chosen = result?.candidates[result.chosen] ?? null;
  const beyondBorder = result !== null && (findings?.atBorder[result.chosen] ?? false);
  return (
    <section class="card candidates" aria-label="Score and candidates">
      <div class="number score">
        <span class="label">Unmatched</span>
        <span class="value" role="group" aria-label={`Unmatched pixels${method(result, findings)}`}>
          {chosen?.unmatched == null ? '–' : grouped(chosen.unmatched)}
        </span>
        <span class="unit">px of {area > 0 ? grouped(area) : CANONICAL_AREA}</span>
      </div>
      <div class="rivals" role="radiogroup" aria-label="Candidate poses">
        {[0, 1].map((index) => (
          <CandidateButton
            key={index}
            index={index}
            candidate={result?.candidates[index] ?? null}
            chosen={result !== null && result.chosen === index}
            onChoose={() => result && result.chosen !== index && actions.chooseOtherCandidate()}
          />
        ))}
      </div>
      <p class="card-note">{result ? (beyondBorder ? BORDER_NOTE : reason(result.candidates, result.chosen)) : ''}</p>
    </section>
  );
}

/** Completes the name of the score. */
function method(result: Posed | null, findings: Findings | null): string {
  if (result?.from !== 'outline') return '';
  if (isRefined(result)) return ', pose refined';
  return findings?.refusal ? ', pose of the library' : ', pose of the library, being refined';
}

interface CandidateButtonProps {
  readonly index: number;
  readonly candidate: Candidate | null;
  readonly chosen: boolean;
  readonly onChoose: () => void;
}

function CandidateButton({ index, candidate, chosen, onChoose }: CandidateButtonProps) {
  const name = index === 0 ? (candidate && candidate.unmatched === null ? 'Loaded' : 'Best') : 'Rival';
  const { pose } = candidate ?? {};
  return (
    <button
      type="button"
      role="radio"
      class="rival"
      aria-checked={chosen}
      aria-label={`${name} candidate`}
      disabled={!candidate}
      title={index === 1 ? 'The next best pose that is not a neighbour of the best (Tab switches)' : 'The pose whose drawn model comes nearest to the outline'}
      onClick={onChoose}
    >
      <span>{name}</span>
      <span class="rival-score">{candidate ? scoreOf(candidate) : '–'}</span>
      <span class="rival-pose">{pose ? `x ${degrees(pose.xRot)}, y ${degrees(pose.yRot)}` : 'none'}</span>
      <span class="rival-pose">{candidate?.drawn == null ? '' : `${grouped(candidate.drawn)} px drawn`}</span>
    </button>
  );
}

/** What remains between the outlines; of a pose of the library, unmatched canonical pixels. */
function scoreOf({ residual, unmatched }: Candidate): string {
  if (residual !== null) return `${residual.toFixed(2)} px off`;
  return unmatched === null ? '–' : `${grouped(unmatched)} px`;
}

const BORDER_NOTE =
  'The best view lies at the border of the library: the true rotation may lie beyond it. Choose another nominal view under the component above.';

/** Below this ratio of scores the better one is not to be relied on. */
const DECISIVE = 1.3;

function reason(candidates: readonly Candidate[], chosen: number): string {
  const [best, rival] = candidates;
  if (best?.unmatched == null) return '';
  if (rival?.unmatched == null) return 'No other view comes near: the choice is clear.';
  if (chosen !== 0) return 'Chosen by hand; Tab goes back to the best.';
  if (best.residual !== null && rival.residual !== null) return refinedReason(best.residual, rival.residual);
  const drawn = best.drawn !== null && rival.drawn !== null;
  const [least, more] = drawn ? [best.drawn, rival.drawn] : [best.unmatched, rival.unmatched];
  const ratio = more / Math.max(1, least);
  const as = ratio < 1.005 ? 'just as many pixels' : `only ${ratio.toFixed(2)} times as many pixels`;
  const what = drawn ? 'Drawn at its pose, the rival' : 'The rival';
  return ratio >= DECISIVE
    ? `${what} misses ${ratio.toFixed(2)} times as many pixels: the choice is clear.`
    : `${what} misses ${as}: compare both overlays with Tab.`;
}

/** Of refined poses: how far each leaves the model's outline from the traced one. */
function refinedReason(best: number, rival: number): string {
  const ratio = rival / Math.max(0.01, best);
  if (ratio >= DECISIVE) return `The rival's outline stays ${ratio.toFixed(2)} times as far off: the choice is clear.`;
  const as = ratio < 1.005 ? 'comes just as near' : `stays only ${ratio.toFixed(2)} times as far off`;
  return `The rival's outline ${as}: compare both overlays with Tab.`;
}

function degrees(value: number): string {
  return `${value.toFixed(1).replace('-', '\u2212')}°`;
}

/** Thousands apart by a narrow space. */
export function grouped(value: number): string {
  return Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, '\u202f');
}
