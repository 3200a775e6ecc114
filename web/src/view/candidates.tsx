import type { Findings } from '../engine/poser';
import { isPicked } from '../document/hand_poses';
import { texts } from '../texts';
import { useApp } from './app';
import { isRefined, type Candidate, type Cell, type Posed } from '../document/types';

/** As many as the matcher offers, and one from the landscape. */
const NAMES = ['Best', 'Rival', 'Third', 'Fourth'] as const;

/** Of poses that were not found by matching and refining. */
function nameOf(result: Posed | null, index: number): string | null {
  const candidate = result?.candidates[index];
  if (!result || !candidate) return null;
  if (result.from === 'file') return 'Loaded';
  if (result.from === 'hand') return texts.hand.candidate;
  return isPicked(result, candidate) ? texts.hand.view : null;
}

const CANONICAL_AREA = '15 000';

/** The score, and the rival pose where there is one: ambiguity is a visible choice. */
export function Candidates({ cell }: { cell: Cell }) {
  const { actions, poser } = useApp();
  const result = cell.result?.kind === 'posed' ? cell.result : null;
  const findings = poser.findings(cell.outline);
  const area = findings?.canonicalArea ?? 0;
  const chosen = result?.candidates[result.chosen] ?? null;
  const beyondBorder = chosen !== null && (poser.detail(cell.outline, chosen)?.atBorder ?? false);
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
        {NAMES.slice(0, Math.max(2, result?.candidates.length ?? 0)).map((name, index) => (
          <CandidateButton
            key={name}
            index={index}
            name={nameOf(result, index) ?? name}
            candidate={result?.candidates[index] ?? null}
            chosen={result !== null && result.chosen === index}
            onChoose={() => result && result.chosen !== index && actions.chooseCandidate(index)}
          />
        ))}
      </div>
      <p class="card-note">{result ? (beyondBorder ? BORDER_NOTE : reason(result)) : ''}</p>
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
  readonly name: string;
  readonly candidate: Candidate | null;
  readonly chosen: boolean;
  readonly onChoose: () => void;
}

function CandidateButton({ index, name, candidate, chosen, onChoose }: CandidateButtonProps) {
  const { pose } = candidate ?? {};
  return (
    <button
      type="button"
      role="radio"
      class="rival"
      aria-checked={chosen}
      aria-label={`${name} candidate`}
      aria-keyshortcuts="X"
      disabled={!candidate}
      title={index > 0 ? 'Another pose that explains the outline nearly as well (X switches)' : 'The pose that was chosen; the reason stands below (X switches)'}
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
  if (residual !== null) return `${residual.toFixed(2)} px`;
  return unmatched === null ? '–' : `${grouped(unmatched)} px`;
}

const BORDER_NOTE =
  'The best view lies at the border of the library: the true rotation may lie beyond it. Choose another nominal view under the component above.';

/** Below this ratio of scores the better one is not to be relied on. */
const DECISIVE = 1.3;

/** Why the first candidate comes first. */
function reason({ from, candidates, chosen, reason: stated }: Posed): string {
  const [best, rival] = candidates;
  if (from === 'hand') return stated ?? texts.hand.source;
  if (from === 'file' || !best) return '';
  if (chosen !== 0) return 'Chosen by hand; X goes back to the best.';
  if (stated !== null) return rival ? `${stated} X compares.` : stated;
  if (!rival) return 'No other view comes near: the choice is clear.';
  return libraryReason(best, rival);
}

/** Of poses of the library: how many pixels each leaves unmatched. */
function libraryReason(best: Candidate, rival: Candidate): string {
  const drawn = best.drawn !== null && rival.drawn !== null;
  const [least, more] = drawn ? [best.drawn, rival.drawn] : [best.unmatched, rival.unmatched];
  const ratio = (more ?? 0) / Math.max(1, least ?? 0);
  const as = ratio < 1.005 ? 'just as many pixels' : `only ${ratio.toFixed(2)} times as many pixels`;
  const what = drawn ? 'Drawn at its pose, the rival' : 'The rival';
  return ratio >= DECISIVE
    ? `${what} misses ${ratio.toFixed(2)} times as many pixels: the choice is clear.`
    : `${what} misses ${as}: compare both overlays with X.`;
}

function degrees(value: number): string {
  return `${value.toFixed(1).replace('-', '\u2212')}°`;
}

/** Thousands apart by a narrow space. */
export function grouped(value: number): string {
  return Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, '\u202f');
}
