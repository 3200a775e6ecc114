import { isFollowing, type Findings } from '../jobs/poser';
import { isPicked } from '../document/hand_poses';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { grouped } from '../texts/numbers';
import { isRefined, type Candidate, type Cell, type Posed } from '../document/types';

/** Of poses that were not found by matching and refining. */
function nameOf(result: Posed | null, index: number): string | null {
  const candidate = result?.candidates[index];
  if (!result || !candidate) return null;
  if (result.from === 'file') return texts.panel.candidates.loaded;
  if (result.from === 'hand') return texts.hand.candidate;
  return isPicked(result, candidate) ? texts.hand.view : null;
}

/** The score, and the rival pose where there is one: ambiguity is a visible choice. */
export function Candidates({ cell }: { cell: Cell }) {
  const { actions, poser } = useApp();
  const words = texts.panel.candidates;
  const result = cell.result?.kind === 'posed' ? cell.result : null;
  const findings = poser.findings(cell.outline);
  const area = findings?.canonicalArea ?? 0;
  const chosen = result?.candidates[result.chosen] ?? null;
  const beyondBorder = chosen !== null && (poser.detail(cell.outline, chosen)?.atBorder ?? false);
  return (
    <section class="card candidates" aria-label={words.region}>
      <div class="number score">
        <span class="label">{words.unmatched}</span>
        <span class="value" role="group" aria-label={scoreName(result, findings)}>
          {chosen?.unmatched == null ? '–' : grouped(chosen.unmatched)}
        </span>
        <span class="unit">{words.of(area > 0 ? grouped(area) : null)}</span>
      </div>
      <div class="rivals" role="radiogroup" aria-label={words.list}>
        {words.names.slice(0, Math.max(2, result?.candidates.length ?? 0)).map((name, index) => (
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
      <p class="card-note">{result ? (beyondBorder ? words.atBorder : reason(result)) : ''}</p>
    </section>
  );
}

/** The score's name tells how far the pose has come. */
function scoreName(result: Posed | null, findings: Findings | null): string {
  const words = texts.panel.candidates;
  if (result?.from !== 'outline') return words.unmatchedPixels;
  if (isFollowing(result, findings)) return words.follows;
  if (isRefined(result)) return words.refined;
  return findings?.refusal ? words.ofLibrary : words.beingRefined;
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
      aria-label={texts.panel.candidates.candidate(name)}
      aria-keyshortcuts="X"
      disabled={!candidate}
      title={index > 0 ? texts.panel.candidates.rivalTitle : texts.panel.candidates.bestTitle}
      onClick={onChoose}
    >
      <span>{name}</span>
      <span class="rival-score">{candidate ? scoreOf(candidate) : '–'}</span>
      <span class="rival-pose">{pose ? texts.panel.candidates.rotations(degrees(pose.xRot), degrees(pose.yRot)) : texts.panel.candidates.none}</span>
      <span class="rival-pose">{candidate?.drawn == null ? '' : texts.panel.candidates.drawn(grouped(candidate.drawn))}</span>
    </button>
  );
}

/** What remains between the outlines; of a pose of the library, unmatched canonical pixels. */
function scoreOf({ residual, unmatched }: Candidate): string {
  if (residual !== null) return texts.panel.candidates.pixels(residual.toFixed(2));
  return unmatched === null ? '–' : texts.panel.candidates.pixels(grouped(unmatched));
}

/** Below this ratio of scores the better one is not to be relied on. */
const DECISIVE = 1.3;

/** Why the first candidate comes first. */
function reason({ from, candidates, chosen, reason: stated }: Posed): string {
  const [best, rival] = candidates;
  if (from === 'hand') return stated ?? texts.hand.source;
  if (from === 'file' || !best) return '';
  if (chosen !== 0) return texts.panel.candidates.byHand;
  if (stated !== null) return rival ? texts.panel.candidates.compares(stated) : stated;
  if (!rival) return texts.panel.candidates.alone;
  return libraryReason(best, rival);
}

/** Of poses of the library: how many pixels each leaves unmatched. */
function libraryReason(best: Candidate, rival: Candidate): string {
  const drawn = best.drawn !== null && rival.drawn !== null;
  const [least, more] = drawn ? [best.drawn, rival.drawn] : [best.unmatched, rival.unmatched];
  const ratio = (more ?? 0) / Math.max(1, least ?? 0);
  const { clear, close, even } = texts.panel.candidates;
  if (ratio >= DECISIVE) return clear(drawn, ratio.toFixed(2));
  return ratio < 1.005 ? even(drawn) : close(drawn, ratio.toFixed(2));
}

function degrees(value: number): string {
  return `${value.toFixed(1).replace('-', '\u2212')}°`;
}
