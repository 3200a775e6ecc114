import { withCell } from '../document/commands';
import { cellOf, type Doc } from '../document/types';
import { NO_MARK } from '../document/marks';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { later } from '../texts/later';
import { poseKeys } from './keys';
import { progressOf } from './progress';

/** Frames, from 0, whose pose was found with another model, calibration or library than the document has now. */
export function outdatedIn(doc: Doc, component: ComponentName): readonly number[] {
  const keyOf = poseKeys(doc);
  return doc.frames.flatMap((frame, index) => {
    const key = keyOf(component, frame);
    // Where something is missing nothing else would be found.
    return key !== null && progressOf(cellOf(doc, frame.id, component), NO_MARK, key).outdated ? [index] : [];
  });
}

/** The document as files tell of it: what was found with others is doubtful for that, whatever was said of it then. */
export function asWritten(doc: Doc): Doc {
  return COMPONENT_NAMES.flatMap((component) => outdatedIn(doc, component).map((index) => ({ frameId: doc.frames[index]!.id, component }))).reduce((told, place) => {
    const cell = cellOf(told, place.frameId, place.component);
    return cell.result?.kind === 'posed' ? withCell(told, place, { ...cell, result: { ...cell.result, aside: later.exporting.outdated } }) : told;
  }, doc);
}
