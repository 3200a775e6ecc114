import { describe, expect, it } from 'vitest';
import { knownAxes, setAxes, withAxes, withFront } from '../../src/document/axes';
import { addFrames, setModel, setSide } from '../../src/document/commands';
import { bare, takeHandFit } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import type { Axes } from '../../src/document/types';
import { directionsFromWords, wordsOf, type Directions } from '../../src/geometry/axes';
import type { PoseNumbers } from '../../src/geometry/pose_numbers';
import { facingByFilm } from '../../src/results/facing';
import { jointAsked, motionNeeds } from '../../src/results/motion';
import { axesInWords, axesSentence, namedArrows } from '../../src/results/axes_words';

const axes = (words: string, told: Axes['told'] = 'all', from: Axes['from'] = 'shape'): Axes => ({ directions: directionsFromWords(words) as Directions, from, told });

/** A store with a model whose shape told something. */
function bench(found: Axes) {
  const store = new Store();
  store.perform(setModel('tibia', { name: 'tray.stl', sha256: 't' }));
  store.amend((doc) => withAxes(doc, 'tibia', found));
  return { store, now: () => store.doc.components.tibia.axes };
}

describe('axes of a component', () => {
  it('are a person’s word once somebody said, and the shape’s again by undo', () => {
    const { store, now } = bench(axes('x y z'));
    store.perform(setAxes('tibia', axes('y z x', 'all', 'person')));
    expect(now()).toMatchObject({ from: 'person' });
    expect(store.state.history.past.at(-1)?.label).toBe('change the axes of the tibia');
    store.undo();
    expect(now()).toMatchObject({ from: 'shape' });
    store.redo();
    expect(wordsOf(now()!.directions)).toEqual(['y', 'z', 'x']);
  });

  it.each([['as shown', ['x', 'y', 'z']], ['the other way', ['-x', 'y', '-z']]] as const)('the front is told by a person: %s', (front, words) => {
    const { store, now } = bench(axes('x y z', 'not the front'));
    store.perform(setAxes('tibia', withFront(now()!, front)));
    expect(now()).toMatchObject({ from: 'person', told: 'all' });
    expect(wordsOf(now()!.directions)).toEqual(words);
  });

  it('are found again for another model, but those that a study said of one that was still to come stay', () => {
    const { store, now } = bench(axes('x y z', 'all', 'person'));
    store.perform(setModel('tibia', { name: 'other.stl', sha256: 'o' }));
    expect(now()).toBeNull();
    store.perform(setAxes('femur', axes('y z x', 'all', 'study')));
    store.perform(setModel('femur', { name: 'femur.stl', sha256: 'f' }));
    expect(store.doc.components.femur.axes?.from).toBe('study');
  });
});

describe('axes in words', () => {
  it.each([
    ['unknown', 'x anterior, y superior, z right'],
    ['right', 'x anterior, y superior, z lateral'],
    ['left', 'x anterior, y superior, \u2212z lateral'],
  ] as const)('of a knee whose side is %s', (side, words) => {
    expect(axesInWords(directionsFromWords('x y z')!, side)).toBe(words);
  });

  it('say who said so, and ask what is not told', () => {
    expect(axesSentence(axes('x y z', 'all', 'study'), 'femur', 'right', true)).toBe('As the study file says: x anterior, y superior, z lateral.');
    expect(axesSentence(axes('x y z', 'not the front'), 'tibia', 'right', true)).toMatch(/or facing the other way\. Its shape does not tell front from back/);
    expect(namedArrows(axes('x y z', 'not the front'), 'right').map(({ name }) => name)).toEqual(['anterior?', 'superior', 'lateral?']);
    expect(namedArrows(axes('x y z', 'no signs'), 'right')).toEqual([]);
  });
});

describe('the joint’s motion', () => {
  const both = (femur: Axes | null, tibia: Axes | null) => {
    const store = new Store();
    store.perform(setSide('left'));
    store.amend((doc) => withAxes(withAxes(doc, 'femur', femur), 'tibia', tibia));
    return store.doc;
  };

  it('asks for what is not told instead of guessing', () => {
    expect(motionNeeds(both(axes('x y z'), axes('x y z', 'not the front')))).toEqual({ what: 'front', component: 'tibia' });
    expect(motionNeeds(both(axes('x y z', 'nothing'), axes('x y z')))).toEqual({ what: 'axes', component: 'femur' });
    expect(motionNeeds(both(axes('x y z'), axes('x y z')))).toEqual({ what: 'poses' });
    expect(knownAxes(both(null, null).components.femur)).toEqual(axes('x y z').directions);
    expect(axesSentence(null, 'femur', 'left', false)).toMatch(/^Without its model the file’s own are taken/);
    expect(jointAsked(both(axes('x y z'), axes('x y z', 'not the front')))).toBeNull();
  });
});

describe('the front by the film', () => {
  const pose = (yRot: number): PoseNumbers => ({ x: 0, y: 0, z: -1000, zRot: 10, xRot: 3, yRot });
  const verdict = (word: 'good' | 'doubtful') => ({ word, because: 'a test says so' });

  /** Frames in which the tibia is rotated about its upright by so much against the femur. */
  const film = (turns: readonly number[], word: 'good' | 'doubtful' = 'good') => {
    const store = new Store();
    const ids = turns.map((_, index) => `f${index}`);
    store.perform(addFrames(ids.map((id) => ({ id, name: id, source: id, indexInSource: 0, width: 10, height: 10 }))));
    store.amend((doc) => withAxes(withAxes(doc, 'femur', axes('x y z')), 'tibia', axes('x y z', 'not the front')));
    turns.forEach((turn, index) => {
      for (const [component, yRot] of [['femur', 5], ['tibia', 5 + turn]] as const) {
        const place = { frameId: ids[index]!, component };
        store.perform(takeHandFit(place, { candidate: bare(pose(yRot)), reason: '', verdict: verdict(component === 'tibia' ? word : 'good'), onFrame: null }));
      }
    });
    return store.doc;
  };

  it.each([
    [[10, -15], { front: 'as shown', frames: 2 }],
    [[170, 195, 180], { front: 'the other way', frames: 3 }],
    [[10, 175], null],
    [[], null],
  ] as const)('of tibiae that are rotated by %j', (turns, facing) => {
    expect(facingByFilm(film(turns), 'tibia')).toEqual(facing);
  });

  it('is not told by doubtful poses, nor where the shape tells it', () => {
    expect(facingByFilm(film([10], 'doubtful'), 'tibia')).toBeNull();
    expect(facingByFilm(film([10]), 'femur')).toBeNull();
  });
});
