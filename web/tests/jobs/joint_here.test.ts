import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import { addFrames } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import { JOINT_REST, readJointHere } from '../../src/jobs/joint_here';

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

const rest = () => vi.advanceTimersByTimeAsync(10 * JOINT_REST);

it('asks once for the frame on which somebody rests, and not for those that pass, nor with a hand on the model', async () => {
  const store = new Store();
  const asked: string[] = [];
  const known = new Set<string>();
  readJointHere(store, {
    rowOf: (id) => (known.has(id) ? new Map() : null),
    lookAt: async (id) => {
      asked.push(id);
      // As the reader does, whether there is an answer or not.
      store.show({});
      return true;
    },
  });
  store.perform(addFrames([0, 1, 2].map((k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  store.goTo(1);
  await rest();
  expect(asked).toEqual(['f1']);
  known.add('f2');
  store.goTo(2);
  await rest();
  store.show({ tool: 'pose' });
  store.goTo(0);
  await rest();
  expect(asked).toEqual(['f1']);
  store.show({ tool: 'edit' });
  await rest();
  expect(asked).toEqual(['f1', 'f0']);
});

it('asks again where nothing could be asked yet: after a reload the models come later than the frame is on view', async () => {
  const store = new Store();
  let areModelsHere = false;
  let answers = 0;
  readJointHere(store, {
    rowOf: () => (answers > 0 ? new Map() : null),
    lookAt: async () => {
      if (areModelsHere) answers += 1;
      return areModelsHere;
    },
  });
  store.perform(addFrames([{ id: 'f0', name: 'f0', source: 's', indexInSource: 0, width: 8, height: 8 }]));
  await rest();
  areModelsHere = true;
  // Models are no part of the document: whoever waits for them is told.
  store.show({});
  await rest();
  expect(answers).toBe(1);
});
