import { describe, expect, it } from 'vitest';
import { addFrames, withCell } from '../../src/document/commands';
import { bare, setPoseByHand } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { toggleChecked } from '../../src/document/marks';
import { cellOf, type Doc, type Posed } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import type { PoseNumbers } from '../../src/geometry/pose_numbers';
import { isLeadDoubtful, spanToFollow } from '../../src/results/spans';

const FRAMES = 5;
const POSE = { x: 12.5, y: -3.25, z: -1000, zRot: 10, xRot: -2, yRot: 0.5 };
const GOOD = { word: 'good', because: 'it fits' } as const;
const place = (frame: number) => ({ frameId: `f${frame}`, component: 'femur' as const });

function posed(pose: PoseNumbers, part: Partial<Posed>): Posed {
  return { kind: 'posed', from: 'outline', origin: 'o', candidates: [bare(pose)], chosen: 0, reason: null, decided: true, verdict: GOOD, ...part };
}

function clicked(doc: Doc, frame: number, pose: PoseNumbers): Doc {
  const outline = { points: [framePoint(2, 2), framePoint(6, 2), framePoint(6, 6)], closed: true, unknownSides: [], laidBy: 'click' as const };
  return withCell(doc, place(frame), { outline, result: posed(pose, {}), resultOf: outline });
}

/** A femur that was clicked in some frames, and followed from there into all others. */
function followed(...clicks: readonly number[]): Store {
  const store = new Store();
  store.perform(addFrames(Array.from({ length: FRAMES }, (_, k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  store.amend((doc) => clicks.reduce((doc, frame) => clicked(doc, frame, POSE), doc));
  const key = spanToFollow(store.doc, 'femur')!.key;
  const free = Array.from({ length: FRAMES }, (_, frame) => frame).filter((frame) => !clicks.includes(frame));
  store.amend((doc) => free.reduce((doc, frame) => withCell(doc, place(frame), { outline: null, result: posed(POSE, { from: 'film', origin: `followed from ${key(frame)}` }), resultOf: null }), doc));
  return store;
}

const moved = (store: Store, frame: number, by: Partial<PoseNumbers>) => store.amend((doc) => clicked(doc, frame, { ...POSE, ...by }));

describe('what was followed from a pose', () => {
  it('stands where that moved so little that nothing changes, and is followed anew where it moved farther', () => {
    for (const [by, stands] of [
      [{}, true],
      // As constants of the film that are known better in the end correct a click.
      [{ x: 12.2, y: -2.8, z: -1001.8, xRot: -2.04, yRot: 0.26 }, true],
      // Half a metre from its origin a model is 4.4 mm elsewhere.
      [{ yRot: 1 }, false],
      [{ x: 15.6 }, false],
      [{ z: -1011 }, false],
      [{ xRot: -2.5 }, false],
    ] as const) {
      const store = followed(0, 3);
      expect(spanToFollow(store.doc, 'femur')).toBeNull();
      moved(store, 0, by);
      expect([by, spanToFollow(store.doc, 'femur')?.free ?? null]).toEqual([by, stands ? null : 2]);
    }
  });

  it('is followed anew where a hand moves what leads, by however little the film would correct a click', () => {
    const store = followed(0);
    store.perform(setPoseByHand(place(0), { ...POSE, x: 12.8 }));
    expect(spanToFollow(store.doc, 'femur')?.free).toBe(FRAMES - 1);
  });

  it('is told of by the pose as it is now', () => {
    const store = followed(0);
    const origin = () => cellOf(store.doc, 'f2', 'femur').result!.origin;
    moved(store, 0, { x: 12.6 });
    expect(isLeadDoubtful(store.doc, 'femur')(2, origin())).toBe(false);
    moved(store, 0, { x: 16 });
    expect(isLeadDoubtful(store.doc, 'femur')(2, origin())).toBeNull();
  });

  it('stands where others of it are accepted, whatever is set beyond those', () => {
    const store = followed(0);
    store.perform(toggleChecked(place(3)));
    expect(spanToFollow(store.doc, 'femur')).toBeNull();
    store.perform(setPoseByHand(place(4), { ...POSE, x: 40 }));
    expect(spanToFollow(store.doc, 'femur')).toBeNull();
    const other = followed(0);
    other.perform(setPoseByHand(place(4), { ...POSE, x: 40 }));
    expect(spanToFollow(other.doc, 'femur')?.free).toBe(3);
  });

  it('is followed from where it began, too, where a person set another frame, unless the film found that wrong', () => {
    const itself = `frame 1 at ${Object.values(POSE).map((x) => x.toFixed(3)).join(' ')}`;
    for (const [word, leads] of [['good', [0, 4]], ['doubtful', [4]]] as const) {
      const store = followed(0);
      const lead = posed(POSE, { from: 'film', origin: `followed from ${itself} and ${itself}`, verdict: { word, because: 'so' } });
      store.amend((doc) => withCell(doc, place(0), { outline: null, result: lead, resultOf: null }));
      store.perform(setPoseByHand(place(4), { ...POSE, x: 40 }));
      expect(spanToFollow(store.doc, 'femur')!.given.map(({ frame }) => frame)).toEqual(leads);
    }
  });

  it('is followed anew where another frame leads, or what followed it said that it does not hold', () => {
    const store = followed(0, 3);
    store.amend((doc) => clicked(doc, 1, POSE));
    expect(spanToFollow(store.doc, 'femur')?.free).toBe(1);
    const other = followed(0);
    const { result } = cellOf(other.doc, 'f2', 'femur');
    other.amend((doc) => withCell(doc, place(2), { outline: null, result: { ...(result as Posed), origin: `${result!.origin}, no more` }, resultOf: null }));
    expect(spanToFollow(other.doc, 'femur')?.free).toBe(1);
  });
});
