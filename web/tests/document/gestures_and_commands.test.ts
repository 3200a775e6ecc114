import { describe, expect, it } from 'vitest';
import { addFrames, addPoint, closeOutline, giveOutline, insertPoint, setModel, swapModels, withCell } from '../../src/document/commands';
import { bare, setPoseByHand } from '../../src/document/hand_poses';
import { transformOutline } from '../../src/document/outlines';
import { Store } from '../../src/document/store';
import { cellOf, chosenCandidate } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import { moved } from '../../src/geometry/similarity';

const FEMUR = { frameId: 'f', component: 'femur' } as const;
const TIBIA = { frameId: 'f', component: 'tibia' } as const;
const pose = { x: 3, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };

function begun(): Store {
  const store = new Store();
  store.perform(addFrames([{ id: 'f', name: 'f', source: 's', indexInSource: 0, width: 100, height: 100 }]));
  for (const [column, row] of [[10, 10], [50, 10], [30, 60]] as const) store.perform(addPoint(FEMUR, framePoint(column, row)));
  store.perform(closeOutline(FEMUR));
  return store;
}

const points = (store: Store) => cellOf(store.doc, 'f', 'femur').outline!.points;
/** What a click on the other component, or following the film, does when its answer comes. */
const answerElsewhere = (store: Store) => store.perform(setPoseByHand(TIBIA, pose));

describe('a command that comes while a hand drags', () => {
  it('does not make the outline go twice as far', () => {
    const store = begun();
    store.preview(transformOutline(FEMUR, 'move', moved(10, 0)));
    answerElsewhere(store);
    store.preview(transformOutline(FEMUR, 'move', moved(12, 0)));
    store.commit(transformOutline(FEMUR, 'move', moved(12, 0)));
    expect(points(store)[0]).toEqual(framePoint(22, 10));
  });

  it('does not insert a point twice', () => {
    const store = begun();
    const command = insertPoint(FEMUR, 1, framePoint(30, 12));
    store.preview(command);
    answerElsewhere(store);
    store.commit(command);
    expect(points(store)).toHaveLength(4);
  });

  it('does not keep what Esc takes back, nor count it as its own step', () => {
    const store = begun();
    store.preview(transformOutline(FEMUR, 'move', moved(10, 0)));
    answerElsewhere(store);
    store.cancelPreview();
    expect(points(store)[0]).toEqual(framePoint(10, 10));
  });
});

describe('poses that a hand set', () => {
  it('stay when an outline is given to their component', () => {
    const store = begun();
    store.perform(setPoseByHand(TIBIA, pose));
    store.perform(giveOutline(FEMUR, 'tibia'));
    expect(chosenCandidate(cellOf(store.doc, 'f', 'tibia'))?.pose).toEqual(pose);
  });

  it('stay when the models change places, over a silhouette too', () => {
    const store = begun();
    store.perform(setModel('femur', { name: 'a', sha256: 'a' }));
    store.perform(setModel('tibia', { name: 'b', sha256: 'b' }));
    // A click, and then a hand.
    const outline = { ...cellOf(store.doc, 'f', 'femur').outline!, laidBy: 'click' } as const;
    store.perform({ label: 'click', apply: (doc) => withCell(doc, FEMUR, { outline, result: { kind: 'posed', from: 'outline', origin: 'o', candidates: [bare(pose)], chosen: 0, reason: null, decided: true, verdict: null }, resultOf: outline }) });
    store.perform(setPoseByHand(FEMUR, { ...pose, x: 7 }));
    store.perform(swapModels());
    expect(chosenCandidate(cellOf(store.doc, 'f', 'femur'))?.pose.x).toBe(7);
  });
});

describe('the outline that a click laid as a model has it', () => {
  it('goes with that model, and no other outline does', () => {
    const store = begun();
    store.perform(setModel('femur', { name: 'a', sha256: 'a' }));
    const outline = { ...cellOf(store.doc, 'f', 'femur').outline!, laidBy: 'click' } as const;
    for (const place of [FEMUR, TIBIA]) store.perform({ label: 'click', apply: (doc) => withCell(doc, place, { outline, result: null, resultOf: null }) });
    const outlines = () => [FEMUR, TIBIA].map(({ component }) => cellOf(store.doc, 'f', component).outline !== null);
    store.perform(setModel('femur', { name: 'copy of a', sha256: 'a' }));
    expect(outlines()).toEqual([true, true]);
    store.perform(setModel('femur', { name: 'b', sha256: 'b' }));
    expect(outlines()).toEqual([false, true]);
    store.undo();
    expect(outlines()).toEqual([true, true]);
    // One that a hand traced is of the frame, whatever the model.
    const { laidBy: _, ...traced } = outline;
    store.perform({ label: 'trace', apply: (doc) => withCell(doc, FEMUR, { outline: traced, result: null, resultOf: null }) });
    store.perform(setModel('femur', { name: 'b', sha256: 'b' }));
    expect(outlines()).toEqual([true, true]);
  });
});
