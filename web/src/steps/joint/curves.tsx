import { useMemo, useState } from 'preact/hooks';
import { useApp } from '../../commands/app';
import { Segments } from '../../controls/segments';
import type { State } from '../../document/store';
import type { Doc } from '../../document/types';
import { curvesShown, impossibilitiesOf, type JointNumbers } from '../../results/joint_curves';
import { inRuns } from '../../results/joint_faults';
import { jointTrusts, motionNeeds } from '../../results/motion';
import { CONVENTIONS, DOCK, OVERS } from '../../terms/joint';
import { later } from '../../texts/later';
import { formatNumber } from '../../texts/numbers';
import { asSentence } from '../../texts/sentences';
import { CurvePanel } from './curve_panel';
import { DockSize } from './dock_size';
import { Needs } from './needs';
import { RateField } from './rate_field';
import { Tray } from './tray';
import '../../styles/curves.css';

/** What the curves run over and by whose convention; the table. */
export function JointTools({ state }: { state: State }) {
  const { store } = useApp().services;
  const { convention, over, height } = state.ui.joint;
  const words = later.curves;
  return (
    <>
      <Segments
        label={words.over}
        shown
        options={OVERS.map((value) => ({ value, title: words.overs[value] }))}
        value={over}
        onChoose={(value) => store.setJoint({ over: value })}
      />
      {over === 'time' && <RateField doc={state.history.present} />}
      <Segments
        label={words.convention}
        options={CONVENTIONS.map((value) => ({ value, title: words.conventions[value], hint: words.conventionHints[value] }))}
        value={convention}
        onChoose={(value) => store.setJoint({ convention: value })}
      />
      <span class="joint-room" />
      <DockSize state={state} />
      <button
        type="button"
        class="button small"
        aria-pressed={height >= DOCK.large}
        onClick={() => store.setJoint({ height: height >= DOCK.large ? DOCK.usual : DOCK.large })}
      >
        {words.large}
      </button>
    </>
  );
}

export function Curves({ state }: { state: State }) {
  const { joint } = useApp();
  const { numbers } = joint;
  const { over } = state.ui.joint;
  const { rate } = state.history.present;
  const needs = motionNeeds(state.history.present);
  if (needs) return <Needs needs={needs} />;
  if (over === 'time' && rate === null) return <p class="joint-needs">{later.curves.rateNeeded}</p>;
  return <Panels state={state} numbers={numbers} />;
}

function Panels({ state, numbers }: { state: State; numbers: JointNumbers }) {
  const { store } = useApp().services;
  const [hovered, setHovered] = useState<number | null>(null);
  const { convention, over, alone } = state.ui.joint;
  const doc = state.history.present;
  const along = useMemo(() => ({ over, rate: doc.rate ?? NaN }), [over, doc.rate]);
  const names = curvesShown(convention, numbers.hasPlate);
  // The large one may be of the other convention.
  const large = names.find((name) => name === alone);
  return (
    <>
      <div class={large ? 'joint-panels alone' : numbers.hasPlate ? 'joint-panels with-tray' : 'joint-panels'} style={{ '--curves': Math.ceil(names.length / 2) }}>
        {(large ? [large] : names).map((name) => (
          <CurvePanel
            key={name}
            name={name}
            doc={doc}
            numbers={numbers}
            along={along}
            theme={state.ui.theme}
            shown={hovered ?? state.ui.frameIndex}
            current={state.ui.frameIndex}
            alone={name === large}
            onAlone={() => store.setJoint({ alone: large ? null : name })}
            onHover={setHovered}
            onPick={(index) => store.goTo(index)}
          />
        ))}
        {!large && numbers.hasPlate && <Tray doc={doc} numbers={numbers} shown={hovered ?? state.ui.frameIndex} onPick={(index) => store.goTo(index)} />}
      </div>
      <Wrong numbers={numbers} doc={doc} kneeDoubt={doc.kneeDoubt?.sentence ?? null} />
      <Legend numbers={numbers} doc={doc} hovered={hovered} />
    </>
  );
}

/** What no knee does, each once, and what is to be said of the film as a whole. */
function Wrong({ numbers, doc, kneeDoubt }: { numbers: JointNumbers; doc: Doc; kneeDoubt: string | null }) {
  const words = later.curves;
  const told = useMemo(() => impossibilitiesOf(doc, numbers), [doc.frames, numbers]);
  const { of, impossible, originsApart, otherSide, waiting } = numbers;
  const none = useMemo(() => {
    const trusts = jointTrusts(doc);
    return of.size > 1 && waiting === 0 && doc.frames.every(({ id }, index) => !of.has(id) || trusts[index]!.doubtful || impossible.has(id));
  }, [doc, numbers]);
  if (told.length === 0 && !none && kneeDoubt === null && otherSide === null && originsApart === null) return null;
  return (
    <div class="joint-wrong" role="status">
      {kneeDoubt !== null && <p>{asSentence(kneeDoubt)}</p>}
      {otherSide !== null && <p>{asSentence(otherSide)}</p>}
      {originsApart !== null && <p>{words.originsApart(formatNumber(originsApart, 0))}</p>}
      {none && <p>{words.allDoubtful(of.size)}</p>}
      {told.map(({ why, frames }) => (
        <p key={why}>{words.impossible(inRuns(frames), frames.length, why)}</p>
      ))}
    </div>
  );
}

function Legend({ numbers, doc, hovered }: { numbers: JointNumbers; doc: Doc; hovered: number | null }) {
  const words = later.curves;
  const hasBands = useMemo(() => {
    const at = numbers.columns.indexOf('sd_flexion_deg');
    return [...numbers.of.values()].some((row) => Number.isFinite(row[at]));
  }, [numbers]);
  const { femur, tibia } = doc.components;
  const noPlate = numbers.columns.length === 0 || numbers.hasPlate ? null : femur.model && tibia.model ? words.noPlate.tray : words.noPlate.models;
  return (
    <p class="joint-legend">
      <span>
        <i class="joint-point" aria-hidden="true" /> {words.good}
      </span>
      <span>
        <i class="joint-point hollow" aria-hidden="true" /> {words.doubtful}
      </span>
      <span>
        <i class="joint-point square" aria-hidden="true" /> {words.checked}
      </span>
      <span>{hasBands ? words.band : words.noBands}</span>
      {noPlate && <span>{noPlate}</span>}
      {hovered !== null && <span>{words.hovered(hovered + 1)}</span>}
      {numbers.waiting > 0 && <span role="status">{words.waiting(numbers.waiting)}</span>}
    </p>
  );
}
