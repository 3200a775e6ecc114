import { useApp } from '../commands/app';
import { unjudged } from '../document/followed';
import type { State } from '../document/store';
import type { Doc } from '../document/types';
import { impossibilitiesOf } from '../results/joint_curves';
import { FAULTS, faultsOf, inRuns, toldTogether } from '../results/joint_faults';
import { type ComponentName, titleOf } from '../terms/component';
import { later } from '../texts/later';
import { formatNumber } from '../texts/numbers';
import { asSentence } from '../texts/sentences';
import { texts } from '../texts/texts';

/** What is unrefined, unchecked, doubtful or missing in it, before it is written. */
export function ExportFaults({ state }: { state: State }) {
  const { joint } = useApp();
  const doc = state.history.present;
  const { kind } = state.ui.exporting;
  if (kind === 'session' || kind === 'outlines' || doc.frames.length === 0) return null;
  const together = toldTogether(state.ui.exporting);
  const soFar = together.flat().filter((one) => unjudged(doc, one) > 0);
  const found = together.flatMap((components) => faultsFound(doc, components));
  const words = later.exporting.faults;
  return (
    <>
      {doc.unread.length > 0 && <p class="sheet-text">{texts.said.withoutUnread(doc.unread)}</p>}
      {kind !== 'poses' && joint.numbers.of.size > 0 && <p class="sheet-text">{words.frames(joint.numbers.of.size, doc.frames.length)}</p>}
      {soFar.map((one) => (
        <p class="sheet-text" key={one}>
          {texts.follow.unjudged(texts.component[one], unjudged(doc, one))}
        </p>
      ))}
      {kind !== 'poses' &&
        impossibilitiesOf(doc, joint.numbers).map(({ why, frames }) => (
          <p class="sheet-text" key={why}>
            {later.curves.impossible(inRuns(frames), frames.length, why)}
          </p>
        ))}
      {(kind === 'poses' ? [] : [doc.kneeDoubt?.sentence ?? null, joint.numbers.otherSide]).map(
        (doubt) =>
          doubt !== null && (
            <p class="sheet-text" key={doubt}>
              {asSentence(doubt)}
            </p>
          ),
      )}
      {kind !== 'poses' && joint.numbers.originsApart !== null && <p class="sheet-text">{later.curves.originsApart(formatNumber(joint.numbers.originsApart, 0))}</p>}
      {found.length === 0 ? (
        <p class="sheet-text">{words.none}</p>
      ) : (
        <ul class="export-faults">
          {found.map(({ of, fault, frames }) => (
            <li key={`${of} ${fault}`}>
              {together.length > 1 ? `${titleOf(of)}: ` : ''}
              {words.fault(frames.length, kind === 'poses' && fault === 'unchecked' ? words.uncheckedOne : words[fault], inRuns(frames))}
            </li>
          ))}
        </ul>
      )}
    </>
  );
}

function faultsFound(doc: Doc, components: readonly ComponentName[]) {
  const faults = faultsOf(doc, components);
  return FAULTS.flatMap((fault) => (faults[fault].length > 0 ? [{ of: components[0]!, fault, frames: faults[fault] }] : []));
}
