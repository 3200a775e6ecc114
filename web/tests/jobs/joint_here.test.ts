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
