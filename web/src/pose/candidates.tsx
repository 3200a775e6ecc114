import { isFollowing, type Findings } from '../jobs/poser';
import { isPicked } from '../document/hand_poses';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { grouped } from '../texts/numbers';
import { isRefined, type Candidate, type Cell, type Posed } from '../document/types';

/** The score of a pose that was found from an outline, and the rival where there is one: ambiguity is a visible choice. */
export function Candidates({ cell: { outline }, result }: { cell: Cell; result: Posed }) {
  const { actions, poser } = useApp();
  const words = texts.panel.candidates;
  const findings = poser.findings(outline);
  const area = findings?.canonicalArea ?? 0;
  const chosen = result.candidates[result.chosen] ?? null;
  const beyondBorder = chosen !== null && (poser.detail(outline, chosen)?.atBorder ?? false);
  const isProvisional = isFollowing(result, findings) || !isRefined(result);
  return (
    <section class="card candidates" aria-label={words.region}>
      {(chosen?.unmatched != null || isProvisional) && (
        <div class="number score">
          <span class="label">{words.unmatched}</span>
          <span class="value" role="group" aria-label={scoreName(result, findings)}>
            {chosen?.unmatched == null ? '–' : grouped(chosen.unmatched)}
          </span>
          <span class="unit">{words.of(area > 0 ? grouped(area) : null)}</span>
        </div>
      )}
      <div class="rivals" role="radiogroup" aria-label={words.list}>
        {result.candidates.map((candidate, index) => (
          <CandidateButton
            key={index}
            index={index}
            name={isPicked(result, candidate) ? texts.hand.view : (words.names[index] ?? String(index + 1))}
            candidate={candidate}
            chosen={result.chosen === index}
            onChoose={() => result.chosen !== index && actions.chooseCandidate(index)}
          />
        ))}
      </div>
      <p class="card-note">{beyondBorder ? words.atBorder : reason(result)}</p>
    </section>
  );
}

/** The score's name tells how far the pose has come. */
function scoreName(result: Posed, findings: Findings | null): string {
  const words = texts.panel.candidates;
  if (isFollowing(result, findings)) return words.follows;
  if (isRefined(result)) return words.refined;
  return findings?.refusal ? words.ofLibrary : words.beingRefined;
}

interface CandidateButtonProps {
  readonly index: number;
  readonly name: string;
  readonly candidate: Candidate;
  readonly chosen: boolean;
  readonly onChoose: () => void;
}

function CandidateButton({ index, name, candidate, chosen, onChoose }: CandidateButtonProps) {
  const { pose } = candidate;
  return (
    <button
      type="button"
      role="radio"
      class="rival"
      aria-checked={chosen}
      aria-label={texts.panel.candidates.candidate(name)}
      aria-keyshortcuts="X"
      title={index > 0 ? texts.panel.candidates.rivalTitle : texts.panel.candidates.bestTitle}
      onClick={onChoose}
    >
      <span>{name}</span>
      <span class="rival-score">{scoreOf(candidate)}</span>
      <span class="rival-pose">{texts.panel.candidates.rotations(degrees(pose.xRot), degrees(pose.yRot))}</span>
      <span class="rival-pose">{candidate.drawn === null ? '' : texts.panel.candidates.drawn(grouped(candidate.drawn))}</span>
    </button>
  );
}

/** By what they are compared, as the reason has it; of a pose of the library, unmatched canonical pixels. */
function scoreOf({ judged, residual: left, unmatched }: Candidate): string {
  const residual = judged?.misfit ?? left;
  if (residual !== null) return texts.panel.candidates.pixels(residual.toFixed(2));
  return unmatched === null ? '–' : texts.panel.candidates.pixels(grouped(unmatched));
}

/** Below this ratio of scores the better one is not to be relied on. */
const DECISIVE = 1.3;

/** Why the first candidate comes first. */
function reason({ candidates, chosen, reason: stated }: Posed): string {
  const [best, rival] = candidates;
  if (!best) return '';
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
