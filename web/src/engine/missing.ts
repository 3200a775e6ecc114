import { currentCell, currentFrame, type State } from '../document/store';
import type { ComponentName } from '../document/types';
import { poseKey } from './keys';

/** What a pose still needs, in the order in which a person would bring it; empty when nothing is missing. */
export function missingForPose(state: State, component: ComponentName): readonly string[] {
  const { present: doc } = state.history;
  const { model, libraryFile } = doc.components[component];
  const { outline } = currentCell(state);
  const library = state.ui.libraries[component];
  const missing: string[] = [];
  if (doc.frames.length === 0) missing.push('frames');
  if (!doc.calibration) missing.push('a calibration');
  if (!model && !libraryFile) missing.push(`a model or a library of the ${component}`);
  if (library.state === 'building') missing.push('its library (being built)');
  if (library.state === 'stopped') missing.push(`its library (${library.reason})`);
  if (!outline) missing.push(`an outline of the ${component}`);
  else if (!outline.closed) missing.push('the outline closed');
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
  if (items.length <= 1) return items[0] ?? '';
  return `${items.slice(0, -1).join(', ')} and ${items.at(-1)}`;
}
