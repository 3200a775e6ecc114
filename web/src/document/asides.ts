import { COMPONENT_NAMES, type ComponentName, otherThan } from '../terms/component';
import { withCell } from './commands';
import { cellOf, type Doc, type Posed, verdictAlone } from './types';

/** What is told of a pose beside its own verdict: by its joint, or by the frames beside it. */
type Told = 'aside' | 'detour';

/** What is told of the poses of both components in a frame. */
interface LyingBeside {
  readonly sentence: string;
  /** Farther off than mirrored pictures leave a tray: the one of both that is doubtful by itself is astray then, and nothing is told of the other. */
  readonly isBeyondFlipping: boolean;
}

/** What the joint tells of poses, frame by frame; null takes back what was told. The same object where nothing changes. */
export function withAsides(doc: Doc, told: readonly (LyingBeside | null)[]): Doc {
  return COMPONENT_NAMES.reduce((changed, component) => {
    const isGood = (of: ComponentName, frameId: string) => verdictAlone(cellOf(doc, frameId, of).result)?.word === 'good';
    const isFree = (frameId: string) => isGood(component, frameId) && !isGood(otherThan(component), frameId);
    const against = told.map((one, at) => (one === null || (one.isBeyondFlipping && isFree(doc.frames[at]?.id ?? '')) ? null : one.sentence));
    return withTold(changed, component, 'aside', against);
  }, doc);
}

/** The same of what the frames beside them tell of one component's poses. */
export function withDetours(doc: Doc, component: ComponentName, told: readonly (string | null)[]): Doc {
  return withTold(doc, component, 'detour', told);
}

function withTold(doc: Doc, component: ComponentName, what: Told, told: readonly (string | null)[]): Doc {
  return doc.frames.reduce((changed, { id: frameId }, index) => {
    const cell = cellOf(changed, frameId, component);
    const { result } = cell;
    const sentence = told[index] ?? null;
    if (result?.kind !== 'posed' || (result[what] ?? null) === sentence) return changed;
    return withCell(changed, { frameId, component }, { ...cell, result: telling(result, what, sentence) });
  }, doc);
}

function telling(result: Posed, what: Told, sentence: string | null): Posed {
  if (sentence !== null) return { ...result, [what]: sentence };
  const { [what]: _, ...rest } = result;
  return rest;
}
