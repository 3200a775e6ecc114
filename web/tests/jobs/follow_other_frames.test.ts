import { describe, expect, it } from 'vitest';
import { addFrames, setCalibration, setModel } from '../../src/document/commands';
import { setPoseByHand } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { cellOf, chosenCandidate, type Doc, EMPTY_DOC, verdictOf } from '../../src/document/types';
import { Follower } from '../../src/jobs/follower';
import { standingOf } from '../../src/results/steps';
import { byName } from '../../src/exchange/name_order';
import { FRAMES, poseOf, worker } from './fake_follow_worker';

const frameOf = (id: string, name = id) => ({ id, name, source: id, indexInSource: 0, width: 8, height: 8 });

/** Frames f0, f1 ... named 00.png, 02.png ...: there is room between them. */
function bench() {
  const store = new Store();
  store.perform(addFrames(Array.from({ length: FRAMES }, (_, k) => frameOf(`f${k}`, `0${2 * k}.png`))));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
  const mesh = { vertices: new Float32Array(), triangles: new Uint32Array() };
  /** Whose pixels the worker was shown, in this order. */
  const shown: string[] = [];
  const studio = { framePixels: (id: string) => (shown.push(id), { pixels: new Uint8Array(64), width: 8, height: 8, covered: new Uint32Array() }), meshOf: () => mesh };
  const femur = worker([]);
  const film = { ready: async () => undefined, chooseSquares: async () => 1, knowsBeside: async () => true, takeBeside: async () => undefined, learnAgain: async () => false };
  const first = { open: async () => false, find: async () => [] };
  const follower = new Follower({ store, studio } as never, { femur, tibia: worker([]) } as never, first as never, film as never);
  store.perform(setPoseByHand({ frameId: 'f0', component: 'femur' }, poseOf(0)));
  return { store, femur, follower, shown };
}

const xOf = (doc: Doc, id: string) => chosenCandidate(cellOf(doc, id, 'femur'))?.pose.x ?? null;

describe('following while the frames become others', () => {
  it('writes nothing of one film into another work that is opened meanwhile', async () => {
    const { store, femur, follower, shown } = bench();
    // The second film of the same patient: the same implants, the same calibration.
    const other: Doc = { ...EMPTY_DOC, work: 'w2', calibration: store.doc.calibration, components: store.doc.components, frames: Array.from({ length: FRAMES }, (_, k) => frameOf(`g${k}`)) };
    // What `openKept` and `openSession` do.
    femur.stopAt(3, () => store.perform({ label: 'open the other work', apply: () => other }));
    await follower.follow();
    const poses = other.frames.map(({ id }) => [id, xOf(store.doc, id), verdictOf(cellOf(store.doc, id, 'femur').result)?.word ?? null]);
    expect(poses).toEqual(other.frames.map(({ id }) => [id, null, null]));
    expect(shown.filter((id) => id.startsWith('g'))).toEqual([]);
  });

  it('keeps the poses at their frames where a mended file comes between them', async () => {
    const { store, femur, follower } = bench();
    femur.stopAt(3, () => store.perform(addFrames([frameOf('mended', '01.png')], [], byName)));
    await follower.follow();
    // The worker answers 10 + k for frame k of those it was begun with.
    expect(['f1', 'f2', 'f3', 'f5'].map((id) => [id, xOf(store.doc, id)])).toEqual([['f1', 11], ['f2', 12], ['f3', 13], ['f5', 15]]);
  });

  it('calls nothing good that was followed from a pose that was taken back meanwhile', async () => {
    const { store, femur, follower } = bench();
    // The click was wrong: somebody sees that while the film is followed from it.
    femur.stopAt(3, () => store.undo());
    await follower.follow();
    const good = store.doc.frames.filter(({ id }) => verdictOf(cellOf(store.doc, id, 'femur').result)?.word === 'good').map(({ id }) => id);
    expect({ lead: xOf(store.doc, 'f0'), good, asksToFollowAgain: standingOf(store.doc).free > 0 || standingOf(store.doc).unposed.length > 0 }).toEqual({ lead: null, good: [], asksToFollowAgain: true });
  });
});
