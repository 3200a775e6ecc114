import { currentFrame, type Store } from '../document/store';
import type { JointReader } from './joint_reader';
import { Pause } from './pause';

/** How long a frame has to be on view before its joint is asked for, ms: nobody reads numbers that fly by. */
export const JOINT_REST = 250;

/** Sees to it that the joint's numbers of the frame on which somebody rests are known, whether its curves are open or not. */
export function readJointHere(store: Store, reader: Pick<JointReader, 'rowOf' | 'lookAt'>): void {
  const pause = new Pause();
  /** What was asked last is not asked again: there may be no answer. What could not be asked yet is, as after a reload, where models come later. */
  let asked: { readonly doc: unknown; readonly frameId: string } | null = null;
  const ask = async (doc: unknown, frameId: string) => {
    const own = (asked = { doc, frameId });
    if (!(await reader.lookAt(frameId)) && asked === own) asked = null;
  };
  store.subscribe(() => {
    const { doc, ui } = store;
    const frameId = currentFrame(store.state)?.id;
    pause.end();
    // With a hand on the model, or while the film is followed, there is another pose in a moment.
    if (!frameId || ui.tool === 'pose' || ui.jobs.length > 0) return;
    if ((asked?.doc === doc && asked.frameId === frameId) || reader.rowOf(frameId)) return;
    pause.before(JOINT_REST, () => void ask(doc, frameId));
  });
}
