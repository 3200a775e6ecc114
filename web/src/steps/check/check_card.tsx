import { type ComponentChildren, Fragment } from 'preact';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { useApp } from '../../commands/app';
import { edit, isInCheck } from '../../commands/check_keys';
import { knownAxes } from '../../document/axes';
import { setSide } from '../../document/commands';
import { currentCell, currentFrame, currentPlace, type State } from '../../document/store';
import { type Candidate, cellOf, chosenCandidate, type Failed, type Posed, verdictOf } from '../../document/types';
import type { Studio } from '../../films/studio';
import { turnBetween } from '../../geometry/pose_motion';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import { doubtsOf } from '../../results/doubts';
import { cameraOf } from '../../results/keys';
import { isOff, masksOff } from '../../results/masks_off';
import type { Motion } from '../../results/motion';
import { formatNumber } from '../../texts/numbers';
import { later } from '../../texts/later';
import { asSentence } from '../../texts/sentences';
import { texts } from '../../texts/texts';
import { cornerBeside, drawRival, type RivalScene } from './rival_picture';
import { COMPONENT_NAMES, otherThan } from '../../terms/component';
import '../../styles/check.css';

/** On the film while somebody goes through what is doubtful: why it is, its rivals with the joint that each makes, and what can be done. */
export function CheckCard({ state }: { state: State }) {
  const { result } = currentCell(state);
  if (!isInCheck(state) || state.ui.overlaysHidden || !result) return null;
  const place = currentPlace(state);
  const doubts = doubtsOf(state.history.present);
  const at = doubts.findIndex((doubt) => doubt.place.frameId === place?.frameId && doubt.place.component === place.component);
  const counted: Counted = { at: at + 1, of: doubts.length };
  return result.kind === 'failed' ? <Lacking state={state} result={result} counted={counted} /> : <Doubtful state={state} result={result} counted={counted} />;
}

/** Place in the list, from 1; 0 where it is not in it. */
interface Counted {
  readonly at: number;
  readonly of: number;
}

/** Where none was found: either nothing is there, or a person shows where. */
function Lacking({ state, result, counted: { at, of } }: { state: State; result: Failed; counted: Counted }) {
  const { actions } = useApp();
  const words = later.check;
  return (
    <section class={`guide check ${state.ui.component}`} aria-label={words.lackingRegion}>
      <p class="guide-title">{words.lacking(at, of)}</p>
      <p class="guide-text check-why">{result.sentence}</p>
      <CheckButtons accept={[words.absent, words.absentTitle]} edit={[words.place, words.placeTitle]}>
        <button type="button" class="button small" aria-keyshortcuts="o" title={words.clickTitle} onClick={() => actions.run({ name: 'tool', tool: 'one-click' })}>
          {words.click} <kbd aria-hidden="true">O</kbd>
        </button>
      </CheckButtons>
    </section>
  );
}

function Doubtful({ state, result, counted: { at, of } }: { state: State; result: Posed; counted: Counted }) {
  const { services } = useApp();
  const words = later.check;
  const scene = sceneOf(state, services.studio);
  const drawn = COMPONENT_NAMES.flatMap((component) => {
    const scene = sceneOf(state, services.studio, component);
    const pose = scene && chosenCandidate(cellOf(state.history.present, scene.frame.id, component))?.pose;
    return scene && pose ? [{ scene, pose }] : [];
  });
  // Where the implants are not.
  const corner = useMemo(() => cornerBeside(services.studio, drawn), [...COMPONENT_NAMES.map((component) => drawn.find(({ scene }) => scene.component === component)?.pose), scene?.frame.id, scene && services.studio.holdsFrame(scene.frame.id)]);
  return (
    <section class={`guide check ${corner} ${state.ui.component}`} aria-label={words.region}>
      <p class="guide-title">{at === 0 ? words.taken : words.title(at, of)}</p>
      <p class="guide-text check-why">{asSentence(verdictOf(result)?.because ?? '')}</p>
      <OtherFrames state={state} />
      {result.candidates.length > 1 && <Rivals state={state} result={result} />}
      {result.candidates.length > 1 && state.history.present.side === 'unknown' && <AskSide />}
      {result.from === 'film' && leavesMore(result) && <p class="guide-text quiet check-why">{words.despite}</p>}
      {result.reason !== null && result.candidates.length > 1 && result.from === 'outline' && <p class="guide-text quiet check-why">{result.reason}</p>}
      <CheckButtons accept={[words.accept, words.acceptTitle]} edit={[words.edit, words.editTitle]} />
    </section>
  );
}

/** What many masks tell together, under the reason that a single one has: by itself it may be of another implant. */
function OtherFrames({ state }: { state: State }) {
  const { component } = state.ui;
  const told = isOff(currentCell(state)) ? masksOff(state.history.present, component) : null;
  return told && <p class="guide-text check-why">{later.check.masksOff(told.off, told.of, texts.component[component])}</p>;
}

/** Whether a rival leaves less in this frame than the pose that is chosen, by what stands under the pictures. */
function leavesMore({ candidates, chosen }: Posed): boolean {
  const own = misfitOf(candidates[chosen]);
  return own !== null && candidates.some((one) => Number(shownMisfit(misfitOf(one) ?? own)) < Number(shownMisfit(own)));
}

function shownMisfit(misfit: number): string {
  return misfit.toFixed(2);
}

function misfitOf(candidate: Candidate | undefined): number | null {
  return candidate?.judged?.misfit ?? candidate?.residual ?? null;
}

/** Word and explanation. */
type Words = readonly [string, string];

function CheckButtons({ accept, edit: editWords, children }: { accept: Words; edit: Words; children?: ComponentChildren }) {
  const { actions, services } = useApp();
  const words = later.check;
  return (
    <div class="check-buttons">
      <button type="button" class="button small primary" aria-keyshortcuts="y" title={accept[1]} onClick={() => actions.run({ name: 'work', command: 'toggle-checked' })}>
        {accept[0]} <kbd aria-hidden="true">Y</kbd>
      </button>
      {children}
      <button type="button" class="button small" aria-keyshortcuts="e" title={editWords[1]} onClick={() => edit(services.store)}>
        {editWords[0]} <kbd aria-hidden="true">E</kbd>
      </button>
      <button type="button" class="button small" aria-keyshortcuts="n" title={words.nextTitle} onClick={() => actions.work.check()}>
        {words.next} <kbd aria-hidden="true">N</kbd>
      </button>
    </div>
  );
}

/** Rivals of a knee are told apart by its angles first of all, and those need the side. */
function AskSide() {
  const { services: { store }, sideTeller: { told } } = useApp();
  return (
    <p class="guide-text">
      {later.check.askSide} {told && `${later.curves.needs.told[told]} `}
      <span class="check-sides">
        {(['left', 'right'] as const).map((side) => (
          <Fragment key={side}>
            <button type="button" class="button small" onClick={() => store.perform(setSide(side))}>
              {texts.top.sides[side]}
            </button>{' '}
          </Fragment>
        ))}
      </span>
    </p>
  );
}

/** Keys for more there are not. */
const MOST = 3;

/** What a component, the selected one if none is named, is drawn with in the current frame. */
function sceneOf(state: State, studio: Studio, component = state.ui.component): RivalScene | null {
  const { present: doc } = state.history;
  const frame = currentFrame(state);
  const camera = cameraOf(doc, frame);
  const model = doc.components[component].model?.sha256;
  const window = doc.window ?? (frame && studio.frameFacts(frame.id)?.window) ?? null;
  return frame && camera && model && window ? { frame, camera, component, model, window } : null;
}

function Rivals({ state, result }: { state: State; result: Posed }) {
  const { services } = useApp();
  const chosen = result.candidates[result.chosen]?.pose ?? null;
  const scene = sceneOf(state, services.studio);
  return (
    <div class="check-rivals" role="radiogroup" aria-label={later.check.rivals}>
      {result.candidates.slice(0, MOST).map((candidate, index) => (
        <Rival key={index} index={index} candidate={candidate} chosen={index === result.chosen} beside={chosen === candidate.pose ? null : chosen} scene={scene} motion={motionWith(state, candidate.pose, services.studio)} />
      ))}
    </div>
  );
}

interface RivalProps {
  readonly index: number;
  readonly candidate: Candidate;
  readonly chosen: boolean;
  /** The pose that is chosen; null of that one itself. */
  readonly beside: PoseNumbers | null;
  readonly scene: RivalScene | null;
  readonly motion: Motion | null;
}

function Rival({ index, candidate, chosen, beside, scene, motion }: RivalProps) {
  const { actions } = useApp();
  const words = later.check;
  const angles = motion && ([motion.flexion, motion.abduction, motion.internal].map((value) => formatNumber(value, 1)) as [string, string, string]);
  const misfit = misfitOf(candidate);
  return (
    <button
      type="button"
      role="radio"
      class="check-rival"
      aria-checked={chosen}
      aria-label={[words.rival(index + 1, chosen), angles ? words.joint(...angles) : words.noJoint].join(': ')}
      aria-keyshortcuts={String(index + 1)}
      title={words.rivalTitle(index + 1)}
      onClick={() => !chosen && actions.chooseCandidate(index)}
    >
      <RivalPicture scene={scene} pose={candidate.pose} beside={beside} />
      <span class="check-rival-name">
        <kbd aria-hidden="true">{index + 1}</kbd> {misfit === null ? '' : words.misfit(shownMisfit(misfit))}
      </span>
      {beside && <span>{words.away(formatNumber(turnBetween(beside, candidate.pose), 0))}</span>}
      {(angles ? words.jointShort(...angles) : []).map((angle) => (
        <span key={angle} class="check-joint">
          {angle}
        </span>
      ))}
    </button>
  );
}

/** Pixels of a rival's picture, which a card shows at three sizes. */
const SIDE = 220;

function RivalPicture({ scene, pose, beside }: { scene: RivalScene | null; pose: PoseNumbers; beside: PoseNumbers | null }) {
  const { studio } = useApp().services;
  const canvas = useRef<HTMLCanvasElement>(null);
  const { frame, model, window } = scene ?? {};
  useEffect(() => {
    if (canvas.current && scene) drawRival(canvas.current, studio, scene, pose, beside);
  }, [studio, frame, model, window, pose, beside]);
  return <canvas ref={canvas} class="check-picture" width={SIDE} height={SIDE} aria-hidden="true" />;
}

/** The joint with a component at a pose, where all else of it is known. */
function motionWith({ history: { present: doc }, ui: { component, frameIndex } }: State, pose: PoseNumbers, studio: Pick<Studio, 'motionOf'>): Motion | null {
  const other = otherThan(component);
  const there = chosenCandidate(cellOf(doc, doc.frames[frameIndex]?.id, other));
  const [own, its] = [knownAxes(doc.components[component]), knownAxes(doc.components[other])];
  if (doc.side === 'unknown' || !there || !own || !its) return null;
  const [mine, theirs] = [{ pose, axes: own }, { pose: there.pose, axes: its }];
  return component === 'femur' ? studio.motionOf(mine, theirs, doc.side) : studio.motionOf(theirs, mine, doc.side);
}
