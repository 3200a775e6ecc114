import { useEffect, useRef, useState } from 'preact/hooks';
import { referencePose } from '../document/reference';
import { checkState, isAccepted, markOf, NO_MARK } from '../document/marks';
import { currentPlace, currentRefusal } from '../document/store';
import { cellOf, chosenCandidate, isByHand, type Cell, type Result, verdictOf } from '../document/types';
import { decimalsFor, formatDeviation, formatNumber, NARROW } from '../texts/numbers';
import { inWords } from '../results/missing';
import { isFollowing, type Findings } from '../jobs/poser';
import { wrapped } from '../geometry/pose_motion';
import { work } from '../workers/activity';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { later } from '../commands/later';
import { JointHere } from './joint_here';
import { QUANTITIES, unitWord, type Quantity } from './quantities';
import { otherThan } from '../terms/component';

const HandNumbers = later(async () => (await import('./hand_numbers')).HandNumbers);

interface PoseNumbersCardProps {
  readonly cell: Cell;
  /** What a new pose would need. */
  readonly missing: readonly string[];
  readonly outdated: boolean;
}

export function PoseNumbersCard({ cell, missing, outdated }: PoseNumbersCardProps) {
  const { pose = null, deviations = null } = chosenCandidate(cell) ?? {};
  const { poser } = useApp();
  const findings = poser.findings(cell.outline);
  const { store } = useApp().services;
  const place = currentPlace(store.state);
  const mark = place ? markOf(store.doc, place) : NO_MARK;
  const source = outdated ? texts.panel.pose.outdated(needs(cell, missing)) : sourceOf(cell, findings, checkState(cell, mark) === 'yes');
  const adjusting = store.ui.tool === 'pose';
  const refusal = currentRefusal(store.state);
  const reference = store.ui.seeing.comparing ? referencePose(store.doc, place) : null;
  return (
    <section class="card pose" aria-label={texts.panel.pose.region}>
      {adjusting && <HandNumbers pose={pose} />}
      {/* Above the verdict, which comes and goes in lines: a button must not move from under the hand. */}
      {adjusting && <HandButtons cell={cell} adjusting />}
      {/* How far to trust it before what it is. */}
      <div class={pose && cell.result?.kind === 'posed' && cell.result.from !== 'file' ? 'pose-note posed' : 'pose-note'}>
        <VerdictLine result={cell.result} isAccepted={isAccepted(cell, mark)} />
        <p class="card-note">{pose ? source : needs(cell, missing)}</p>
      </div>
      {pose && !adjusting && (
        <dl class="numbers">
          {QUANTITIES.map((quantity) => (
            <NumberRow
              key={quantity.field}
              quantity={quantity}
              value={pose[quantity.field]}
              deviation={deviations && deviations[quantity.field]}
              difference={reference && pose[quantity.field] - reference[quantity.field]}
            />
          ))}
        </dl>
      )}
      {pose && !adjusting && <JointHere state={store.state} />}
      {refusal !== null && <p class="card-note refused">{refusal}</p>}
      {cell.result?.kind === 'failed' && <Remedies cell={cell} />}
      {!adjusting && <HandButtons cell={cell} adjusting={false} />}
    </section>
  );
}

/** How far the pose is to be trusted, in a word, and why it is not. Its place is kept while that is worked out. */
function VerdictLine({ result, isAccepted }: { result: Result | null; isAccepted: boolean }) {
  const words = texts.panel.pose;
  const verdict = result?.kind === 'failed' ? ({ word: 'none', because: result.sentence } as const) : verdictOf(result);
  if (!verdict) return result?.kind === 'posed' && result.from !== 'file' ? <p class="verdict" /> : null;
  const { word, because } = verdict;
  if (isAccepted) {
    return (
      <p class="verdict is-accepted" role="group" aria-label={words.verdict}>
        <span class="verdict-word">{words.verdicts.accepted}</span>
        {words.accepted(because)}
      </p>
    );
  }
  return (
    <p class={`verdict is-${word}`} role="group" aria-label={words.verdict} title={because}>
      <span class="verdict-word">{words.verdicts[word]}</span>
      {word === 'good' ? '' : words.reason(because)}
    </p>
  );
}

/** What to do where nothing fits. */
function Remedies({ cell }: { cell: Cell }) {
  const { actions, services } = useApp();
  const { store } = services;
  const words = texts.panel.pose;
  const { component } = store.ui;
  const other = otherThan(component);
  const there = currentPlace(store.state);
  const isFree = there !== null && cellOf(store.doc, there.frameId, other).outline === null;
  return (
    <div class="pose-buttons" role="group" aria-label={words.remedies}>
      {cell.outline && (
        <button type="button" class="button small" title={words.traceAgainTitle} onClick={() => actions.deleteOutline()}>
          {words.traceAgain}
        </button>
      )}
      {cell.outline?.closed && isFree && (
        <button type="button" class="button small" title={words.giveTitle(texts.component[other])} onClick={() => actions.giveOutline(other)}>
          {words.give(texts.component[other])}
        </button>
      )}
    </div>
  );
}

/** To take the model in hand, and what can be done with it there. */
function HandButtons({ cell, adjusting }: { cell: Cell; adjusting: boolean }) {
  const { hand } = useApp();
  const { residual = null, pose = null } = chosenCandidate(cell) ?? {};
  const words = texts.hand;
  const droppable = isByHand(cell.result) && cell.outline?.closed;
  return (
    <div class="pose-buttons">
      {adjusting ? (
        <>
          <button type="button" class="button small primary" aria-keyshortcuts="Enter" title={pose ? words.refineTitle : words.placeTitle} onClick={() => hand.refine()}>
            {pose ? words.refine : words.place}
          </button>
          <button type="button" class="button small" title={words.endTitle} onClick={() => hand.end()}>
            {words.end}
          </button>
        </>
      ) : (
        <button type="button" class="button small" title={words.beginTitle} onClick={() => hand.begin()}>
          {words.begin}
        </button>
      )}
      {droppable && (
        <button type="button" class="button small" title={words.dropTitle} onClick={() => hand.drop()}>
          {words.drop}
        </button>
      )}
      {!adjusting && residual !== null && !isByHand(cell.result) && <ConvergenceButton />}
    </div>
  );
}

/** Where the pose that is shown comes from. */
function sourceOf(cell: Cell, findings: Findings | null, isChecked: boolean): string {
  if (cell.result?.kind !== 'posed') return '';
  if (cell.result.from === 'file') return texts.panel.pose.fromFile(cell.result.origin);
  if (cell.result.from === 'film') return isChecked ? texts.follow.sourceKept : texts.follow.source;
  if (cell.result.from === 'hand') return [cell.result.reason, texts.hand.source].filter((part) => part !== null).join(' ');
  const { residual = null, deviations = null } = chosenCandidate(cell) ?? {};
  const words = texts.panel.pose;
  if (residual !== null && isFollowing(cell.result, findings)) return words.follows(residual.toFixed(2));
  if (residual !== null) return ofOutline(cell, residual.toFixed(2)) ?? words.refined(residual.toFixed(2), deviations !== null);
  return findings?.refusal ? words.notRefined(findings.refusal) : words.library;
}

/** What a person should know of a pose from an outline that no hand laid; null of others. */
function ofOutline({ outline, result }: Cell, residual: string): string | null {
  const { laidBy, onEdges, byFilm } = texts.panel.pose;
  if (result?.kind !== 'posed' || !result.onFrame || !outline?.laidBy || outline.laidBy === 'click') return null;
  const say = result.onFrame.film ? byFilm : onEdges;
  return say(residual, laidBy[outline.laidBy]);
}

function needs(cell: Cell, missing: readonly string[]): string {
  if (missing.length > 0) return texts.panel.pose.needs(inWords(missing));
  return cell.result?.kind === 'failed' ? '' : texts.panel.pose.finding;
}

interface NumberRowProps {
  readonly quantity: Quantity;
  readonly value: number;
  /** One standard deviation. */
  readonly deviation: number | null;
  /** From the set to compare with; it takes the deviation's place. */
  readonly difference: number | null;
}

function NumberRow({ quantity, value, deviation, difference }: NumberRowProps) {
  const { store } = useApp().services;
  const decimals = decimalsFor(deviation, quantity.decimals);
  const text = formatNumber(value, decimals);
  const unit = unitWord(quantity.unit);
  const flashing = useFlash(text);
  const copy = () => {
    void navigator.clipboard.writeText(String(value)).then(
      () => store.say('info', texts.panel.pose.copied(quantity.name, value)),
      () => store.say('error', texts.panel.pose.notCopied),
    );
  };
  return (
    <div class="number">
      <dt>{quantity.label}</dt>
      <dd>
        <button
          type="button"
          class={flashing ? 'value flash' : 'value'}
          aria-label={texts.panel.pose.number(quantity.name, text, unit)}
          title={texts.panel.pose.copyTitle}
          onClick={copy}
        >
          {text}
        </button>
        {difference !== null ? (
          <Difference name={quantity.name} unit={unit} text={signed(quantity.unit === '°' ? wrapped(difference) : difference, quantity.decimals)} />
        ) : (
          <Deviation name={quantity.name} unit={unit} text={deviation === null ? null : formatDeviation(deviation, decimals)} />
        )}
        <span class="unit">{quantity.unit}</span>
      </dd>
    </div>
  );
}

function Difference({ name, unit, text }: { name: string; unit: string; text: string }) {
  return (
    <span class="deviation difference" role="group" aria-label={texts.hand.compare.difference(name, text, unit)}>
      {text}
    </span>
  );
}

/** With its sign, so that it is not taken for the number itself. */
function signed(value: number, decimals: number): string {
  const text = formatNumber(value, decimals);
  return Number(text.replace('\u2212', '-')) > 0 ? `+${text}` : text;
}

/** Its place is kept while there is none: nothing jumps when it comes. */
function Deviation({ name, unit, text }: { name: string; unit: string; text: string | null }) {
  if (text === null) return <span class="deviation" />;
  return (
    <span class="deviation" role="group" aria-label={texts.panel.pose.deviation(name, text, unit)} title={texts.panel.pose.deviationTitle}>
      {`±${NARROW}${text}`}
    </span>
  );
}

function ConvergenceButton() {
  const { store } = useApp().services;
  const open = store.ui.popover === 'convergence';
  return (
    <button
      type="button"
      class="button small"
      aria-haspopup="dialog"
      aria-expanded={open}
      title={texts.panel.pose.convergenceTitle}
      onClick={() => store.show({ popover: open ? null : 'convergence' })}
    >
      {texts.panel.pose.convergence}
    </button>
  );
}

/** True for a moment after a change that was not part of a stream of changes. */
function useFlash(text: string): boolean {
  const [flashing, setFlashing] = useState(false);
  const last = useRef({ text, at: 0 });
  useEffect(() => {
    if (last.current.text === text) return undefined;
    const now = performance.now();
    const quiet = now - last.current.at > FLASH_PAUSE;
    last.current = { text, at: now };
    if (!quiet) return undefined;
    setFlashing(true);
    // Not cleared when the text changes again: the flash ends all the same.
    const over = work.begin();
    setTimeout(() => {
      setFlashing(false);
      over();
    }, FLASH_LENGTH);
    return undefined;
  }, [text]);
  return flashing;
}

const FLASH_PAUSE = 400;
const FLASH_LENGTH = 350;
