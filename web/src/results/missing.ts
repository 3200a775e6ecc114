import { currentCell, currentFrame, type State } from '../document/store';
import type { ComponentName } from '../terms/component';
import { poseKey } from './keys';
import { texts } from '../texts/texts';

/** What a pose still needs, in the order in which a person would bring it; empty when nothing is missing. */
export function missingForPose(state: State, component: ComponentName): readonly string[] {
  const { present: doc } = state.history;
  const { model, libraryFile } = doc.components[component];
  const { outline } = currentCell(state);
  const library = state.ui.libraries[component];
  const missing: string[] = [];
  if (doc.frames.length === 0) missing.push(texts.said.missing.frames);
  if (!doc.calibration) missing.push(texts.said.missing.calibration);
  if (!model && !libraryFile) missing.push(texts.said.missing.model(texts.component[component]));
  if (library.state === 'building') missing.push(texts.said.missing.building);
  if (library.state === 'stopped') missing.push(texts.said.missing.stopped(library.reason));
  const { outline: anOutline, click } = texts.said.missing;
  if (!outline) missing.push((library.state === 'ready' && model ? click : anOutline)(texts.component[component]));
  else if (!outline.closed) missing.push(texts.said.missing.closed);
  return missing;
}

/** Does the pose on view come from a model, calibration or library that is no longer the document's? */
export function isOutdated(state: State): boolean {
  const frame = currentFrame(state);
  const { result } = currentCell(state);
  if (!frame || result?.kind !== 'posed' || result.from !== 'outline') return false;
  return result.origin !== poseKey(state.history.present, state.ui.component, frame);
}

export function inWords(items: readonly string[]): string {
  return texts.listed(items);
}
