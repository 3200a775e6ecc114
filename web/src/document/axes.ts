import { type Directions, directionsFrom, facingTheOtherWay, isFrame, type SignedDirections, tiltAlike } from '../geometry/axes';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';
import type { Command } from './command';
import { list, number, object, oneOf, ReadError, type Reader } from './reader';
import type { Axes, Component, Doc } from './types';

/** What a shape told, or a person or a study said; null: what was said before no longer holds, and the shape is asked again. */
export function setAxes(name: ComponentName, axes: Axes | null): Command {
  return {
    label: texts.steps.changeAxes(texts.component[name]),
    apply: (doc) => (axes ? withStatedAxes(doc, name, axes) : withAxes(doc, name, null)),
  };
}

/** Choices that may have rested on other axes are made again. */
export function withStatedAxes(doc: Doc, name: ComponentName, axes: Axes): Doc {
  const before = doc.components[name].axes;
  const changed = withAxes(doc, name, axes);
  return before && !tiltAlike(before.directions, axes.directions) ? withOpenChoices(changed) : changed;
}

export function withAxes(doc: Doc, name: ComponentName, axes: Axes | null): Doc {
  const component: Component = { ...doc.components[name], axes };
  return { ...doc, components: { ...doc.components, [name]: component } };
}

/** What a person answers whom the page asked which way the front is. */
export function withFront(axes: Axes, front: 'as shown' | 'the other way'): Axes {
  const directions = front === 'as shown' ? axes.directions : facingTheOtherWay(axes.directions);
  return { directions, from: 'person', told: 'all' };
}

/** What speaks of front and back, left and right. Null while the shape is looked at, and where it does not tell. */
export function knownAxes(component: Component): Directions | null {
  if (isAssumed(component)) return OWN_AXES;
  return component.axes?.told === 'all' ? component.axes.directions : null;
}

/** The tilt asks for lines, not for directions. */
export function tiltAxes(component: Component): Directions | null {
  if (isAssumed(component)) return OWN_AXES;
  return component.axes && component.axes.told !== 'nothing' ? component.axes.directions : null;
}

/** What a joint asks for: axes with their signs, at least but for front and back. Null where those are not known. */
export function signedAxes(component: Component): SignedDirections | null {
  const { told, directions } = component.axes ?? {};
  const isSigned = told === 'all' || told === 'not the front';
  return directions && isSigned ? { directions, front: told === 'all' } : null;
}

/** Without a model there is no shape to ask: poses are taken in the field's axes, as the laboratory does, and that is said. */
export function isAssumed({ model, axes }: Component): boolean {
  return model === null && axes === null;
}

/** x anterior, y superior, z to the patient's right. */
export const OWN_AXES: Directions = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

/** Choices between rivals may have rested on the tilt. What a person chose stays. */
function withOpenChoices(doc: Doc): Doc {
  const cells = doc.cells.map((cell) => {
    const { result } = cell;
    const open = result?.kind === 'posed' && result.from === 'outline' && result.chosen === 0 && result.candidates.length > 1;
    return open ? { ...cell, result: { ...result, decided: false } } : cell;
  });
  return { ...doc, cells };
}

// --- Sessions -------------------------------------------------------------------------------------------------------

const readDirections: Reader<Directions> = (value, path) => {
  const rows = list(list(number))(value, path);
  const directions = directionsFrom(rows.flat());
  if (rows.some((row) => row.length !== 3) || rows.length !== 3 || !isFrame(directions)) {
    throw new ReadError(`${path} should be three directions at right angles, right-handed: anterior, superior and right`);
  }
  return directions;
};

export const readAxes = object<Axes>({
  directions: readDirections,
  from: oneOf('shape', 'person', 'study'),
  told: oneOf('all', 'not the front', 'no signs', 'nothing'),
});
