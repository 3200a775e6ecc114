import { describe, expect, it } from 'vitest';
import { setAxes } from '../../src/document/axes';
import { setModel, swapModels, withCell } from '../../src/document/commands';
import { takeFollowed } from '../../src/document/followed';
import { Store } from '../../src/document/store';
import { cellOf, type Result } from '../../src/document/types';
import type { ComponentName } from '../../src/terms/component';
import { framePoint } from '../../src/geometry/points';
import { misplacedModels } from '../../src/results/misplaced';

const SHAPES: Readonly<Record<string, ComponentName | null>> = { bow: 'femur', tray: 'tibia', lump: null };
const shapeOf = (sha256: string) => SHAPES[sha256] ?? null;

function models(femur: string | null, tibia: string | null): Store {
  const store = new Store();
  if (femur) store.perform(setModel('femur', { name: `${femur}.stl`, sha256: femur }));
  if (tibia) store.perform(setModel('tibia', { name: `${tibia}.stl`, sha256: tibia }));
  return store;
}

describe('models in the wrong place', () => {
  it.each([
    ['bow', 'tray', [], false],
    ['tray', 'bow', ['femur', 'tibia'], true],
    ['tray', null, ['femur'], true],
    ['lump', 'bow', ['tibia'], true],
    // Two of a kind: to change them mends nothing.
    ['bow', 'bow', ['tibia'], false],
    ['lump', 'lump', [], false],
    [null, null, [], false],
  ] as const)('femur %s, tibia %s', (femur, tibia, components, canSwap) => {
    expect(misplacedModels(models(femur, tibia).doc, shapeOf)).toEqual({ components, canSwap });
  });

  it('change places in one step back, with what a person said of them; what was followed is dropped', () => {
    const store = models('tray', 'bow');
    const stated = { directions: [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], from: 'person', told: 'all' } as const;
    store.perform(setAxes('femur', stated));
    store.perform(setAxes('tibia', { ...stated, from: 'shape' }));
    const place = { frameId: 'f', component: 'femur' } as const;
    const pose = { x: 0, y: 0, z: -900, zRot: 0, xRot: 0, yRot: 0 };
    store.perform(takeFollowed([{ place, pose, deviations: null, residual: null, doubtful: true, badness: 2, rival: null, led: false, isLeader: false, because: 'so', from: 'frame 1' }]));
    const refused: Result = { kind: 'failed', origin: 'k', sentence: 's' };
    store.perform({ label: 'click', apply: (doc) => withCell(doc, { ...place, component: 'tibia' }, { outline: null, result: refused, resultOf: null }) });
    const before = store.doc;
    store.perform(swapModels());
    const { femur, tibia } = store.doc.components;
    expect([femur.model?.sha256, tibia.model?.sha256]).toEqual(['bow', 'tray']);
    expect([femur.axes, tibia.axes]).toEqual([null, stated]);
    expect(cellOf(store.doc, 'f', 'femur').result).toBeNull();
    expect(cellOf(store.doc, 'f', 'tibia').result).toBe(refused);
    expect(misplacedModels(store.doc, shapeOf).components).toEqual([]);
    store.undo();
    expect(store.doc.components).toBe(before.components);
    expect(cellOf(store.doc, 'f', 'femur').result?.kind).toBe('posed');
  });

  it('take the silhouettes along that clicks laid with them, and leave what a person traced', () => {
    const store = models('tray', 'bow');
    const points = [framePoint(1, 1), framePoint(5, 1), framePoint(5, 5)];
    const lay = (component: ComponentName, laidBy: 'click' | undefined) => {
      const outline = { points, closed: true, unknownSides: [], ...(laidBy && { laidBy }) };
      const result: Result = { kind: 'failed', origin: 'k', sentence: 's' };
      store.perform({ label: 'lay', apply: (doc) => withCell(doc, { frameId: 'f', component }, { outline, result, resultOf: outline }) });
    };
    lay('femur', 'click');
    lay('tibia', undefined);
    store.perform(swapModels());
    expect(cellOf(store.doc, 'f', 'femur')).toMatchObject({ outline: null, result: null });
    expect(cellOf(store.doc, 'f', 'tibia').outline?.points).toEqual(points);
    store.undo();
    expect(cellOf(store.doc, 'f', 'femur').outline?.laidBy).toBe('click');
  });
});
