import { describe, expect, it } from 'vitest';
import { takeFirstTool } from '../../src/commands/first_tool';
import { startEmpty } from '../../src/document/start_anew';
import { Store } from '../../src/document/store';

describe('an empty document', () => {
  it('begins with the first tool and the femur, not with what was in hand for the work before', () => {
    const store = new Store();
    takeFirstTool(store);
    store.show({ tool: 'pose', component: 'tibia', checking: true });
    startEmpty(store);
    expect(store.ui).toMatchObject({ tool: 'trace', component: 'femur', checking: false });
  });
});
