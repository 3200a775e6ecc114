import type { Command, Place } from './command';
import { byHand, isSilhouette } from './laid_by';
import { anew, foundAnew } from './found_anew';
import { withOtherPoses } from './marks';
import { withReference } from './reference';
import { withItsOutline } from './own_outlines';
import { sidesAfterDeletion, sidesAfterInsertion } from './sides';
import type { FramePoint } from '../geometry/points';
import {
  type Calibration,
  type Cell,
  cellKey,
  cellOf,
  type Component,
  type Doc,
  EMPTY_DOC,
  type FileReference,
  type ModelReference,
  type FrameEntry,
  type GreyWindow,
  isByHand,
  isFromFilm,
  type LibrarySpec,
  type Outline,
} from './types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';

// --- Outlines ---------------------------------------------------------------------------------------------------

export function addPoint(place: Place, point: FramePoint): Command {
  return onOutline(texts.steps.addPoint, place, (outline) => ({
    points: [...(outline?.points ?? []), point],
    closed: false,
    unknownSides: outline?.unknownSides ?? [],
    ...byHand(outline),
  }));
}

export function closeOutline(place: Place): Command {
  return onOutline(texts.steps.closeOutline, place, (outline) => outline && { ...outline, closed: true });
}

export function movePoint(place: Place, index: number, to: FramePoint): Command {
  return onOutline(texts.steps.movePoint, place, (outline) => outline && { ...outline, ...byHand(outline), points: outline.points.with(index, to) });
}

/** Inserts before `index`; an index past the end appends. */
export function insertPoint(place: Place, index: number, point: FramePoint): Command {
  return onOutline(
    texts.steps.insertPoint,
    place,
    (outline) =>
      outline && {
        ...outline,
        ...byHand(outline),
        points: outline.points.toSpliced(index, 0, point),
        unknownSides: sidesAfterInsertion(outline, index),
      },
  );
}

/** Deleting the last point deletes the outline. */
export function deletePoint(place: Place, index: number): Command {
  return onOutline(texts.steps.deletePoint, place, (outline) => {
    if (!outline || outline.points.length <= 1) return null;
    return { ...outline, ...byHand(outline), points: outline.points.toSpliced(index, 1), unknownSides: sidesAfterDeletion(outline, index) };
  });
}

export function deleteOutline(place: Place): Command {
  return onOutline(texts.steps.deleteOutline, place, () => null);
}

/** The outline becomes that of the other component, whose pose is found anew; where that has one, nothing changes. */
export function giveOutline(place: Place, to: ComponentName): Command {
  return {
    label: texts.steps.giveOutline(texts.component[to]),
    place,
    apply: (doc) => {
      const here = cellOf(doc, place.frameId, place.component);
      const { outline } = here;
      const there = cellOf(doc, place.frameId, to);
      if (!outline || there.outline || to === place.component) return doc;
      const given = withCell(doc, { ...place, component: to }, ofOutline(there, { ...outline }));
      return withCell(given, place, ofOutline(here, null));
    },
  };
}

/** With an outline of which nothing was found yet. A pose that a hand set is no outline's, and stays. */
function ofOutline(cell: Cell, outline: Outline | null): Cell {
  return isByHand(cell.result) ? { ...cell, outline } : { outline, result: null, resultOf: null };
}

/** Marks a side as unknown, or as known again where it was marked. */
export function toggleUnknownSide(place: Place, side: number): Command {
  const toggled = (sides: readonly number[]) =>
    sides.includes(side) ? sides.filter((other) => other !== side) : [...sides, side].sort((a, b) => a - b);
  return onOutline(texts.steps.markSide, place, (outline) =>
    outline?.points[side] ? { ...outline, unknownSides: toggled(outline.unknownSides) } : outline,
  );
}

/** A change of the outline at a place; the same object back is no change. */
export function onOutline(label: string, place: Place, change: (outline: Outline | null) => Outline | null): Command {
  return {
    label,
    place,
    apply: (doc) => {
      const cell = cellOf(doc, place.frameId, place.component);
      const outline = change(cell.outline);
      return outline === cell.outline ? doc : withCell(doc, place, keepWhileFollowing(cell, outline));
    },
  };
}

/**
 * While a closed outline changes, the last result stays on view until the new one is there. A pose that was set by hand
 * does not come from an outline and stays in any case; one that was followed stays until an outline is closed and has its own.
 */
function keepWhileFollowing(cell: Cell, outline: Outline | null): Cell {
  const isSet = isByHand(cell.result) || (cell.result?.kind === 'posed' && isFromFilm(cell.result));
  if (isSet) return { ...cell, outline };
  return outline?.closed ? { ...cell, outline } : { outline, result: null, resultOf: null };
}

/** The same while a gesture is previewed: what is on view has a later result than the document before the gesture. */
export function carryResult(shown: Doc, next: Doc, place: Place): Doc {
  const { result, resultOf } = cellOf(shown, place.frameId, place.component);
  const cell = cellOf(next, place.frameId, place.component);
  if (isByHand(cell.result)) return next;
  return cell.outline?.closed && result ? withCell(next, place, { ...cell, result, resultOf }) : next;
}

export function withCell(doc: Doc, place: Place, cell: Cell): Doc {
  return { ...doc, cells: doc.cells.with(place.frameId, place.component, cell) };
}

// --- Poses ------------------------------------------------------------------------------------------------------

export function chooseCandidate(place: Place, chosen: number): Command {
  return {
    label: texts.steps.chooseCandidate,
    place,
    apply: (doc) => {
      const cell = cellOf(doc, place.frameId, place.component);
      if (cell.result?.kind !== 'posed' || !cell.result.candidates[chosen]) return doc;
      const own = withItsOutline(cell, cell.result.candidates[chosen]);
      return withCell(doc, place, { ...own, result: { ...cell.result, chosen } });
    },
  };
}

/** Poses by frame, in frame order; null leaves a frame as it is. */
export function loadPoses(component: ComponentName, poses: readonly (PoseNumbers | null)[], fileName: string): Command {
  return {
    label: texts.steps.loadPoses(texts.component[component]),
    apply: (doc) =>
      doc.frames.reduce((changed, frame, index) => {
        const pose = poses[index];
        if (!pose) return changed;
        changed = withReference(changed, fileName, { [cellKey(frame.id, component)]: pose });
        const place = { frameId: frame.id, component };
        const { outline } = cellOf(changed, frame.id, component);
        const candidates = [{ pose, unmatched: null, drawn: null, residual: null, deviations: null, judged: null }];
        const choice = { chosen: 0, reason: null, decided: true, verdict: null };
        const result = { kind: 'posed', from: 'file', origin: fileName, candidates, ...choice } as const;
        return withCell(changed, place, { outline, result, resultOf: outline });
      }, doc),
  };
}

// --- What is opened ---------------------------------------------------------------------------------------------

/** A document nobody began: undo goes back to what was before. */
export function startAnew(): Command {
  return { label: texts.keep.startAnewLabel, apply: () => EMPTY_DOC };
}

/** Behind those that are there; with an order of names each at its place among them. */
/** `unread`: files that could not be read, of these frames and those before. */
export function addFrames(frames: readonly FrameEntry[], unread?: readonly string[], byName?: (a: string, b: string) => number): Command {
  return {
    label: texts.steps.openFrames(frames.length),
    apply: (doc) => {
      const known = new Set(doc.frames.map((frame) => frame.id));
      const fresh = frames.filter((frame) => !known.has(frame.id));
      const all = [...doc.frames, ...fresh];
      if (byName) all.sort((a, b) => byName(a.name, b.name));
      return fresh.length === 0 ? doc : { ...doc, frames: all, unread: unread ?? doc.unread };
    },
  };
}

/** Poses mean nothing with another one. */
export function setCalibration(calibration: Calibration | null): Command {
  return {
    label: texts.steps.changeCalibration,
    apply: (doc) => {
      // The same folder may be dropped twice.
      if (doc.calibration?.text === calibration?.text && doc.calibration?.name === calibration?.name) return doc;
      const isOther = doc.calibration !== null && doc.calibration.text !== calibration?.text;
      return { ...(isOther ? foundAnew(doc, null) : doc), calibration };
    },
  };
}

/** What a click laid as the outline of another model of the component is none of this one's. */
function withoutSilhouettes(doc: Doc, name: ComponentName): Doc {
  const cells = doc.cells.map((cell, _, component) => (component === name && isSilhouette(cell.outline) ? ofOutline(cell, null) : cell));
  return { ...doc, cells };
}

/** Axes are those of a file: with another one they are found again. What a study said before its model came is of this one. */
export function setModel(name: ComponentName, model: ModelReference): Command {
  const { label, apply } = onComponent(texts.steps.openModel(texts.component[name]), name, (component) => ({
    ...component,
    model,
    // A model in another unit lies in the same axes.
    axes: component.model === null || (model.writtenFrom && model.writtenFrom.name === component.model.name) ? component.axes : null,
  }));
  const isOther = (there: ModelReference | null) => there !== null && there.sha256 !== model.sha256;
  return {
    label,
    apply: (doc) => apply(isOther(doc.components[name].model) ? withoutSilhouettes(foundAnew(doc, name), name) : doc),
  };
}

/**
 * The models change places, with their libraries and what a person said of their axes. What was found with them is found anew; outlines that
 * are a silhouette of the wrong model, where a click led, are dropped.
 */
export function swapModels(): Command {
  const moved = (component: Component): Component => ({ ...component, axes: component.axes?.from === 'shape' ? null : component.axes });
  return {
    label: texts.steps.swapModels,
    apply: (doc) => {
      const { femur, tibia } = doc.components;
      const cells = doc.cells.map((cell) => {
        return isSilhouette(cell.outline) ? ofOutline(anew(cell), null) : anew(cell);
      });
      return { ...doc, components: { femur: moved(tibia), tibia: moved(femur) }, cells, marks: withOtherPoses(doc, () => true) };
    },
  };
}

export function setLibraryFile(name: ComponentName, libraryFile: FileReference | null): Command {
  return onComponent(texts.steps.openLibrary(texts.component[name]), name, (component) => ({ ...component, libraryFile }));
}

export function setLibrarySpec(name: ComponentName, librarySpec: LibrarySpec): Command {
  return onComponent(texts.steps.changeLibrary(texts.component[name]), name, (component) => ({
    ...component,
    librarySpec,
    libraryFile: null,
  }));
}

function onComponent(label: string, name: ComponentName, change: (component: Component) => Component): Command {
  return {
    label,
    apply: (doc) => ({ ...doc, components: { ...doc.components, [name]: change(doc.components[name]) } }),
  };
}

export function setWindow(window: GreyWindow | null): Command {
  return { label: texts.steps.changeWindow, mergeKey: 'window', apply: (doc) => ({ ...doc, window }) };
}

export function rename(name: string): Command {
  return { label: texts.steps.rename, mergeKey: 'name', apply: (doc) => ({ ...doc, name }) };
}

/** Frames a second; null: nobody knows. */
export function setRate(rate: number | null): Command {
  return { label: texts.steps.changeRate, mergeKey: 'rate', apply: (doc) => ({ ...doc, rate }) };
}

export function setSide(side: Doc['side']): Command {
  return { label: texts.steps.changeSide, apply: (doc) => ({ ...doc, side }) };
}
