import { useApp } from '../commands/app';
import { unjudged } from '../document/followed';
import type { State } from '../document/store';
import { impossibilitiesOf } from '../results/joint_curves';
import { FAULTS, faultsOf, inRuns } from '../results/joint_faults';
import { COMPONENT_NAMES } from '../terms/component';
import { later } from '../texts/later';
import { texts } from '../texts/texts';

/** What is unrefined, unchecked, doubtful or missing in it, before it is written. */
export function ExportFaults({ state }: { state: State }) {
  const { joint } = useApp();
  const doc = state.history.present;
  const { kind, forms, component } = state.ui.exporting;
  if (kind === 'session' || kind === 'outlines' || doc.frames.length === 0) return null;
  const isOfOne = kind === 'poses' && forms.poses !== 'tra';
  const components = isOfOne ? [component] : COMPONENT_NAMES;
  const faults = faultsOf(doc, components);
  const soFar = components.filter((one) => unjudged(doc, one) > 0);
  const found = FAULTS.filter((fault) => faults[fault].length > 0);
  const words = later.exporting.faults;
  return (
    <>
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
      {found.length === 0 ? (
        <p class="sheet-text">{words.none}</p>
      ) : (
        <ul class="export-faults">
          {found.map((fault) => (
            <li key={fault}>{words.fault(faults[fault].length, words[fault], inRuns(faults[fault]))}</li>
          ))}
        </ul>
      )}
    </>
  );
}
