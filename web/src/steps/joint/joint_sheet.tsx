import { useApp } from '../../commands/app';
import type { State } from '../../document/store';
import { download, fileStem } from '../../exchange/browser_files';
import { FAULTS, faultsOf, inRuns, jointTable } from '../../results/joint_table';
import { motionNeeds } from '../../results/motion';
import { texts } from '../../texts/texts';
import { Needs } from './needs';

/** What is in the table, and what is unrefined, unchecked, doubtful or missing in it, before it is written. */
export function JointSheet({ state }: { state: State }) {
  const { joint, services } = useApp();
  const { numbers } = joint;
  const doc = state.history.present;
  const words = texts.joint.sheet;
  const needs = motionNeeds(doc);
  if (needs) return <div class="sheet-body"><Needs needs={needs} /></div>;
  const faults = faultsOf(doc);
  const found = FAULTS.filter((fault) => faults[fault].length > 0);
  const isReady = numbers.of.size > 0 && numbers.waiting === 0;
  const save = () => {
    const { store } = services;
    download([jointTable(doc, numbers, state.ui.joint.rate)], `${fileStem(doc.name)}_joint.csv`, 'text/csv');
    store.show({ popover: null });
    store.say('info', texts.joint.saved(numbers.of.size, doc.frames.length));
  };
  return (
    <div class="sheet-body">
      <p class="sheet-text">{words.frames(numbers.of.size, doc.frames.length)}</p>
      {found.length === 0 ? (
        <p class="sheet-text">{words.noFault}</p>
      ) : (
        <ul class="joint-faults">
          {found.map((fault) => (
            <li key={fault}>{words.fault(faults[fault].length, words.faults[fault], inRuns(faults[fault]))}</li>
          ))}
        </ul>
      )}
      <p class="sheet-text quiet">{words.contents}</p>
      <p class="sheet-text quiet">{texts.joint.band}</p>
      {numbers.waiting > 0 && <p class="sheet-text" role="status">{words.waiting}</p>}
      <div class="sheet-buttons">
        <button type="button" class="button primary" disabled={!isReady} onClick={save}>
          {words.save}
        </button>
      </div>
    </div>
  );
}
